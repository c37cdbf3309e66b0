//! Answers as plain text.

use slewplan_solver::model::plan::{Margins, Outcome, Verification};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner::{CheckedCertificate, PlanCertificate};

mod blocks;
mod certification;
mod published;
#[cfg(test)]
pub(crate) mod sample;
mod summary;
mod table;

/// The summary of an outcome.
pub(crate) fn outcome(outcome: &Outcome, doubts: &[Problem], scenario: &Scenario) -> String {
    let title = scenario.name().unwrap_or("unnamed scenario");
    match outcome {
        Outcome::Planned(plan) => {
            let warnings: Vec<Problem> = doubts.iter().chain(&plan.warnings).cloned().collect();
            let published = published::find(title)
                .map_or_else(String::new, |known| known.comparison(plan, scenario));
            summary::plan(title, plan) + &published + &blocks::warnings(&warnings)
        }
        Outcome::Infeasible(reasons) => {
            format!("{title}: infeasible, no plan can exist\n") + &blocks::reasons(reasons)
        }
        Outcome::Failed(reasons) => {
            format!("{title}: failed, no plan was found\n") + &blocks::reasons(reasons)
        }
        Outcome::StoppedEmpty => format!("{title}: stopped before a first plan was found\n"),
    }
}

/// The text of a verification.
pub(crate) fn verification(
    found: &Verification,
    margins: &Margins,
    warnings: &[Problem],
) -> String {
    blocks::verification(found) + &blocks::margins(margins) + &blocks::warnings(warnings)
}

/// The text of the check of a plan's proved bounds.
pub(crate) fn certification(certificate: &PlanCertificate, checked: &CheckedCertificate) -> String {
    certification::certificate(certificate, checked)
}
