//! `slewplan slew`: solves one slew with a choice of objective and command.

use super::answer::AnswerOptions;
use super::failure::Failure;
use super::{Exit, input, output};
use crate::cli::signals;
use crate::documents::slew::{self, SlewAnswerDocument};
use crate::jobs::slews::{self, SlewSolutions};
use crate::render::report;
use slewplan_solver::run::stop::StopSignal;
use std::path::PathBuf;

/// Arguments of `slew`.
#[derive(Debug, clap::Args)]
pub(super) struct SlewArguments {
    /// The slew, - for standard input
    slew: PathBuf,
    #[command(flatten)]
    answer: AnswerOptions,
}

/// Solves the slew and writes the answer.
pub(super) fn run(arguments: &SlewArguments) -> Result<Exit, Failure> {
    let answer = arguments.answer.open()?;
    let bytes = input::read(&arguments.slew)?;
    let invalid = |problems| Failure::Invalid {
        name: input::name(&arguments.slew),
        problems,
    };
    let request = slew::read(&bytes).map_err(invalid)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let solved = slews::solve(&request, &stop).map_err(invalid)?;
    if let (true, Some(code)) = (solved.outcomes.is_empty(), received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    let document = SlewAnswerDocument::new(&request, &solved.outcomes, solved.complete);
    answer.write(&document, || {
        report::slews(&request, &solved.outcomes, solved.complete)
    })?;
    Ok(exit(&solved))
}

fn exit(solved: &SlewSolutions) -> Exit {
    if !solved.complete {
        return Exit::Stopped;
    }
    let unsolved = solved
        .outcomes
        .iter()
        .filter(|(outcome, _)| !outcome.solved);
    let unsolved = unsolved.count();
    if unsolved == 0 {
        return Exit::Complete;
    }
    output::complain(&format!(
        "{unsolved} of {} slews could not be solved",
        solved.outcomes.len()
    ));
    Exit::Failed
}
