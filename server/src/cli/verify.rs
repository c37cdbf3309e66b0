//! `slewplan verify`: verifies a plan of any origin.

use super::failure::Failure;
use super::{Exit, input, output};
use crate::documents::verification::{ClaimedPlan, ReportDocument};
use crate::render::report;
use slewplan_solver::model::problem::Problem;
use std::io::{IsTerminal, stdout};
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Debug, clap::Args)]
pub(super) struct VerifyArguments {
    /// The scenario, - for standard input
    scenario: PathBuf,
    /// The plan in JSON, - for standard input
    plan: PathBuf,
    /// Print text instead of JSON, as on a terminal
    #[arg(long)]
    summary: bool,
    /// Exit with 5 when a plan that passes violates a cone that is only reported
    #[arg(long)]
    strict: bool,
}

/// Prints the verification on standard output.
pub(super) fn run(arguments: &VerifyArguments) -> Result<Exit, Failure> {
    input::one_stream_at_most(&[&arguments.scenario, &arguments.plan])?;
    let valid = input::scenario(&arguments.scenario, None)?;
    let plan = input::of_plan(&arguments.plan, &valid.scenario, ClaimedPlan::read)?;
    let found = plan.verify(&valid.scenario);
    let warnings = valid.warnings.into_iter().chain(found.keep_out);
    let warnings: Vec<Problem> = warnings.chain(plan.into_false_claims()).collect();
    output::print(&if arguments.summary || stdout().is_terminal() {
        report::verification(&found.verification, &found.margins, &warnings)
    } else {
        let document = ReportDocument::new(&found.verification, &found.margins, &warnings);
        output::json(&document)?
    })?;
    let violated = !found.margins.keep_out_intrusions.is_empty();
    Ok(match (found.verification.passed, violated) {
        (false, _) => Exit::Negative,
        (true, true) if arguments.strict => {
            output::complain("the plan violates a keep-out cone (--strict)");
            Exit::Violated
        }
        (true, _) => Exit::Complete,
    })
}
