//! `slewplan study authority`: which shares of torque and speed a plan should leave to feedback.

use super::given::Given;
use super::planning::Planning;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::documents::study::authority::{self, AuthorityAnswerDocument};

/// What `study authority` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    given: Given,
    #[command(flatten)]
    planning: Planning,
}

/// Plans and flies for every pair of shares and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let given = &arguments.given;
    let (destination, study) = given.open(authority::read)?;
    let (rows, _) = arguments.planning.conduct(|run| study.conduct(run))?;
    let rows = rows.map_err(|problems| given.invalid(problems))?;
    let document = AuthorityAnswerDocument::new(&rows);
    destination.write(&output::json(&document)?)?;
    Ok(if document.is_complete() {
        Exit::Complete
    } else {
        Exit::Stopped
    })
}
