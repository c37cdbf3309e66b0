//! The command line: commands, options and exit codes.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

mod answer;
mod backup;
mod certify;
mod convert;
mod copy;
mod database;
mod export;
mod failure;
mod form;
mod health;
mod import;
mod init;
mod input;
mod keys;
mod legs;
mod log;
mod migrate;
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
mod work;
mod worker;

pub(crate) use failure::Failure;

/// Multi-target attitude scheduling for spacecraft with reaction wheels.
#[derive(Debug, Parser)]
#[command(
    name = "slewplan",
    version,
    about,
    after_help = "A file name of - means standard input or output.\n\n\
        Exit codes: 0 complete (optimal, valid, passed, confirmed); 1 no answer or an error of the \
        program; 2 invalid input; 3 infeasible, not passed, not confirmed or refused; 4 stopped \
        with the best answer so far; 5 a keep-out cone is violated (--strict); 130, 143 ended by a \
        signal before there was an answer."
)]
struct CommandLine {
    #[command(subcommand)]
    command: CliCommand,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Write a scenario to begin with, and what its fields mean
    Init(init::InitArguments),
    /// Make targets of a table
    Convert(convert::ConvertArguments),
    /// Find the visiting order and the wheel torques of minimum time
    Solve(solve::SolveArguments),
    /// Solve one slew, with a choice of objective and command
    Slew(slew::SlewArguments),
    /// Study the effects of options, wheels and gyroscopes
    Study(study::StudyArguments),
    /// Tabulate the times of the legs between start, targets and end
    Legs(legs::LegsArguments),
    /// Import legs that were solved elsewhere into the database of a service
    Import(import::ImportArguments),
    /// List all errors and warnings of a scenario
    Validate(validate::ValidateArguments),
    /// Propagate a plan of any origin again and test every limit
    Verify(verify::VerifyArguments),
    /// Prove the certified bounds of a plan a second time
    Certify(certify::CertifyArguments),
    /// Write a plan in the format of another tool
    Export(export::ExportArguments),
    /// Draw a plan, a slew, trade curves or a study of wheels
    Plot(plot::PlotArguments),
    /// Run the HTTP service
    Serve(serve::ServeArguments),
    /// Solve the jobs of a database that several processes share
    Work(work::WorkArguments),
    /// Ask a running service whether it can take work
    Health(health::HealthArguments),
    /// Copy the database while the service uses it
    Backup(backup::BackupArguments),
    /// Copy everything to another database: from a file to a Postgres server, or back
    Copy(copy::CopyArguments),
    /// Bring the schema of a database up to date, and let another role use it
    Migrate(migrate::MigrateArguments),
    /// Make, list and revoke keys for the service
    Keys(keys::KeysArguments),
    /// Print the description of the HTTP service
    Openapi,
}

/// The end of a command, as its exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// The answer is complete: optimal, valid, passed, confirmed.
    Complete,
    /// An error of the program or of the machine, or no answer was found.
    Failed,
    /// The input is not valid.
    Invalid,
    /// No plan can exist, a plan did not pass, bounds are not confirmed, or legs are refused.
    Negative,
    /// Stopped with the best answer so far.
    Stopped,
    /// The answer violates a keep-out cone, and --strict asks to be told.
    Violated,
    /// Ended by a signal without an answer.
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
            Exit::Violated => Self::from(5),
            Exit::Signalled(code) => Self::from(code),
        }
    }
}

/// Runs the program on the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    let command = CommandLine::parse().command;
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

fn dispatch(command: &CliCommand) -> Result<Exit, Failure> {
    match command {
        CliCommand::Init(arguments) => init::run(arguments),
        CliCommand::Convert(arguments) => convert::run(arguments),
        CliCommand::Solve(arguments) => solve::run(arguments),
        CliCommand::Slew(arguments) => slew::run(arguments),
        CliCommand::Study(arguments) => study::run(arguments),
        CliCommand::Legs(arguments) => legs::run(arguments),
        CliCommand::Import(arguments) => import::run(arguments),
        CliCommand::Validate(arguments) => validate::run(arguments),
        CliCommand::Verify(arguments) => verify::run(arguments),
        CliCommand::Certify(arguments) => certify::run(arguments),
        CliCommand::Export(arguments) => export::run(arguments),
        CliCommand::Plot(arguments) => plot::run(arguments),
        CliCommand::Serve(arguments) => serve::run(arguments),
        CliCommand::Work(arguments) => work::run(arguments),
        CliCommand::Health(arguments) => health::run(arguments),
        CliCommand::Backup(arguments) => backup::run(arguments),
        CliCommand::Copy(arguments) => copy::run(arguments),
        CliCommand::Migrate(arguments) => migrate::run(arguments),
        CliCommand::Keys(arguments) => keys::run(arguments),
        CliCommand::Openapi => openapi::run(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_of_the_command_line_is_consistent() {
        CommandLine::command().debug_assert();
    }
}
