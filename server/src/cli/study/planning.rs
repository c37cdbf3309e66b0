//! Planning as a part of a study.

use crate::cli::failure::Failure;
use crate::cli::progress::{self, ProgressMode};
use crate::cli::signals::{self, Received};
use crate::cli::solve::{Threads, start_pool};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::Run;

/// How planning is done and shown.
#[derive(Debug, clap::Args)]
pub(super) struct Planning {
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

impl Planning {
    /// What the work came to, which signals stop, and the signal that did.
    pub(super) fn conduct<T>(
        &self,
        work: impl FnOnce(Run<'_>) -> T,
    ) -> Result<(T, Received), Failure> {
        let pool = start_pool(&self.threads)?;
        let stop = StopSignal::new();
        let received = signals::listen(&stop).map_err(Failure::Signals)?;
        // Its bar is gone when it is dropped here, before anything is written.
        let observer = progress::observer(self.progress);
        let done = work(Run {
            pool: &pool,
            stop: &stop,
            observer: &*observer,
            legs: &NoStore,
            segments: &NoStore,
        });
        Ok((done, received))
    }
}
