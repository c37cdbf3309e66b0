//! `slewplan study envelopes`: envelopes of wheels and slews within them.

use super::given::StudyFiles;
use crate::cli::Exit;
use crate::cli::failure::Failure;
use crate::cli::output;
use crate::cli::signals;
use crate::cli::solve::{Threads, start_pool};
use crate::documents::study::envelopes::{self, EnvelopeAnswerDocument};
use crate::render::report;
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
    let (answer, request) = arguments.given.open(envelopes::read)?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let _received = signals::listen(&stop).map_err(Failure::Signals)?;
    let found = request.study.conduct(&pool, &stop);
    let document = EnvelopeAnswerDocument::new(&request, &found);
    answer.write(&document, || report::envelopes(&found, &request.warnings))?;
    let unsolved = found.unsolved();
    if unsolved > 0 {
        let plural = if unsolved == 1 { "" } else { "s" };
        output::complain(&format!("{unsolved} slew{plural} could not be solved"));
    }
    Ok(match (found.complete, unsolved) {
        (false, _) => Exit::Stopped,
        (true, 0) => Exit::Complete,
        (true, _) => Exit::Failed,
    })
}
