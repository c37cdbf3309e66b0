//! `slewplan study`: what the choice of an option leads to, and what wheels can do together.

mod comparison;
mod flight;

use super::failure::Failure;
use super::output::{self, Destination};
use super::solve::{Threads, start_pool};
use super::{Exit, input};
use crate::progress::{self, ProgressMode};
use crate::signals;
use crate::wire::study::authority::{self as shares, AuthorityAnswerDocument};
use crate::wire::study::envelopes::{self as reach, EnvelopeAnswerDocument};
use clap::Subcommand;
use slewplan_solver::legs::NoStore;
use slewplan_solver::planner::Run;
use slewplan_solver::stop::StopSignal;
use std::path::PathBuf;

/// What `study` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
enum Study {
    /// Which shares of torque and wheel speed a plan should leave to feedback
    Authority(AuthorityArguments),
    /// What the wheels can do together: envelopes, slews within them, torques shared out
    Envelopes(EnvelopeArguments),
    /// Reaction wheels against control moment gyroscopes: who turns faster, and from which angle on
    Comparison(comparison::Arguments),
    /// Fly a plan once in closed loop
    Flight(flight::Arguments),
}

#[derive(Debug, clap::Args)]
struct AuthorityArguments {
    /// Scenario, simulation and pairs of shares, - for standard input
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

#[derive(Debug, clap::Args)]
struct EnvelopeArguments {
    /// Spacecraft, turns and torques, - for standard input
    study: PathBuf,
    /// Write the answer to this file instead of standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    threads: Threads,
}

/// Conducts the study and writes the answer.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    match &arguments.study {
        Study::Authority(arguments) => authority(arguments),
        Study::Envelopes(arguments) => envelopes(arguments),
        Study::Comparison(arguments) => comparison::run(arguments),
        Study::Flight(arguments) => flight::run(arguments),
    }
}

fn authority(arguments: &AuthorityArguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let bytes = input::read(&arguments.study)?;
    let invalid = |problems| Failure::Invalid {
        name: input::name(&arguments.study),
        problems,
    };
    let study = shares::read(&bytes).map_err(invalid)?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let _received = signals::listen(&stop).map_err(Failure::Signals)?;
    let observer = progress::observer(arguments.progress);
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: &NoStore,
        segments: &NoStore,
    };
    let rows = study.conduct(run).map_err(invalid)?;
    drop(observer);
    let document = AuthorityAnswerDocument::new(&rows);
    destination.write(&output::json(&document)?)?;
    Ok(if document.is_complete() {
        Exit::Complete
    } else {
        Exit::Stopped
    })
}

fn envelopes(arguments: &EnvelopeArguments) -> Result<Exit, Failure> {
    let destination = Destination::open(&arguments.output)?;
    let bytes = input::read(&arguments.study)?;
    let request = reach::read(&bytes).map_err(|problems| Failure::Invalid {
        name: input::name(&arguments.study),
        problems,
    })?;
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let _received = signals::listen(&stop).map_err(Failure::Signals)?;
    let report = request.study.conduct(&pool, &stop);
    destination.write(&output::json(&EnvelopeAnswerDocument::new(
        &request, &report,
    ))?)?;
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
