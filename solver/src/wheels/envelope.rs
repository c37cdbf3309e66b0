//! Whether the wheels can hold the stored angular momentum where the body has a prescribed rate.
//!
//! At an attitude with body rate `w` the enabled wheels have to carry
//! `sum a_i I_i W_i = R^T H - J w - (locked wheels)`. More than three wheels can do so in many ways; a
//! linear program finds the one with the least load of the most loaded wheel.

mod rolls;
mod turn;

pub(crate) use turn::{OutsideEnvelope, outside_envelope};

use crate::model::attitude::Attitude;
use crate::model::problem::{Code, Problem};
use crate::model::roll::FreeRoll;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spacecraft::{Spacecraft, Wheel};
use crate::wheels::allocation;
use nalgebra::{DMatrix, DVector, Vector3};

/// Relative excess over the usable speed within the accuracy of the linear program.
const LOAD_TOLERANCE: f64 = 1e-6;
/// Weight of a wheel without a speed limit beside limited ones: so small that it takes most of the
/// demand.
const UNLIMITED_WEIGHT: f64 = 1e-6;

/// Wheel speeds that carry a momentum.
#[derive(Debug, Clone, PartialEq)]
pub struct MomentumHold {
    /// Speeds relative to the body, rad/s, one per wheel; locked wheels keep theirs.
    pub wheel_speed: Vec<f64>,
    /// Largest speed of an enabled wheel relative to its usable limit; above 1 the wheels cannot hold
    /// the momentum.
    pub load: f64,
}

impl MomentumHold {
    /// Whether every wheel stays within its usable speed.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.load <= 1.0 + LOAD_TOLERANCE
    }
}

/// The wheel speeds with the least largest load that carry a total momentum of the wheels.
///
/// `momentum` is what all wheels together must carry in body axes, N m s: at rest, the total
/// angular momentum. `authority` is the usable share of every speed limit, `locked_speed` holds the
/// speeds of disabled wheels, rad/s, one entry per wheel (those of enabled wheels are not read).
/// `None` when the linear program could not be solved for numerical reasons.
///
/// # Panics
///
/// When `locked_speed` is shorter than the list of wheels.
#[must_use]
pub fn hold_momentum(
    spacecraft: &Spacecraft,
    authority: f64,
    locked_speed: &[f64],
    momentum: Vector3<f64>,
) -> Option<MomentumHold> {
    let mut wheel_speed = vec![0.0; spacecraft.wheels().len()];
    let mut demand = momentum;
    for (i, wheel) in spacecraft
        .wheels()
        .iter()
        .enumerate()
        .filter(|(_, w)| !w.enabled)
    {
        wheel_speed[i] = locked_speed[i];
        demand -= wheel.axis * (wheel.inertia * locked_speed[i]);
    }
    let scale = demand.amax();
    if scale == 0.0 {
        return Some(MomentumHold {
            wheel_speed,
            load: 0.0,
        });
    }
    let enabled: Vec<_> = spacecraft.enabled_wheels().collect();
    let shares = least_loaded(&enabled, demand / scale)?;
    let mut load: f64 = 0.0;
    for ((i, wheel), share) in enabled.into_iter().zip(shares.iter()) {
        wheel_speed[i] = share * scale / wheel.inertia;
        load = load.max(wheel_speed[i].abs() / (wheel.max_speed * authority));
    }
    Some(MomentumHold { wheel_speed, load })
}

/// Momenta of the wheels about their axes that sum to `demand` with the least largest load.
fn least_loaded(wheels: &[(usize, &Wheel)], demand: Vector3<f64>) -> Option<DVector<f64>> {
    let axes = DMatrix::from_fn(3, wheels.len(), |row, column| wheels[column].1.axis[row]);
    // Speed limits are the same in both directions.
    let weights: Vec<_> = weights(wheels).into_iter().map(|w| [w, w]).collect();
    allocation::least_loaded(&axes, &weights, demand)
}

