//! `slewplan export`: a plan that there is already, in the format of another tool.

use super::failure::Failure;
use super::form::Choices;
use super::output::{self, Destination};
use super::{Exit, input};
use crate::documents;
use crate::render::export::Format;
use slewplan_solver::checker;
use std::path::PathBuf;

/// What `export` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// The plan in JSON, - for standard input
    plan: PathBuf,
    /// What to write
    #[arg(long, value_enum)]
    format: Format,
    /// Write to this file
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    choices: Choices,
}

/// Flies the plan and writes it, if it passes.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    input::one_stream_at_most(&[&arguments.scenario, &arguments.plan])?;
    let destination = Destination::open(&arguments.output)?;
    let scenario = input::scenario(&arguments.scenario, None)?.scenario;
    arguments.choices.check(arguments.format, &scenario)?;
    let flight = input::of_plan(&arguments.plan, &scenario, documents::flight::read)?;
    // A plan beside the wrong scenario makes files that look well and point elsewhere.
    let found = checker::verify(&scenario, &flight).verification;
    if !found.passed {
        output::complain("not exported, because the plan does not pass its verification:");
        for failure in &found.failures {
            output::complain(failure);
        }
        return Ok(Exit::Negative);
    }
    let text = arguments
        .choices
        .write(arguments.format, (&scenario, &flight))?;
    destination.write(&text)?;
    Ok(Exit::Complete)
}
