//! `slewplan export`: writes a plan in the format of another tool.

use super::failure::Failure;
use super::form::FormatOptions;
use super::output::{self, Destination};
use super::{Exit, input};
use crate::documents;
use crate::render::export::Format;
use slewplan_solver::checker;
use std::path::PathBuf;

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
pub(super) struct ExportArguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// The plan in JSON, - for standard input
    plan: PathBuf,
    /// Format of the file
    #[arg(long, value_enum)]
    format: Format,
    /// Write to this file
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    choices: FormatOptions,
}

/// Propagates the plan and writes it, if it passes the verification.
pub(super) fn run(arguments: &ExportArguments) -> Result<Exit, Failure> {
    input::one_stream_at_most(&[&arguments.scenario, &arguments.plan])?;
    let destination = Destination::open(&arguments.output)?;
    let scenario = input::scenario(&arguments.scenario, None)?.scenario;
    arguments.choices.check(arguments.format, &scenario)?;
    let flight = input::of_plan(&arguments.plan, &scenario, documents::flight::read)?;
    // With the wrong scenario the file would be plausible and its attitudes wrong.
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
        .write(arguments.format, &scenario, &flight)?;
    destination.write(&text)?;
    Ok(Exit::Complete)
}
