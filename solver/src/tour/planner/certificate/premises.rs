//! The premises of a certificate, compared with the scenario.
//!
//! A certificate says that no motion within some limits and with some end rates makes a turn in
//! less than a time. Whether the slews of the scenario are within these limits is checked here from
//! the scenario alone, by formulas other than those of [`crate::bounds::certified`]: largest
//! components from the corners of boxes, inertias by solving linear systems, turns as products of
//! matrices. What the checker tolerates has to be within them too.

use crate::bounds::kinematic::certificate::Certificate;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::tolerances::{ATTITUDE_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE};
use crate::tour::order::Place;
use nalgebra::{Matrix3, Vector3};

/// Tolerance for rounding of a limit, relative.
const ROUNDING: f64 = 1e-12;
/// Tolerance for the components of the matrices of two equal turns; attitudes are rounded to a
/// tenth of a picoradian.
const SAME_TURN: f64 = 1e-9;
/// Tolerance for the products of orthonormal axes.
const ORTHONORMAL: f64 = 1e-12;

/// Checks the premises of a certificate, expressed in axes that are the columns of a matrix, for
/// slews between two places without momentum.
///
/// # Errors
///
/// The first premise that the scenario does not support.
pub(super) fn check(
    scenario: &Scenario,
    places: [Place; 2],
    axes: &Matrix3<f64>,
    certificate: &Certificate,
) -> Result<(), &'static str> {
    if (axes.tr_mul(axes) - Matrix3::identity()).amax() > ORTHONORMAL || axes.determinant() < 0.0 {
        return Err("axes that are not orthonormal");
    }
    let [turn] = &certificate.turns[..] else {
        return Err("more or less than one turn");
    };
    let [(from, begin), (to, end)] = places.map(|place| conditions(scenario, place));
    let expected = axes.tr_mul(&(from.tr_mul(&to) * axes));
    if (expected - turn.turn.matrix()).amax() > SAME_TURN {
        return Err("another turn");
    }
    if certificate.attitude_tolerance_rad < ATTITUDE_TOLERANCE {
        return Err("attitudes that are met more exactly than they have to be");
    }
    let Some(reached) = reachable(scenario, axes) else {
        return Err("an inertia that cannot be inverted");
    };
    let [rates, accelerations] = reached.map(|most| most * (1.0 + LIMIT_TOLERANCE));
    let within = |needed: Vector3<f64>, granted: &Vector3<f64>| {
        (0..3).all(|axis| needed[axis] <= granted[axis] * (1.0 + ROUNDING))
    };
    if !within(rates, &certificate.limits.rates_rad_s) {
        return Err("a limit of the rates below what the wheels can do");
    }
    if !within(accelerations, &certificate.limits.accelerations_rad_s2) {
        return Err("a limit of the accelerations below what the wheels can do");
    }
    let largest = |ranges: &[(f64, f64); 3]| along_axes(axes, |axis| over_corners(axis, ranges));
    if !within(largest(&begin), &certificate.ends.begin_rad_s) {
        return Err("a rate at the beginning below what is admitted there");
    }
    if !within(largest(&end), &certificate.ends.end_rad_s) {
        return Err("a rate at the end below what is admitted there");
    }
    Ok(())
}

/// The body axes in the reference frame, as columns, and the ranges of the rate components at a
/// place, rad/s, with the tolerance.
fn conditions(scenario: &Scenario, place: Place) -> (Matrix3<f64>, [(f64, f64); 3]) {
    let (attitude, ranges) = exact_conditions(scenario, place);
    let tolerated = |(low, high)| (low - RATE_TOLERANCE, high + RATE_TOLERANCE);
    (attitude, ranges.map(tolerated))
}

