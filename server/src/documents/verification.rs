//! A request to verify a plan, and its answer.

use super::flight::ForeignPlan;
use super::plan::{MarginsDocument, VerificationDocument};
use super::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::input::{Unread, input_object, required_or};
use slewplan_solver::model::plan::{Margins, Verification};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::spec::ScenarioSpec;
use utoipa::ToSchema;

input_object! {
    /// A plan made by anyone, with the scenario that it is for.
    pub(crate) struct VerifySpec as "VerifyBody" {
        /// What the plan is for.
        scenario: () as Unread<ScenarioSpec> = required_or(()),
        /// The plan.
        plan: () as Unread<ForeignPlan> = required_or(()),
    }
}

/// What flying a plan again showed.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = VerificationReport)]
pub(crate) struct ReportDocument<'a> {
    #[serde(flatten)]
    verification: VerificationDocument<'a>,
    margins: MarginsDocument,
    warnings: Vec<ProblemDocument<'a>>,
}

impl<'a> ReportDocument<'a> {
    /// Errors, margins and warnings of a flight.
    pub(crate) fn new(
        verification: &'a Verification,
        margins: &Margins,
        warnings: &'a [Problem],
    ) -> Self {
        Self {
            verification: verification.into(),
            margins: margins.into(),
            warnings: documents(warnings),
        }
    }
}
