//! Planning within a study.

use crate::cli::failure::Failure;
use crate::cli::progress::{self, ProgressMode};
use crate::cli::signals::{self, Received};
use crate::cli::solve::{Threads, start_pool};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::Run;

/// Arguments for planning and its progress.
#[derive(Debug, clap::Args)]
pub(super) struct Planning {
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

impl Planning {
    /// Runs the work, which signals stop. Returns its result and the signals received.
    pub(super) fn conduct<T>(
        &self,
        work: impl FnOnce(Run<'_>) -> T,
    ) -> Result<(T, Received), Failure> {
        let pool = start_pool(&self.threads)?;
        let stop = StopSignal::new();
        let received = signals::listen(&stop).map_err(Failure::Signals)?;
        // Dropped here, so that the progress bar is removed before anything is written.
        // Every plan of a study has a time limit of its own.
        let observer = progress::observer(self.progress, None);
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
