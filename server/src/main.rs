//! The `slewplan` binary.

use std::process::ExitCode;

/// Returns freed memory to the system within seconds after a solve, which neither glibc nor
/// mimalloc does.
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    slewplan_server::run()
}
