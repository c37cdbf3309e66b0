//! The `slewplan` binary: multi-target attitude scheduling as a command and as a service.

mod api;
mod base;
mod cli;
mod documents;
mod jobs;
mod render;
mod service;
mod store;

use std::process::ExitCode;

/// Gives back to the system what a solve has used, within seconds: after one of 48 targets the
/// allocator of glibc kept 60 MB for ever, and mimalloc 90.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    cli::run()
}
