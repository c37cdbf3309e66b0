//! A plan to be verified, a request to do so, and its answer.

mod own_bounds;
mod own_schedule;

use super::document::{self, Node};
use super::flight::{self, ForeignPlan};
use super::plan::{MarginsDocument, VerificationDocument};
use super::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::checker::{self, CheckReport, ScheduleClaims};
use slewplan_solver::model::input::{Unread, input_object, required_or};
use slewplan_solver::model::plan::{Flight, Margins, Verification};
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Scenario;
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

/// A plan made by anyone: what it flies, and what it claims of itself though it cannot be.
#[derive(Debug)]
pub(crate) struct ClaimedPlan {
    flight: Flight,
    schedule: ScheduleClaims,
    false_claims: Vec<Problem>,
}

impl ClaimedPlan {
    /// Reads a plan for a scenario.
    ///
    /// # Errors
    ///
    /// Everything that keeps it from being flown, with pointers into the plan.
    pub(crate) fn read(bytes: &[u8], scenario: &Scenario) -> Result<Self, Vec<Problem>> {
        Self::read_node(
            &document::parse(bytes).map_err(|problem| vec![problem])?,
            scenario,
        )
    }

    /// Reads a plan that has been parsed.
    ///
    /// # Errors
    ///
    /// Everything that keeps it from being flown, with pointers into the plan.
    pub(crate) fn read_node(node: &Node, scenario: &Scenario) -> Result<Self, Vec<Problem>> {
        let flight = flight::read_node(node, scenario)?;
        Ok(Self {
            false_claims: own_bounds::above_times(node, flight.total_time_s),
            schedule: own_schedule::claims(node),
            flight,
        })
    }

    /// Verifies the flight. A false claim is a failure too.
    pub(crate) fn verify(&self, scenario: &Scenario) -> CheckReport {
        let mut found = checker::verify_with_claims(scenario, &self.flight, &self.schedule);
        let verification = &mut found.verification;
        let claims = self.false_claims.iter().map(|claim| claim.message.clone());
        verification.failures.extend(claims);
        verification.passed = verification.failures.is_empty();
        found
    }

    /// The false claims, with pointers into the plan.
    pub(crate) fn into_false_claims(self) -> Vec<Problem> {
        self.false_claims
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

/// A member that is a number.
fn number(object: &Node, name: &str) -> Option<f64> {
    match object.member(name)? {
        Node::Integer(value) => Some(*value as f64),
        Node::Number(value) => Some(*value),
        _ => None,
    }
}
