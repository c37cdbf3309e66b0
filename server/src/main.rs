//! The `slewplan` binary: multi-target attitude scheduling as a command and as a service.

mod cli;
mod clock;
mod digest;
mod http;
mod jobs;
mod leg_cache;
mod lifecycle;
mod progress;
mod report;
mod service;
mod signals;
mod store;
mod wire;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
