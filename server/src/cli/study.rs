//! `slewplan study`: what the choice of an option leads to, and what wheels can do together.

mod authority;
mod comparison;
mod envelopes;
mod flight;
mod given;
mod planning;

use super::Exit;
use super::failure::Failure;
use clap::Subcommand;

/// What `study` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
enum Study {
    /// Which shares of torque and wheel speed a plan should leave to feedback
    ///
    /// The document has a scenario, a simulation and the pairs of shares.
    Authority(authority::Arguments),
    /// What the wheels can do together: envelopes, slews within them, torques shared out
    ///
    /// The document has a spacecraft, turns and torques.
    Envelopes(envelopes::Arguments),
    /// Reaction wheels against control moment gyroscopes: who turns faster, and from which angle on
    Comparison(comparison::Arguments),
    /// Fly a plan once in closed loop
    ///
    /// The document has a scenario, how it is flown, and perhaps a plan of it.
    Flight(flight::Arguments),
}

/// Conducts the study and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    match &arguments.study {
        Study::Authority(arguments) => authority::run(arguments),
        Study::Envelopes(arguments) => envelopes::run(arguments),
        Study::Comparison(arguments) => comparison::run(arguments),
        Study::Flight(arguments) => flight::run(arguments),
    }
}
