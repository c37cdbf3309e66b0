//! How close the boresights of many simulated flights come to cones.

use super::outcome::SimulatedFlight;
use super::percentiles::LowPercentiles;
use crate::model::cone::{Applies, Cone};
use crate::model::plan::ConeClearance;
use crate::model::tolerances::ATTITUDE_TOLERANCE;
use nalgebra::Vector3;

/// How close many flights come to a cone.
#[derive(Debug, Clone, PartialEq)]
pub struct ConeSpread {
    /// Name of the boresight.
    pub boresight: String,
    /// JSON pointer of the cone in the scenario.
    pub cone: String,
    /// Unit vector along the cone's axis in the reference frame.
    pub direction: Vector3<f64>,
    /// When the cone is enforced.
    pub applies: Applies,
    /// Share of the flights that stay on the right side of it while it applies.
    pub share_clear: f64,
    /// Least angles of flights to the cone's surface while it applied, degrees; negative on the wrong
    /// side. Flights that broke off have minus [`NOT_COMPUTED`](crate::checker::NOT_COMPUTED) or less.
    pub clearance_deg: LowPercentiles,
}

/// The spread of every cone. `cones` are those that flights have, in the same order.
pub(super) fn of(cones: &[&Cone], simulated: &[SimulatedFlight]) -> Vec<ConeSpread> {
    let spread = |(index, cone): (usize, &&Cone)| {
        let nearest = || simulated.iter().map(move |flight| &flight.cones[index]);
        let clear = nearest().filter(|nearest| keeps(nearest)).count();
        ConeSpread {
            boresight: cone.boresight.clone(),
            cone: cone.pointer(),
            direction: cone.direction,
            applies: cone.applies,
            share_clear: clear as f64 / simulated.len().max(1) as f64,
            clearance_deg: LowPercentiles::of(nearest().map(|nearest| nearest.clearance_deg)),
        }
    };
    cones.iter().enumerate().map(spread).collect()
}

/// Whether a flight stays clear of all enforced cones. `cones` are those that it has.
pub(super) fn is_clear(cones: &[&Cone], flight: &SimulatedFlight) -> bool {
    let mut each = cones.iter().zip(&flight.cones);
    each.all(|(cone, nearest)| !cone.is_enforced() || keeps(nearest))
}

/// Whether a boresight stays on the right side of a cone, up to the tolerance that the checker of plans
/// has too: the fastest plans touch cones.
fn keeps(nearest: &ConeClearance) -> bool {
    nearest.clearance_deg >= -ATTITUDE_TOLERANCE.to_degrees()
}
