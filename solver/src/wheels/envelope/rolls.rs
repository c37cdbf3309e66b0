//! Whether the wheels can hold the momentum at any of the admissible rolls.
//!
//! The least largest load of the wheels is a norm of what they carry, and what they carry turns with the
//! roll about the boresight. Between two rolls the load therefore changes by no more than the norm of
//! the part across the boresight times the angle, and an interval around a roll whose load is above 1 by
//! more than that has no roll that is held.

use super::{LOAD_TOLERANCE, MomentumHold, hold_momentum};
use crate::model::spacecraft::Spacecraft;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Rolls at the beginning.
const ROLLS: u32 = 12;
/// Half of the narrowest interval that is looked at, rad.
const NARROWEST: f64 = 1e-5;

/// What the wheels carry, N m s, and how.
type Carried = (Vector3<f64>, MomentumHold);

/// Largest load of the wheels by a momentum of 1 N m s in any direction, at most.
pub(super) fn load_per_momentum(spacecraft: &Spacecraft, authority: f64) -> Option<f64> {
    let at_rest = vec![0.0; spacecraft.wheels().len()];
    let load = |axis: Vector3<f64>| {
        let hold = hold_momentum(spacecraft, authority, &at_rest, axis)?;
        Some(hold.load)
    };
    let along = [Vector3::x(), Vector3::y(), Vector3::z()].map(load);
    let [x, y, z] = along;
    Some(Vector3::new(x?, y?, z?).norm())
}

/// What the wheels carry at a roll that they hold, or else at the one with the least load that was
/// looked at; `change` is the greatest change of the load per radian. `None` where it cannot be told
/// whether they hold any.
pub(super) fn least_loaded(
    at: impl Fn(f64) -> Option<Carried>,
    range: Option<[f64; 2]>,
    change: f64,
) -> Option<Carried> {
    let [low, high] = range.unwrap_or([-PI, PI]);
    let half = 0.5 * (high - low) / f64::from(ROLLS);
    let first = (0..ROLLS)
        .rev()
        .map(|step| low + half * f64::from(2 * step + 1));
    let mut open: Vec<_> = first.map(|roll| (roll, half)).collect();
    let mut least: Option<Carried> = None;
    while let Some((roll, half)) = open.pop() {
        let found = at(roll)?;
        if found.1.fits() {
            return Some(found);
        }
        let load = found.1.load;
        if least.as_ref().is_none_or(|least| load < least.1.load) {
            least = Some(found);
        }
        if load - change * half <= 1.0 + LOAD_TOLERANCE {
            if half < NARROWEST {
                return None;
            }
            open.extend([0.5, -0.5].map(|share| (roll + share * half, 0.5 * half)));
        }
    }
    least
}
