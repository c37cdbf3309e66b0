//! The leg between two ends that one state meets: nothing moves and no time passes.

use super::LegProblem;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::scenario::RateCondition;
use crate::model::waypoint::{Waypoint, WheelCondition};
use crate::nlp::NlpStatus;
use nalgebra::{DVector, Vector3};

/// Attitudes closer than this are the same, rad.
pub(crate) const SAME_ATTITUDE: f64 = 1e-11;
/// Rates closer than this are the same, rad/s: a thousandth of the checker's tolerance.
const SAME_RATE: f64 = 1e-10;
/// Relative difference below which wheel momenta are the same.
const SAME_MOMENTUM: f64 = 1e-9;

/// The solution without motion, where one state meets both ends.
pub(super) fn zero_length(leg: &LegProblem<'_>) -> Option<LegSolution> {
    let ends = [leg.from, leg.to];
    let turn = leg.arrival.turn(&leg.from.attitude, &leg.to.attitude);
    if turn > SAME_ATTITUDE || ends.iter().any(|end| end.costates.is_some()) {
        return None;
    }
    let wheels = wheels(leg);
    let rate = leg.dynamics.rate(&leg.from.attitude, &wheels);
    let met = |end: &&Waypoint| {
        (0..3).all(|axis| contains(end.rate[axis], rate[axis])) && held(leg, &end.wheels, &wheels)
    };
    let within = ends.iter().any(|end| end.is_fixed(leg.dynamics))
        || leg.dynamics.speed_usage(&rate, &wheels) <= 1.0;
    (within && ends.iter().all(met)).then(|| LegSolution {
        status: NlpStatus::Converged,
        profile: Profile::zero_length(leg.from.attitude, wheels, leg.intervals()),
        intervals: vec![leg.intervals()],
        iterations: 0,
        infeasibility: 0.0,
        costates: Vec::new(),
    })
}

/// The wheel momenta, N m s, of the state that meets both ends, if there is one.
fn wheels(leg: &LegProblem<'_>) -> DVector<f64> {
    let conditions = [&leg.from.wheels, &leg.to.wheels];
    let fixed = |condition: &&WheelCondition| match condition {
        WheelCondition::Fixed(momenta) => Some(momenta.clone()),
        WheelCondition::NullSpace(_) | WheelCondition::Free => None,
    };
    let null = |condition: &&WheelCondition| match condition {
        WheelCondition::NullSpace(null) => Some(null.clone()),
        WheelCondition::Fixed(_) | WheelCondition::Free => None,
    };
    conditions.iter().find_map(fixed).unwrap_or_else(|| {
        let rate = Vector3::from_fn(|axis, _| slowest(leg.from.rate[axis], leg.to.rate[axis]));
        let null = conditions.iter().find_map(null);
        let null = null.as_ref().unwrap_or(leg.null);
        leg.dynamics.wheels_at(&leg.from.attitude, &rate, null)
    })
}

/// The rate nearest to zero that meets two conditions, if there is one.
fn slowest(one: RateCondition, other: RateCondition) -> f64 {
    let ([a, b], [c, d]) = (one.range(), other.range());
    0.0_f64.max(a.max(c)).min(b.min(d))
}

fn contains(condition: RateCondition, rate: f64) -> bool {
    let [least, greatest] = condition.range();
    least - SAME_RATE <= rate && rate <= greatest + SAME_RATE
}

fn held(leg: &LegProblem<'_>, condition: &WheelCondition, wheels: &DVector<f64>) -> bool {
    let off = match condition {
        WheelCondition::Free => return true,
        WheelCondition::Fixed(held) => wheels - held,
        WheelCondition::NullSpace(held) => leg.dynamics.null_component(wheels) - held,
    };
    let by_rate = SAME_RATE * leg.dynamics.inertia.amax();
    off.amax() <= SAME_MOMENTUM * wheels.amax() + by_rate
}
