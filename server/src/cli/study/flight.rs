//! `slewplan study flight`: a plan flown once in closed loop.

use super::given::Given;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::documents::study::flight::{self, FlightAnswerDocument};
use slewplan_studies::flight::{Outcome, fly};

/// What `study flight` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    planning: Planning,
}

/// Plans, flies and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let given = &arguments.given;
    let (destination, study) = given.open(flight::read)?;
    let (flown, received) = arguments.planning.conduct(|run| fly(&study, run))?;
    let flown = flown.map_err(|problems| given.invalid(problems))?;
    if let (Outcome::Stopped, Some(code)) = (&flown, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    destination.write(&output::json(&FlightAnswerDocument::new(&study, &flown))?)?;
    Ok(match flown {
        Outcome::Flown(_) => Exit::Complete,
        Outcome::NoPlan(_) => Exit::Negative,
        Outcome::Stopped => Exit::Stopped,
    })
}
