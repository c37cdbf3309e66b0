//! Independent verification: re-integrates a flight and tests every limit and boundary.

use crate::plan::{Flight, Margins, State, Verification};
use crate::problem::Problem;
use crate::scenario::Scenario;

/// What the re-integration of a flight found.
#[derive(Debug, Clone)]
pub struct Report {
    /// Errors against the tolerances.
    pub verification: Verification,
    /// What is left of every limit.
    pub margins: Margins,
    /// States at every control boundary and between, in order of time.
    pub states: Vec<State>,
    /// Keep-out violations, with time and depth.
    pub keep_out: Vec<Problem>,
}

/// Re-integrates a flight made by anyone from the scenario's start and tests it.
#[must_use]
pub fn verify(scenario: &Scenario, flight: &Flight) -> Report {
    let _ = (scenario, flight);
    unimplemented!()
}
