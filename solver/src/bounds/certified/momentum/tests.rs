//! Reachable motions stay within the boxes, and bounds are confirmed by their second proof.

use super::*;
use crate::bounds::certified::CertifiedBounds;
use crate::bounds::certify::verify_drift;
use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use crate::model::random::{between, direction, spacecraft};
use crate::model::scenario::reference::experiment_a;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::tolerances::RATE_TOLERANCE;
use crate::model::waypoint::{Waypoint, WheelCondition};

/// Tolerance for rounding of a box, relative.
const ROUNDING: f64 = 1e-12;

/// Rate, its derivative and the momentum of a random state and torques within the limits, all in
/// body axes; `None` if the rate exceeds its limits. Speeds and torques are mostly at their limits.
fn motion(dynamics: &Dynamics, random: &mut SplitMix) -> Option<[Vector3<f64>; 3]> {
    let extreme = |random: &mut SplitMix, low: f64, high: f64| match random.below(3) {
        0 => low,
        1 => high,
        _ => between(random, low, high),
    };
    let attitude = Attitude::from_rotation_vector(direction(random) * between(random, 0.0, 3.1));
    let held = attitude.to_body(dynamics.momentum);
    let mut spin = Vector3::zeros();
    let mut torque = Vector3::zeros();
    for wheel in &dynamics.actuators {
        let speed = extreme(random, -wheel.max_speed, wheel.max_speed);
        spin += wheel.axis * (wheel.inertia * speed);
        torque += wheel.axis * extreme(random, wheel.min_torque, wheel.max_torque);
    }
    // The inertia with locked wheels, from that without their spin.
    let locked = dynamics
        .actuators
        .iter()
        .fold(dynamics.inertia, |sum, wheel| {
            sum + wheel.axis * wheel.axis.transpose() * wheel.inertia
        });
    let rate = locked.try_inverse()? * (held - dynamics.locked_momentum - spin);
    let allowed = rate
        .iter()
        .zip(&dynamics.max_rate)
        .all(|(w, limit)| w.abs() <= *limit)
        && rate.norm() <= dynamics.max_rate_norm;
    let change = dynamics.inertia_inverse * (-rate.cross(&held) - torque);
    allowed.then_some([rate, change, held])
}

/// Largest ratio of a vector's component to the box's limit.
fn share(vector: &Vector3<f64>, limits: &Vector3<f64>) -> f64 {
    vector.component_div(limits).amax()
}

#[test]
fn no_motion_leaves_a_box_and_some_motions_nearly_fill_it() {
    let mut random = SplitMix::new(20);
    // For the boxes of all rates, and for those relative to a drift.
    let (mut fullest, mut samples) = ([[0.0_f64; 2]; 2], 0);
    for case in 0..60 {
        let scenario = spacecraft(&mut random, case % 3 > 0);
        let dynamics = scenario.dynamics();
        let bounds = CertifiedBounds::of(&dynamics);
        let drifting = bounds.momentum.iter().flat_map(|bounds| &bounds.frames);
        let mut boxes: Vec<(BodyFrame, f64)> = drifting
            .map(|drifting| (drifting.frame, drifting.share))
            .chain(bounds.frames.iter().map(|frame| (*frame, 0.0)))
            .collect();
        if let Some(bounds) = &bounds.momentum {
            for key in bounds.facets.frames(&direction(&mut random)) {
                let fitted = bounds.fitted(key);
                let across = fitted.iter().flatten();
                boxes.extend(across.map(|drifting| (drifting.frame, drifting.share)));
            }
        }
        assert!(!boxes.is_empty(), "case {case}");
        for _ in 0..3000 {
            let Some([rate, change, held]) = motion(&dynamics, &mut random) else {
                continue;
            };
            samples += 1;
            for (frame, share_of_held) in &boxes {
                // Relative to axes that turn with the drift: (R^T H)' = -w x R^T H.
                let relative = rate - held * *share_of_held;
                let relative_change = change + rate.cross(&held) * *share_of_held;
                let seen = |vector: Vector3<f64>| frame.axes.tr_mul(&vector);
                let shares = [
                    share(&seen(relative), &frame.limits.rates_rad_s),
                    share(&seen(relative_change), &frame.limits.accelerations_rad_s2),
                ];
                let kind = usize::from(*share_of_held > 0.0);
                for (fullest, share) in fullest[kind].iter_mut().zip(shares) {
                    assert!(share <= 1.0 + ROUNDING, "case {case}: {shares:?}");
                    *fullest = fullest.max(share);
                }
            }
        }
    }
    assert!(samples > 50_000, "{samples}");
    let loose = fullest.iter().flatten().any(|share| *share < 0.98);
    assert!(!loose, "{fullest:?}");
}

