//! `slewplan certify`: proves the certified bounds of a plan a second time.

use super::failure::Failure;
use super::solve::{Threads, start_pool};
use super::{Exit, input, output};
use crate::cli::progress::{self, ProgressMode};
use crate::cli::signals;
use crate::documents;
use crate::documents::certification::CertificationDocument;
use crate::render::report;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::{self, Run};
use std::io::{IsTerminal, stdout};
use std::path::PathBuf;

/// Arguments of `certify`.
#[derive(Debug, clap::Args)]
pub(super) struct CertifyArguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// The plan in JSON, - for standard input
    plan: PathBuf,
    /// Print text instead of JSON, as on a terminal
    #[arg(long)]
    summary: bool,
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

/// Checks every proved bound and prints the results on standard output.
pub(super) fn run(arguments: &CertifyArguments) -> Result<Exit, Failure> {
    input::one_stream_at_most(&[&arguments.scenario, &arguments.plan])?;
    let scenario = input::scenario(&arguments.scenario, None)?.scenario;
    let certificate = input::of_plan(&arguments.plan, &scenario, documents::claims::read)?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let observer = progress::observer(arguments.progress, None);
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: &NoStore,
        segments: &NoStore,
    };
    let checked = planner::verify_certificate(&scenario, &certificate, run);
    drop(observer);
    output::print(&if arguments.summary || stdout().is_terminal() {
        report::certification(&certificate, &checked)
    } else {
        output::json(&CertificationDocument::new(&certificate, &checked))?
    })?;
    // After a signal the remaining bounds are reported as not checked.
    let signal = received.exit_code().map(Exit::Signalled);
    let confirmed = checked.confirmed();
    Ok(match (confirmed, signal) {
        (true, _) => Exit::Complete,
        (false, Some(signal)) => signal,
        (false, None) => Exit::Negative,
    })
}
