//! `slewplan study flight`: a plan flown once in closed loop.

use crate::cli::failure::Failure;
use crate::cli::output::{self, Destination};
use crate::cli::solve::{Threads, start_pool};
use crate::cli::{Exit, input};
use crate::flights::{self, Outcome};
use crate::progress::{self, ProgressMode};
use crate::signals;
use crate::wire::study::flight::{self, FlightAnswerDocument};
use slewplan_solver::legs::NoStore;
use slewplan_solver::planner::Run;
use slewplan_solver::stop::StopSignal;
use std::path::PathBuf;

/// What `study flight` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scenario, how it is flown, and perhaps a plan of it, - for standard input
    study: PathBuf,
    /// Write the answer to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    threads: Threads,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
}

/// Plans, flies and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let bytes = input::read(&arguments.study)?;
    let invalid = |problems| Failure::Invalid {
        name: input::name(&arguments.study),
        problems,
    };
    let study = flight::read(&bytes).map_err(invalid)?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let observer = progress::observer(arguments.progress);
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: &NoStore,
        segments: &NoStore,
    };
    let flown = flights::fly(&study, run).map_err(invalid)?;
    drop(observer);
    if let (Outcome::Stopped, Some(code)) = (&flown, received.exit_code()) {
        return Ok(Exit::Signalled(code));
    }
    destination.write(&output::json(&FlightAnswerDocument::new(&study, &flown))?)?;
    Ok(match flown {
        Outcome::Flown(_) => Exit::Complete,
        Outcome::NoPlan(_) => Exit::Negative,
        Outcome::Stopped => Exit::Stopped,
    })
}
