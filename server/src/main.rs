//! The `slewplan` binary.

use std::process::ExitCode;

/// Gives back to the system what a solve has used, within seconds: after one of 48 targets the
/// allocator of glibc kept 60 MB for ever, and mimalloc 90.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    slewplan_server::run()
}
