//! `slewplan validate`: lists all errors and warnings of a scenario.

use super::failure::{Failure, heading};
use super::{Exit, input, output};
use crate::documents;
use crate::documents::problems::ValidationDocument;
use crate::render::report;
use clap::ValueEnum;
use slewplan_solver::model::problem::{Faults, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `validate`.
#[derive(Debug, clap::Args)]
pub(super) struct ValidateArguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// Format of the findings
    #[arg(long, value_enum, default_value_t = FindingsFormat::Text)]
    format: FindingsFormat,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FindingsFormat {
    Text,
    Json,
}

/// Prints the findings on standard output.
pub(super) fn run(arguments: &ValidateArguments) -> Result<Exit, Failure> {
    let name = input::name(&arguments.scenario);
    let malformed = |problem| Faults {
        problems: vec![problem],
        ..Faults::default()
    };
    let found = documents::document::parse(&input::read(&arguments.scenario)?)
        .map_err(malformed)
        .and_then(|node| documents::scenario::examine(&node, None));
    let (errors, warnings, scenario) = match found {
        Ok(valid) => (
            planner::feasibility_problems(&valid.scenario),
            valid.warnings,
            Some(valid.scenario),
        ),
        Err(faults) => (faults.problems, faults.warnings, None),
    };
    output::print(&match arguments.format {
        FindingsFormat::Text => text(&name, &errors, &warnings, scenario.as_ref()),
        FindingsFormat::Json => output::json(&ValidationDocument::new(&errors, &warnings))?,
    })?;
    Ok(if errors.is_empty() {
        Exit::Complete
    } else {
        Exit::Invalid
    })
}

fn text(
    name: &str,
    errors: &[Problem],
    warnings: &[Problem],
    scenario: Option<&Scenario>,
) -> String {
    let told = |problem: &Problem| match scenario {
        Some(scenario) => report::problem(problem, scenario),
        None => problem.to_string(),
    };
    let mut text = if errors.is_empty() {
        format!("{name} is valid")
    } else {
        heading(name, errors)
    };
    for error in errors {
        let _ = write!(text, "\n{}", told(error));
    }
    if !warnings.is_empty() {
        let plural = if warnings.len() == 1 { "" } else { "s" };
        let _ = write!(text, "\n{} warning{plural}", warnings.len());
        for warning in warnings {
            let _ = write!(text, "\n{}", told(warning));
        }
    }
    text.push('\n');
    text
}
