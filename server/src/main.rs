//! The `slewplan` binary: multi-target attitude scheduling from the command line.

mod cli;
mod progress;
mod report;
mod signals;
mod wire;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
