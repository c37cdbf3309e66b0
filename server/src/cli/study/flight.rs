//! `slewplan study flight`: simulates a plan once in closed loop.

use super::given::StudyFiles;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::documents::study::flight::{self, FlightAnswerDocument};
use slewplan_studies::flight::{Outcome, fly};

/// Arguments of `study flight`.
#[derive(Debug, clap::Args)]
pub(super) struct FlightStudyArguments {
    #[command(flatten)]
    given: StudyFiles,
    #[command(flatten)]
    planning: Planning,
}

/// Plans, simulates and writes the answer.
pub(super) fn run(arguments: &FlightStudyArguments) -> Result<Exit, Failure> {
    let given = &arguments.given;
    let (destination, study) = given.open(flight::read)?;
    let (simulated, received) = arguments.planning.conduct(|run| fly(&study, run))?;
    let simulated = simulated.map_err(|problems| given.invalid(problems))?;
    if let (Outcome::Stopped, Some(code)) = (&simulated, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    destination.write(&output::json(&FlightAnswerDocument::new(
        &study, &simulated,
    ))?)?;
    Ok(match simulated {
        Outcome::Flown(_) => Exit::Complete,
        Outcome::NoPlan(_) => Exit::Negative,
        Outcome::Stopped => Exit::Stopped,
    })
}
