//! Answers as plain text.

use slewplan_solver::model::plan::{Margins, Outcome, Verification};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner::{CheckedCertificate, PlanCertificate};

mod authority;
mod blocks;
mod certification;
mod legs;
mod numbers;
mod published;
#[cfg(test)]
pub(crate) mod sample;
mod schedule;
mod slews;
mod studies;
mod summary;
mod table;

pub(crate) use authority::rows as authority;
pub(crate) use legs::table as legs;
pub(crate) use slews::answer as slews;
pub(crate) use studies::{comparison, envelopes, flight};

/// The summary of an outcome.
pub(crate) fn outcome(outcome: &Outcome, doubts: &[Problem], scenario: &Scenario) -> String {
    let title = scenario.name().unwrap_or("unnamed scenario");
    match outcome {
        Outcome::Planned(plan) => {
            let warnings: Vec<Problem> = doubts.iter().chain(&plan.warnings).cloned().collect();
            let published = published::find(title)
                .map_or_else(String::new, |known| known.comparison(plan, scenario));
            summary::title(title, plan)
                + &blocks::keep_out_banner(&warnings)
                + &summary::plan(plan, scenario.targets())
                + &published
                + &blocks::warnings(&warnings, Some(scenario))
        }
        Outcome::Infeasible(reasons) => {
            format!("{title}: infeasible, no plan can exist\n")
                + &blocks::reasons(reasons, Some(scenario))
        }
        Outcome::Failed(reasons) => {
            format!("{title}: failed, no plan was found\n")
                + &blocks::reasons(reasons, Some(scenario))
        }
        Outcome::StoppedEmpty => format!("{title}: stopped before a first plan was found\n"),
    }
}

/// A problem of a scenario, with the name of its target.
pub(crate) fn problem(problem: &Problem, scenario: &Scenario) -> String {
    blocks::named(problem, Some(scenario))
}

/// The text of a verification.
pub(crate) fn verification(
    found: &Verification,
    margins: &Margins,
    warnings: &[Problem],
) -> String {
    blocks::keep_out_banner(warnings)
        + &blocks::verification(found, margins)
        + &blocks::margins(margins)
        + &blocks::warnings(warnings, None)
}

/// The text of the check of a plan's proved bounds.
pub(crate) fn certification(certificate: &PlanCertificate, checked: &CheckedCertificate) -> String {
    certification::certificate(certificate, checked)
}
