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

/// Returns freed memory to the system within seconds after a solve, which neither glibc nor
/// mimalloc does.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    cli::run()
}
