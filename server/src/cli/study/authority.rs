//! `slewplan study authority`: compares shares of torque and speed that a plan leaves to feedback.

use super::given::StudyFiles;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::documents::study::authority::{self, AuthorityAnswerDocument};
use crate::render::report;

/// Arguments of `study authority`.
#[derive(Debug, clap::Args)]
pub(super) struct AuthorityStudyArguments {
    #[command(flatten)]
    given: StudyFiles,
    #[command(flatten)]
    planning: Planning,
}

/// Plans and simulates for every pair of shares and writes the answer.
pub(super) fn run(arguments: &AuthorityStudyArguments) -> Result<Exit, Failure> {
    let given = &arguments.given;
    let (answer, study) = given.open(authority::read)?;
    let (rows, _) = arguments.planning.conduct(|run| study.conduct(run))?;
    let rows = rows.map_err(|problems| given.invalid(problems))?;
    let document = AuthorityAnswerDocument::new(&rows);
    answer.write(&document, || report::authority(&rows))?;
    Ok(if document.is_complete() {
        Exit::Complete
    } else {
        Exit::Stopped
    })
}