/// The largest share of the limit that the rate along a direction, relative to a drift, reaches when it grows
/// from rest, with torques that accelerate it most.
fn growth_from_rest(dynamics: &Dynamics, share: f64, random: &mut SplitMix) -> f64 {
    let along = direction(random);
    let lever = dynamics.inertia_inverse.tr_mul(&along);
    let mut torque = Vector3::zeros();
    for wheel in &dynamics.actuators {
        let faster = lever.dot(&wheel.axis) < 0.0;
        torque += wheel.axis
            * if faster {
                wheel.max_torque
            } else {
                wheel.min_torque
            };
    }
    let limit = dynamics.reachable_relative_rate(&along, share);
    let slope = RateGrowth::of(dynamics).slope(
        dynamics.reachable_acceleration(&along),
        dynamics.gyroscopic_acceleration(&along, share),
        limit,
    );
    let attitude = Attitude::from_rotation_vector(direction(random) * between(random, 0.0, 3.1));
    let (mut held, mut rate) = (attitude.to_body(dynamics.momentum), Vector3::zeros());
    let first = -along.dot(&held) * share;
    let step = limit / slope / 400.0;
    let change = |rate: &Vector3<f64>, held: &Vector3<f64>| {
        let acceleration = dynamics.inertia_inverse * (-rate.cross(held) - torque);
        [acceleration, -rate.cross(held)]
    };
    let largest = dynamics.reachable_rates().inf(&dynamics.max_rate);
    let mut most = 0.0_f64;
    for n in 1..=400_u32 {
        // The midpoint rule.
        let [a, h] = change(&rate, &held);
        let [a, h] = change(&(rate + a * (0.5 * step)), &(held + h * (0.5 * step)));
        (rate, held) = (rate + a * step, held + h * step);
        let outside = rate.abs().component_div(&largest).max() > 1.0;
        if outside || rate.norm() > dynamics.max_rate_norm {
            break;
        }
        let grown = along.dot(&(rate - held * share)) - first;
        most = most.max(grown / (slope * step * f64::from(n)));
    }
    most
}

#[test]
fn no_rate_grows_faster_from_rest_than_its_chord_and_some_nearly_as_fast() {
    let mut random = SplitMix::new(24);
    let (mut fastest, mut gentler, mut count) = (0.0_f64, 0, 0);
    for case in 0..400 {
        let scenario = spacecraft(&mut random, true);
        let dynamics = scenario.dynamics();
        for share in [0.0, dynamics.mean_inverse_inertia()] {
            let most = growth_from_rest(&dynamics, share, &mut random);
            assert!(most <= 1.0 + 1e-5, "case {case}: {most}");
            fastest = fastest.max(most);
            let axis = direction(&mut random);
            let [torques, held] = [
                dynamics.reachable_acceleration(&axis),
                dynamics.gyroscopic_acceleration(&axis, share),
            ];
            let slope = RateGrowth::of(&dynamics).slope(torques, held, 0.01);
            assert!(slope >= torques, "case {case}");
            gentler += i32::from(slope < 0.7 * (torques + held));
            count += 1;
        }
    }
    assert!(fastest > 0.9, "{fastest}");
    assert!(gentler > count / 4, "{gentler} of {count}");
}

#[test]
fn body_axes_and_wheel_axes_are_both_used_where_they_differ() {
    let frames = |scenario: &Scenario| CertifiedBounds::of(&scenario.dynamics()).frames.len();
    let orthogonal = Scenario::try_new(&experiment_a()).expect("valid").scenario;
    assert_eq!(frames(&orthogonal), 1);
    let mut random = SplitMix::new(23);
    let all = (0..20).map(|_| spacecraft(&mut random, false));
    // A locked wheel may spin and have momentum.
    let still = all.filter(|scenario| !scenario.dynamics().has_momentum());
    let counts: Vec<_> = still.map(|scenario| frames(&scenario)).collect();
    assert!(
        counts.len() > 5 && counts.iter().all(|frames| *frames == 2),
        "{counts:?}"
    );
}

