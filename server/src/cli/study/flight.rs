//! `slewplan study flight`: simulates a plan once in closed loop.

use super::given::StudyFiles;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::documents::study::flight::{self, FlightAnswerDocument};
use crate::render::report;
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
    let (answer, study) = given.open(flight::read)?;
    let (outcome, received) = arguments.planning.conduct(|run| simulate(&study, run))?;
    let outcome = outcome.map_err(|problems| given.invalid(problems))?;
    if let (FlightStudyOutcome::Stopped, Some(code)) = (&outcome, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    let document = FlightAnswerDocument::new(&study, &outcome);
    answer.write(&document, || report::flight(&study, &outcome))?;
    Ok(match outcome {
        FlightStudyOutcome::Simulated(_) => Exit::Complete,
        FlightStudyOutcome::NoPlan(_) => Exit::Negative,
        FlightStudyOutcome::Stopped => Exit::Stopped,
    })
}
