//! The `slewplan` binary: multi-target attitude scheduling as a command and as a service.

mod access;
mod cli;
mod clock;
mod connections;
mod contradictions;
mod digest;
mod export;
#[cfg(feature = "faults")]
mod faults;
mod figures;
mod flights;
mod http;
mod jobs;
mod leg_cache;
mod leg_import;
mod lifecycle;
mod plot;
mod progress;
mod report;
mod service;
mod shards;
mod signals;
mod slews;
mod store;
mod wire;

use std::process::ExitCode;

/// Gives back to the system what a solve has used, within seconds: after one of 48 targets the
/// allocator of glibc kept 60 MB for ever, and mimalloc 90.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    cli::run()
}
