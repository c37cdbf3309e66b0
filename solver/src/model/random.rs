//! Random spacecraft for unit tests.

use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use crate::model::spec::{ScenarioSpec, SpacecraftSpec, StateSpec, WheelSpec};
use nalgebra::{Matrix3, Vector3};

/// A number between two.
pub(crate) fn between(random: &mut SplitMix, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.draw() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A direction.
pub(crate) fn direction(random: &mut SplitMix) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.normal()).normalize()
}

/// A spacecraft with three to six wheels on any axes, of which one may be locked while spinning;
/// torque limits that depend on the sign, limits of every kind, momentum or none.
pub(crate) fn spacecraft(random: &mut SplitMix, momentum: bool) -> Scenario {
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
