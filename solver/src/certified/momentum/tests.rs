//! Nothing that the wheels can do leaves the boxes.

use super::*;
use crate::attitude::Attitude;
use crate::certified::CertifiedBounds;
use crate::random::SplitMix;
use crate::scenario::{RateCondition, Scenario};
use crate::spec::{ScenarioSpec, SpacecraftSpec, StateSpec, WheelSpec};
use crate::transcription::{Waypoint, WheelCondition};

/// Excess over a box that is rounding, relative.
const ROUNDING: f64 = 1e-12;

/// A number between two.
fn between(random: &mut SplitMix, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.draw() >> 11) as f64 / (1_u64 << 53) as f64
}

fn direction(random: &mut SplitMix) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.normal()).normalize()
}

/// A spacecraft with three to six wheels on any axes, of which one may be locked and turn; torques
/// that differ by their sign, limits of every kind, momentum or none.
fn spacecraft(random: &mut SplitMix, momentum: bool) -> Scenario {
    for _ in 0..1000 {
        let count = 3 + random.below(4);
        let wheel = |random: &mut SplitMix| WheelSpec {
            axis: direction(random).into(),
            normalize_axis: true,
            inertia_kg_m2: between(random, 1e-3, 4e-3),
            max_torque_nm: between(random, 0.01, 0.03),
            min_torque_nm: Some(-between(random, 0.003, 0.03)),
            max_speed_rad_s: Some(between(random, 200.0, 500.0)),
            enabled: true,
        };
        let mut wheels: Vec<_> = (0..count).map(|_| wheel(random)).collect();
        let mut speeds = vec![0.0; count];
        if count > 3 && random.below(2) == 0 {
            wheels[0].enabled = false;
            speeds[0] = between(random, -400.0, 400.0);
        }
        if momentum {
            for (speed, wheel) in speeds.iter_mut().zip(&wheels) {
                let limit = wheel.max_speed_rad_s.unwrap_or(0.0);
                if wheel.enabled {
                    *speed = between(random, -limit, limit);
                }
            }
        }
        let turn = Attitude::from_rotation_vector(direction(random) * between(random, 0.0, 3.0));
        let axes = turn.matrix();
        let moments = Vector3::from_fn(|_, _| between(random, 1.0, 1.9));
        let inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
        let limit = between(random, 0.05, 0.8);
        let spec = ScenarioSpec {
            spacecraft: SpacecraftSpec {
                inertia_kg_m2: (0.5 * (inertia + inertia.transpose())).into(),
                max_body_rate_rad_s: if random.below(2) == 0 {
                    [Some(limit), None, Some(0.5 * limit)]
                } else {
                    [None; 3]
                },
                max_body_rate_norm_rad_s: (random.below(3) == 0).then_some(limit),
                wheels,
                ..SpacecraftSpec::default()
            },
            end: Some(StateSpec::default()),
            start: StateSpec {
                wheel_speed_rad_s: Some(speeds),
                ..StateSpec::default()
            },
            ..ScenarioSpec::default()
        };
        if let Ok(valid) = Scenario::try_new(&spec) {
            return valid.scenario;
        }
    }
    panic!("no spacecraft is valid");
}

/// A state that the limits admit, with the torques: rate, its derivative and the momentum, all in body
/// axes. Wheels and torques are at their limits more often than not.
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
        .all(|(w, most)| w.abs() <= *most)
        && rate.norm() <= dynamics.max_rate_norm;
    let change = dynamics.inertia_inverse * (-rate.cross(&held) - torque);
    allowed.then_some([rate, change, held])
}

/// Shares of the box's sides that a vector has at most.
fn share(vector: &Vector3<f64>, most: &Vector3<f64>) -> f64 {
    vector.component_div(most).amax()
}

#[test]
fn no_motion_leaves_a_box_and_the_boxes_are_not_idle() {
    let mut random = SplitMix::new(20);
    let (mut fullest, mut samples) = ([0.0_f64; 2], 0);
    for case in 0..60 {
        let scenario = spacecraft(&mut random, case % 3 > 0);
        let dynamics = Dynamics::of(&scenario);
        let bounds = CertifiedBounds::of(&dynamics);
        let drifting = bounds.momentum.iter().flat_map(|bounds| &bounds.frames);
        let boxes: Vec<(Frame, f64)> = drifting
            .map(|drifting| (drifting.frame, drifting.share))
            .chain(bounds.frames.iter().map(|frame| (*frame, 0.0)))
            .collect();
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
                for (fullest, share) in fullest.iter_mut().zip(shares) {
                    assert!(share <= 1.0 + ROUNDING, "case {case}: {shares:?}");
                    *fullest = fullest.max(share);
                }
            }
        }
    }
    assert!(samples > 50_000, "{samples}");
    assert!(fullest.iter().all(|share| *share > 0.99), "{fullest:?}");
}

#[test]
fn conditions_at_an_end_admit_no_rate_beyond_their_bound() {
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
                // The ends of the range are what is most often forgotten.
                let rate = [low, high, between(&mut random, low, high)][random.below(3)];
                (RateCondition::Within(low, high), rate)
            }
        });
        let waypoint = Waypoint {
            attitude: Attitude::identity(),
            rate: ends.map(|(condition, _)| condition),
            wheels: WheelCondition::Free,
            price: None,
        };
        let most = crate::certified::most(&waypoint);
        for (axis, (condition, rate)) in ends.iter().enumerate() {
            assert!(rate.abs() <= most[axis], "{condition:?} admits {rate}");
            let tight = match condition {
                RateCondition::Within(low, high) => low.abs().max(high.abs()),
                RateCondition::Fixed(rate) => rate.abs(),
                RateCondition::Free => f64::INFINITY,
            };
            assert!(most[axis] <= tight, "{condition:?}: {}", most[axis]);
        }
    }
}
