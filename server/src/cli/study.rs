//! `slewplan study`: effects of options, and envelopes of wheels.

mod authority;
mod comparison;
mod envelopes;
mod flight;
mod given;
mod planning;

use super::Exit;
use super::failure::Failure;
use clap::Subcommand;

/// Arguments of `study`.
#[derive(Debug, clap::Args)]
pub(super) struct StudyArguments {
    #[command(subcommand)]
    study: StudyCommand,
}

#[derive(Debug, Subcommand)]
enum StudyCommand {
    /// Compare shares of torque and wheel speed that a plan leaves to feedback
    ///
    /// The document has a scenario, a simulation and the pairs of shares.
    Authority(authority::AuthorityStudyArguments),
    /// Envelopes of the wheels, slews within them, and allocation of torques
    ///
    /// The document has a spacecraft, turns and torques.
    Envelopes(envelopes::EnvelopesStudyArguments),
    /// Compare reaction wheels with control moment gyroscopes
    Comparison(comparison::ComparisonStudyArguments),
    /// Simulate a plan once in closed loop
    ///
    /// The document has a scenario, the settings of the simulation, and optionally a plan.
    Flight(flight::FlightStudyArguments),
}

/// Runs the study and writes the answer.
pub(super) fn run(arguments: &StudyArguments) -> Result<Exit, Failure> {
    match &arguments.study {
        StudyCommand::Authority(arguments) => authority::run(arguments),
        StudyCommand::Envelopes(arguments) => envelopes::run(arguments),
        StudyCommand::Comparison(arguments) => comparison::run(arguments),
        StudyCommand::Flight(arguments) => flight::run(arguments),
    }
}