#[test]
fn the_limit_of_an_end_rate_is_valid_and_tight() {
    let mut random = SplitMix::new(21);
    for _ in 0..500 {
        let ends = [0, 1, 2].map(|_| match random.below(3) {
            0 => (RateCondition::Free, random.normal()),
            1 => {
                let rate = random.normal();
                (RateCondition::Fixed(rate), rate)
            }
            _ => {
                let (one, other) = (random.normal(), random.normal());
                let (low, high) = (one.min(other), one.max(other));
                // The ends of the range are tested as often as its inside.
                let rate = [low, high, between(&mut random, low, high)][random.below(3)];
                (RateCondition::Within(low, high), rate)
            }
        });
        let waypoint = Waypoint {
            attitude: Attitude::identity(),
            roll: None,
            rate: ends.map(|(condition, _)| condition),
            wheels: WheelCondition::Free,
            costates: None,
        };
        let limits = crate::bounds::certified::rate_limits(&waypoint);
        for (axis, (condition, rate)) in ends.iter().enumerate() {
            let most = rate.abs() + RATE_TOLERANCE;
            let admitted = *condition == RateCondition::Free || most <= limits[axis];
            assert!(admitted, "{condition:?} admits {most}");
            let tight = match condition {
                RateCondition::Within(low, high) => low.abs().max(high.abs()),
                RateCondition::Fixed(rate) => rate.abs(),
                RateCondition::Free => f64::INFINITY,
            };
            let tolerated = tight + 2.0 * RATE_TOLERANCE;
            assert!(limits[axis] <= tolerated, "{condition:?}: {}", limits[axis]);
        }
    }
}

/// A slew of a random spacecraft with momentum.
fn slew(random: &mut SplitMix, dynamics: &Dynamics) -> HeldSlew {
    let begin = Attitude::from_rotation_vector(direction(random) * between(random, 0.0, 3.1));
    let angle = 10.0_f64.powf(between(random, -2.0, 0.49));
    let turn = Attitude::from_rotation_vector(direction(random) * angle);
    let end = begin.then_in_body(&turn);
    let rest = Vector3::repeat(MISSED_RATE);
    HeldSlew {
        turn,
        held: [begin, end].map(|attitude| attitude.to_body(dynamics.momentum)),
        ends: [
            rest,
            if random.below(2) == 0 {
                rest
            } else {
                Vector3::repeat(f64::INFINITY)
            },
        ],
    }
}

#[test]
fn certificates_are_confirmed_and_damaged_ones_are_not() {
    let mut random = SplitMix::new(25);
    let (mut confirmed, mut several) = (0, 0);
    for case in 0..60 {
        let scenario = spacecraft(&mut random, case % 2 > 0);
        let dynamics = scenario.dynamics();
        let bounds = CertifiedBounds::of(&dynamics);
        let Some(bounds) = &bounds.momentum else {
            continue;
        };
        let slew = slew(&mut random, &dynamics);
        let good = bounds.leg(&slew, 1e-4).expect("limits of speed");
        assert_eq!(verify_drift(&good), Ok(()), "case {case}: {good:?}");
        confirmed += 1;
        several += usize::from(good.steps.len() > 2);
        let damages: [fn(&mut DriftCertificate); 7] = [
            |bad| bad.duration_s *= 1.00001,
            |bad| _ = bad.steps.pop(),
            |bad| bad.steps[0].from_s = 1e-9,
            |bad| {
                for step in &mut bad.steps {
                    step.to_s *= 1.001;
                }
                bad.duration_s *= 1.001;
            },
            |bad| bad.steps[0].left.least_s *= 1.001,
            |bad| {
                let limits = &mut bad.steps[0].limits;
                limits.rates_rad_s *= 1.01;
                limits.accelerations_rad_s2 *= 1.01;
            },
            |bad| bad.steps[0].drifts_rad_s[0].x = f64::NAN,
        ];
        for (number, damage) in damages.iter().enumerate() {
            let mut bad = good.clone();
            damage(&mut bad);
            assert!(
                verify_drift(&bad).is_err(),
                "case {case}, damage {number}: {good:?}"
            );
        }
    }
    assert!(confirmed > 30 && several > 10, "{confirmed} {several}");
}
