//! `slewplan study envelopes`: envelopes of wheels and slews within them.

use super::given::StudyFiles;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::signals;
use crate::cli::solve::{Threads, start_pool};
use crate::documents::study::envelopes::{self, EnvelopeAnswerDocument};
use slewplan_solver::run::stop::StopSignal;

/// Arguments of `study envelopes`.
#[derive(Debug, clap::Args)]
pub(super) struct EnvelopesStudyArguments {
    #[command(flatten)]
    given: StudyFiles,
    #[command(flatten)]
    threads: Threads,
}

/// Runs the study and writes the answer.
pub(super) fn run(arguments: &EnvelopesStudyArguments) -> Result<Exit, Failure> {
    let (destination, request) = arguments.given.open(envelopes::read)?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let _received = signals::listen(&stop).map_err(Failure::Signals)?;
    let report = request.study.conduct(&pool, &stop);
    let document = EnvelopeAnswerDocument::new(&request, &report);
    destination.write(&output::json(&document)?)?;
    let unsolved = report.unsolved();
    if unsolved > 0 {
        output::complain(&format!("{unsolved} slews could not be solved"));
    }
    Ok(match (report.complete, unsolved) {
        (false, _) => Exit::Stopped,
        (true, 0) => Exit::Complete,
        (true, _) => Exit::Failed,
    })
}