/// Inverse capacity of each wheel, the largest being 1; the authority scales all alike.
fn weights(wheels: &[(usize, &Wheel)]) -> Vec<f64> {
    let capacity = |wheel: &Wheel| wheel.inertia * wheel.max_speed;
    let least = wheels
        .iter()
        .map(|(_, w)| capacity(w))
        .fold(f64::INFINITY, f64::min);
    wheels
        .iter()
        .map(|(_, wheel)| match capacity(wheel) {
            _ if least.is_infinite() => 1.0,
            capacity if capacity.is_infinite() => UNLIMITED_WEIGHT,
            capacity => least / capacity,
        })
        .collect()
}

/// Problems of targets, and of the end, at which the wheels cannot hold the conserved momentum.
///
/// Only those with a fully prescribed rate are tested: with a free rate component the body can carry
/// momentum. Where the roll is free, a place is a problem if it is one at every admissible roll.
#[must_use]
pub fn momentum_problems(scenario: &Scenario) -> Vec<Problem> {
    let targets = scenario
        .targets()
        .iter()
        .enumerate()
        .filter_map(|(i, target)| {
            let rate = prescribed(&target.rate)?;
            let rest = Rest {
                attitude: &target.attitude,
                roll: target.roll.as_ref(),
                rate,
            };
            problem(scenario, &rest, &format!("/targets/{i}"))
        });
    // Wheel speeds given at the end are validated with the scenario.
    let end = scenario
        .end()
        .filter(|end| end.wheel_speed.is_none())
        .and_then(|end| {
            let rest = Rest {
                attitude: &end.attitude,
                roll: end.roll.as_ref(),
                rate: end.rate,
            };
            problem(scenario, &rest, "/end")
        });
    // The end comes before the targets in the document.
    end.into_iter().chain(targets).collect()
}

/// The rate, rad/s, if all its components are prescribed.
fn prescribed(rate: &[RateCondition; 3]) -> Option<Vector3<f64>> {
    let mut values = Vector3::zeros();
    for (value, condition) in values.iter_mut().zip(rate) {
        let RateCondition::Fixed(fixed) = condition else {
            return None;
        };
        *value = *fixed;
    }
    Some(values)
}

/// A place with a fully prescribed rate, rad/s.
struct Rest<'a> {
    attitude: &'a Attitude,
    roll: Option<&'a FreeRoll>,
    rate: Vector3<f64>,
}

impl Rest<'_> {
    /// What the wheels must carry there, N m s, and the speeds that do so; where the roll is free, at
    /// one that is held, if there is any.
    fn hold(&self, scenario: &Scenario) -> Option<(Vector3<f64>, MomentumHold)> {
        let spacecraft = scenario.spacecraft();
        let authority = scenario.options().momentum_authority;
        let (total, of_rate) = (scenario.momentum(), spacecraft.inertia() * self.rate);
        let hold = |attitude: &Attitude| {
            let demand = attitude.to_body(total) - of_rate;
            let speeds = &scenario.start().wheel_speed;
            let hold = hold_momentum(spacecraft, authority, speeds, demand)?;
            Some((demand, hold))
        };
        let Some(free) = self.roll else {
            return hold(self.attitude);
        };
        let turning = free.axis.cross(&self.attitude.to_body(total)).norm();
        let change = rolls::load_per_momentum(spacecraft, authority)? * turning;
        let rolled = |roll| hold(&free.rolled(self.attitude, roll));
        rolls::least_loaded(rolled, free.range, change)
    }
}

fn problem(scenario: &Scenario, rest: &Rest<'_>, pointer: &str) -> Option<Problem> {
    let (demand, hold) = rest.hold(scenario)?;
    if hold.fits() {
        return None;
    }
    let rolls = rest
        .roll
        .map_or("", |_| ", at the admissible roll of the least load,");
    Some(Problem::new(
        pointer,
        Code::MomentumExceedsEnvelope,
        format!(
            "the wheels must carry ({:.6e}, {:.6e}, {:.6e}) N m s in body axes there, which{rolls} \
             needs {:.4} times the usable speed of the most loaded wheel",
            demand.x, demand.y, demand.z, hold.load
        ),
        "unload momentum first, raise options.momentum_authority, or leave a rate component free",
    ))
}

#[cfg(test)]
mod tests;
