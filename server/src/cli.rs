//! The command line: what can be asked for, and with which exit code it ends.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

mod backup;
mod certify;
mod export;
mod failure;
mod form;
mod health;
mod import;
mod input;
mod keys;
mod legs;
mod openapi;
mod output;
mod panics;
mod plot;
mod progress;
mod remembered;
mod runtime;
mod serve;
mod shard;
mod signals;
mod slew;
mod solve;
mod study;
mod validate;
mod verify;

pub(crate) use failure::Failure;

/// Multi-target attitude scheduling for spacecraft with reaction wheels.
#[derive(Debug, Parser)]
#[command(
    version,
    about,
    after_help = "A file name of - means standard input or output."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Find the visiting order and the wheel torques of minimum time
    Solve(solve::Arguments),
    /// Solve one slew, with a choice of objective and command
    Slew(slew::Arguments),
    /// Compare what a choice leads to
    Study(study::Arguments),
    /// Tabulate the times of the legs between start, targets and end
    Legs(legs::Arguments),
    /// Put legs that were solved elsewhere into the database of a service
    Import(import::Arguments),
    /// List everything that is wrong or doubtful with a scenario
    Validate(validate::Arguments),
    /// Fly a plan made by anyone again and test every limit
    Verify(verify::Arguments),
    /// Prove the certified bounds of a plan a second time
    Certify(certify::Arguments),
    /// Write a plan in the format of another tool
    Export(export::Arguments),
    /// Draw a plan, a slew, trade curves or a study of wheels
    Plot(plot::Arguments),
    /// Run the HTTP service
    Serve(serve::Arguments),
    /// Ask a running service whether it can take work
    Health(health::Arguments),
    /// Copy the database while the service uses it
    Backup(backup::Arguments),
    /// Make, list and revoke keys for the service
    Keys(keys::Arguments),
    /// Print the description of the HTTP service
    Openapi,
}

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The answer is complete: optimal, valid, passed, confirmed.
    Complete,
    /// An error of ours or of the machine, or no answer found.
    Failed,
    /// The input is not valid.
    Invalid,
    /// No plan can exist, or the plan did not pass or its bounds are not confirmed, or legs are
    /// refused.
    Negative,
    /// Stopped with the best answer so far.
    Stopped,
    /// Ended by a signal before there was an answer.
    Signalled(u8),
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        match exit {
            Exit::Complete => Self::from(0),
            Exit::Failed => Self::from(1),
            Exit::Invalid => Self::from(2),
            Exit::Negative => Self::from(3),
            Exit::Stopped => Self::from(4),
            Exit::Signalled(code) => Self::from(code),
        }
    }
}

/// Runs the program on the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    let command = Arguments::parse().command;
    let exit = match panics::contain(|| dispatch(&command)) {
        Ok(Ok(exit)) => exit,
        Ok(Err(failure)) => {
            output::complain(&failure.to_string());
            failure.exit()
        }
        Err(panic) => {
            output::complain(&format!("internal error: {panic}"));
            Exit::Failed
        }
    };
    exit.into()
}

fn dispatch(command: &Command) -> Result<Exit, Failure> {
    match command {
        Command::Solve(arguments) => solve::run(arguments),
        Command::Slew(arguments) => slew::run(arguments),
        Command::Study(arguments) => study::run(arguments),
        Command::Legs(arguments) => legs::run(arguments),
        Command::Import(arguments) => import::run(arguments),
        Command::Validate(arguments) => validate::run(arguments),
        Command::Verify(arguments) => verify::run(arguments),
        Command::Certify(arguments) => certify::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Plot(arguments) => plot::run(arguments),
        Command::Serve(arguments) => serve::run(arguments),
        Command::Health(arguments) => health::run(arguments),
        Command::Backup(arguments) => backup::run(arguments),
        Command::Keys(arguments) => keys::run(arguments),
        Command::Openapi => openapi::run(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_of_the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
