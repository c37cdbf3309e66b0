//! `slewplan study flight`: simulates a plan once in closed loop.

use super::given::StudyFiles;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::documents::study::flight::{self, FlightAnswerDocument};
use slewplan_studies::flight::{FlightStudyOutcome, simulate};

/// Arguments of `study flight`.
#[derive(Debug, clap::Args)]
pub(super) struct FlightStudyArguments {
    #[command(flatten)]
    given: StudyFiles,
    #[command(flatten)]
    planning: Planning,
}

/// Solves, simulates and writes the answer.
pub(super) fn run(arguments: &FlightStudyArguments) -> Result<Exit, Failure> {
    let given = &arguments.given;
    let (destination, study) = given.open(flight::read)?;
    let (outcome, received) = arguments.planning.conduct(|run| simulate(&study, run))?;
    let outcome = outcome.map_err(|problems| given.invalid(problems))?;
    if let (FlightStudyOutcome::Stopped, Some(code)) = (&outcome, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    destination.write(&output::json(&FlightAnswerDocument::new(&study, &outcome))?)?;
    Ok(match outcome {
        FlightStudyOutcome::Simulated(_) => Exit::Complete,
        FlightStudyOutcome::NoPlan(_) => Exit::Negative,
        FlightStudyOutcome::Stopped => Exit::Stopped,
    })
}
