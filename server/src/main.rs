//! The `slewplan` binary: multi-target attitude scheduling as a command and as a service.

mod access;
mod cli;
mod clock;
mod connections;
mod digest;
mod export;
#[cfg(feature = "faults")]
mod faults;
mod figures;
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

fn main() -> ExitCode {
    cli::run()
}
