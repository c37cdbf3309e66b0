//! `slewplan slew`: solves one slew with a choice of objective and command.

use super::answer::AnswerOptions;
use super::failure::Failure;
use super::{Exit, input, output};
use crate::cli::signals;
use crate::documents::slew::{self, SlewAnswerDocument};
use crate::jobs::slews::{self, SlewSolutions};
use crate::render::report;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::SlewOutcome;
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
    let outcomes = solved.outcomes.iter().map(|(outcome, _)| outcome);
    let unsolved: Vec<&SlewOutcome> = outcomes.filter(|outcome| !outcome.solved).collect();
    if unsolved.is_empty() {
        return Exit::Complete;
    }
    output::complain(&format!(
        "{} of {} slews could not be solved",
        unsolved.len(),
        solved.outcomes.len()
    ));
    // One that failed might exist.
    if unsolved.iter().all(|outcome| outcome.proved_infeasible) {
        Exit::Negative
    } else {
        Exit::Failed
    }
}
