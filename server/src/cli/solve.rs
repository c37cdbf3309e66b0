//! `slewplan solve`: plans a scenario.

use super::answer::Summary;
use super::failure::Failure;
use super::form::FormatOptions;
use super::output::{self, Destination};
use super::remembered::CommandLegCache;
use super::{Exit, input};
use crate::cli::progress::{self, ProgressMode};
use crate::cli::signals::{self, Received};
use crate::documents;
use crate::documents::plan::Interruption;
use crate::render::export::Form;
use crate::render::report;
use crate::store::DatabaseAddress;
use slewplan_solver::model::plan::{Optimality, Outcome};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::{Scenario, Validated};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegStore, NoStore};
use slewplan_solver::tour::planner::{self, Run};
use std::io::{IsTerminal, stdout};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Arguments of `solve`.
#[derive(Debug, clap::Args)]
pub(super) struct SolveArguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// Write the plan to this file
    #[arg(short, long, value_name = "PLAN")]
    output: Option<PathBuf>,
    /// Format of the plan [default: json]
    #[arg(long, value_enum)]
    format: Option<Form>,
    /// Print a summary as text, as on a terminal
    #[arg(long)]
    summary: bool,
    /// Exit with 5 when the plan violates a cone that is only reported; it is written all the same
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    threads: Threads,
    /// Stop with the best plan so far after this time, s, whatever the scenario says
    #[arg(long, value_name = "S", value_parser = seconds)]
    time_limit: Option<f64>,
    /// Read known legs from this database of the service, and store new ones in it
    #[arg(long, value_name = "FILE|URL")]
    database: Option<DatabaseAddress>,
    /// How to show progress on standard error
    #[arg(long, value_enum, default_value_t = ProgressMode::Auto)]
    progress: ProgressMode,
    #[command(flatten)]
    choices: FormatOptions,
}

/// Number of worker threads.
#[derive(Debug, clap::Args)]
pub(super) struct Threads {
    /// Worker threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// Starts the worker threads.
pub(super) fn start_pool(threads: &Threads) -> Result<SolverPool, Failure> {
    let count = threads
        .threads
        .and_then(|count| NonZeroUsize::new(count.into()));
    Ok(SolverPool::new(count)?)
}

/// A time limit within the range of scenarios.
fn seconds(text: &str) -> Result<f64, &'static str> {
    text.parse()
        .ok()
        .filter(|limit: &f64| *limit > 0.0 && *limit <= 1e9)
        .ok_or("expected a number of seconds above 0 and at most 1e9")
}

/// Solves the scenario and writes plan and summary.
pub(super) fn run(arguments: &SolveArguments) -> Result<Exit, Failure> {
    let outlets = Outlets::open(arguments)?;
    let Validated { scenario, warnings } =
        input::scenario(&arguments.scenario, arguments.time_limit)?;
    outlets.check(arguments, &scenario)?;
    let (outcome, received) = solve(arguments, &scenario)?;
    if let (Outcome::StoppedEmpty, Some(code)) = (&outcome, received.exit_code()) {
        output::complain("stopped before a first plan was found");
        return Ok(Exit::Signalled(code));
    }
    outlets.write(arguments, &outcome, &warnings, &scenario)?;
    Ok(exit(&outcome, arguments.strict))
}

fn solve(arguments: &SolveArguments, scenario: &Scenario) -> Result<(Outcome, Received), Failure> {
    let pool = start_pool(&arguments.threads)?;
    let stop = StopSignal::new();
    let received = signals::listen(&stop).map_err(Failure::Signals)?;
    let observer = progress::observer(arguments.progress, scenario.options().time_limit_s);
    let remembered = arguments
        .database
        .as_ref()
        .map(CommandLegCache::open)
        .transpose()?;
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &*observer,
        legs: remembered
            .as_ref()
            .map_or(&NoStore as &dyn LegStore, CommandLegCache::legs),
        segments: &NoStore,
    };
    Ok((planner::solve(scenario, run), received))
}

fn exit(outcome: &Outcome, strict: bool) -> Exit {
    match outcome {
        Outcome::Planned(plan) if strict && !plan.margins.keep_out_intrusions.is_empty() => {
            output::complain("the plan violates a keep-out cone (--strict)");
            Exit::Violated
        }
        Outcome::Planned(plan) => match plan.optimality {
            Optimality::Optimal => Exit::Complete,
            Optimality::Feasible => Exit::Stopped,
        },
        Outcome::Infeasible(_) => Exit::Negative,
        Outcome::Failed(_) | Outcome::StoppedEmpty => Exit::Failed,
    }
}

/// The destinations of plan and summary.
struct Outlets {
    plan: Option<(Destination, Form)>,
    summary: Summary,
}

impl Outlets {
    /// The plan goes to the named file, or to standard output if that is no terminal or a format
    /// was requested; the summary goes to a terminal, or where it was requested.
    fn open(arguments: &SolveArguments) -> Result<Self, Failure> {
        let person = stdout().is_terminal();
        let format = arguments.format.unwrap_or(Form::Json);
        if format == Form::Json && !arguments.choices.are_default() {
            return Err(Failure::Setting {
                name: "--format",
                what: "json leaves no choice of samples, rates, wheel or object".into(),
            });
        }
        let destination = match &arguments.output {
            Some(path) => Some(Destination::open(path)?),
            None if arguments.format.is_some() => Some(Destination::Stream),
            None if person || arguments.summary => None,
            None => Some(Destination::Stream),
        };
        let summary = Summary::beside(destination.as_ref(), arguments.summary);
        Ok(Self {
            plan: destination.map(|destination| (destination, format)),
            summary,
        })
    }

    /// Tests before the solve whether the plan can be written.
    fn check(&self, arguments: &SolveArguments, scenario: &Scenario) -> Result<(), Failure> {
        match &self.plan {
            Some((_, Form::Export(format))) => arguments.choices.check(*format, scenario),
            _ => Ok(()),
        }
    }

    fn write(
        &self,
        arguments: &SolveArguments,
        outcome: &Outcome,
        warnings: &[Problem],
        scenario: &Scenario,
    ) -> Result<(), Failure> {
        if let Some((destination, form)) = &self.plan {
            match (form, outcome) {
                (Form::Json, _) => {
                    // After a signal without a plan nothing is written.
                    let stopped = [Interruption::TimeLimit.reason()];
                    let document = documents::plan::document(outcome, &stopped, warnings);
                    destination.write(&output::json(&document)?)?;
                }
                (Form::Export(format), Outcome::Planned(plan)) => {
                    let choices = &arguments.choices;
                    destination.write(&choices.write(*format, scenario, &plan.flight)?)?;
                }
                // There is no plan to export; the reasons go to standard error below.
                (Form::Export(_), _) => {}
            }
        }
        let text = report::outcome(outcome, warnings, scenario);
        if self.summary == Summary::None && !matches!(outcome, Outcome::Planned(_)) {
            output::remark(&text);
        }
        self.summary.print(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_limits_are_positive_and_finite() {
        assert_eq!(seconds("1.5").map(f64::to_bits), Ok(1.5_f64.to_bits()));
        for wrong in ["0", "-1", "NaN", "inf", "1e10", "x", ""] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
