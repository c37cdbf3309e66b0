//! The document that describes one flight of a plan.

use super::Simulation;
use crate::api::describe::inputs::{ForeignPlan, Scenario};
use serde::Serialize;
use utoipa::ToSchema;

/// A plan flown once in closed loop.
#[derive(Serialize, ToSchema)]
#[schema(as = FlightStudy)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct FlightBody {
    scenario: Scenario,
    /// A plan of the scenario; made for the flight without it.
    #[schema(required = false)]
    plan: Option<ForeignPlan>,
    /// How it is flown. The number of flights does not matter here.
    #[schema(required = false)]
    simulation: Option<Simulation>,
    /// Which of the flights of the seed; each draws other errors.
    #[schema(required = false, default = 0, format = "uint64")]
    flight: Option<u64>,
    /// One out of so many samples of the on-board computer is told; so many that there are no more
    /// than 2,000 without it.
    #[schema(required = false, minimum = 1, format = "uint64")]
    keep_every: Option<u64>,
}