/// The same without the tolerance.
fn exact_conditions(scenario: &Scenario, place: Place) -> (Matrix3<f64>, [(f64, f64); 3]) {
    let fixed = |rate: &Vector3<f64>| [0, 1, 2].map(|axis| (rate[axis], rate[axis]));
    match place {
        Place::Start => {
            let start = scenario.start();
            (start.attitude.matrix(), fixed(&start.rate))
        }
        Place::Target(index) => {
            let target = &scenario.targets()[index];
            let range = |condition: RateCondition| match condition {
                RateCondition::Fixed(rate) => (rate, rate),
                RateCondition::Within(low, high) => (low, high),
                RateCondition::Free => (f64::NEG_INFINITY, f64::INFINITY),
            };
            (target.attitude.matrix(), target.rate.map(range))
        }
        Place::End => {
            let end = scenario
                .end()
                .expect("only scenarios with an end have legs to it");
            (end.attitude.matrix(), fixed(&end.rate))
        }
    }
}

fn along_axes(axes: &Matrix3<f64>, largest: impl Fn(&Vector3<f64>) -> f64) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| largest(&axes.column(axis).into_owned()))
}

/// Largest absolute component along a direction of the vectors in a box, over its corners.
fn over_corners(direction: &Vector3<f64>, ranges: &[(f64, f64); 3]) -> f64 {
    let corners = (0..8_u8).map(|corner| {
        let parts = (0..3).map(|axis| {
            let (low, high) = ranges[axis];
            let component = if corner >> axis & 1 == 0 { low } else { high };
            // A component orthogonal to the direction does not contribute, even if it is infinite.
            if direction[axis] == 0.0 {
                0.0
            } else {
                direction[axis] * component
            }
        });
        parts.sum::<f64>().abs()
    });
    // The sum of two infinities of different sign is not a number; it counts as infinite.
    corners.fold(0.0, |largest, size| {
        if size.is_nan() {
            f64::INFINITY
        } else {
            size.max(largest)
        }
    })
}

/// Largest components along axes of the rates and accelerations that the wheels reach within their
/// limits without total momentum: `J w = -h_locked - sum a I W` and `J_eff w' = -sum a u`. `None`
/// when an inertia cannot be inverted.
fn reachable(scenario: &Scenario, axes: &Matrix3<f64>) -> Option<[Vector3<f64>; 2]> {
    let (spacecraft, options) = (scenario.spacecraft(), scenario.options());
    let speeds = &scenario.start().wheel_speed;
    let mut effective = *spacecraft.inertia();
    let mut locked = Vector3::zeros();
    for (wheel, speed) in spacecraft.wheels().iter().zip(speeds) {
        if wheel.enabled {
            effective -= wheel.axis * wheel.axis.transpose() * wheel.inertia;
        } else {
            locked += wheel.axis * (wheel.inertia * speed);
        }
    }
    // Both inertias are symmetric: d . J^-1 v = (J^-1 d) . v.
    let levers = spacecraft.inertia().lu().solve(axes)?;
    let pushes = effective.lu().solve(axes)?;
    let limits = spacecraft.max_rate().map(|limit| (-limit, limit));
    let limits = [limits.x, limits.y, limits.z];
    let rates = Vector3::from_fn(|axis, _| {
        let (lever, direction) = (levers.column(axis), axes.column(axis).into_owned());
        let mut reached = lever.dot(&locked).abs();
        for (_, wheel) in spacecraft.enabled_wheels() {
            let share = (lever.dot(&wheel.axis) * wheel.inertia).abs();
            if share > 0.0 {
                reached += share * wheel.max_speed * options.momentum_authority;
            }
        }
        let by_axis = over_corners(&direction, &limits);
        reached.min(by_axis).min(spacecraft.max_rate_norm())
    });
    let accelerations = Vector3::from_fn(|axis, _| {
        let push = pushes.column(axis);
        let ends = |sign: f64| -> f64 {
            let wheels = spacecraft.enabled_wheels();
            let largest = wheels.map(|(_, wheel)| {
                let share = sign * push.dot(&wheel.axis) * options.torque_authority;
                (share * wheel.max_torque).max(share * wheel.min_torque)
            });
            largest.sum()
        };
        ends(1.0).max(ends(-1.0))
    });
    Some([rates, accelerations])
}

#[cfg(test)]
mod tests;
