//! General slews: one turn from rest to rest by any angle about any axis, every one on a spacecraft of
//! its own with a full inertia matrix and 3 to 6 wheels on random axes. Seeds give the same slews every
//! time; those of another seed are others.

use crate::random::Generator;
use crate::wheel;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
};
use slewplan_solver::wheels::envelope::momentum_problems;
use std::f64::consts::PI;

/// Least turn, rad.
const MIN_TURN: f64 = 0.02;
/// Greatest wheel speeds at the start with stored momentum, as shares of the limit: of ordinary and of loaded
/// wheels.
const STORED: f64 = 0.25;
const LOADED: f64 = 0.9;

/// A slew. Of eight, two have limits of the body rate, one has momentum in its wheels and one both.
///
/// # Panics
///
/// When no wheel speeds are found that the wheels can hold at the target.
#[must_use]
pub fn slew(seed: u64, number: u64) -> ScenarioSpec {
    let kind = match number % 8 {
        4 | 5 => (true, 0.0),
        6 => (false, STORED),
        7 => (true, STORED),
        _ => (false, 0.0),
    };
    held("general", seed, number, kind)
}

/// A slew with so much momentum that some wheels begin near their limits. Every second one has limits of the
/// body rate.
///
/// # Panics
///
/// As [`slew`].
#[must_use]
pub fn loaded_slew(seed: u64, number: u64) -> ScenarioSpec {
    held("loaded", seed, number, (number % 2 == 1, LOADED))
}

/// One of the slews, with limits of the body rate or without and so much of the wheels' speeds stored, whose
/// momentum the wheels can hold at the target.
fn held(suite: &str, seed: u64, number: u64, kind: (bool, f64)) -> ScenarioSpec {
    let mut generator = Generator::new((seed << 32) + number);
    for _ in 0..1000 {
        let spec = attempt(&mut generator, kind);
        let scenario = Scenario::try_new(&spec).expect("a valid scenario").scenario;
        if momentum_problems(&scenario).is_empty() {
            return ScenarioSpec {
                name: Some(format!("{suite} {seed}, slew {number}")),
                ..spec
            };
        }
    }
    panic!("slew {number} of seed {seed} cannot hold its momentum");
}

fn attempt(generator: &mut Generator, (limited, stored): (bool, f64)) -> ScenarioSpec {
    let size = generator.logarithmic(1.0, 1000.0);
    let acceleration = generator.logarithmic(1e-3, 3e-2);
    let rate = generator.logarithmic(0.01, 0.1);
    let count = 3 + generator.below(4);
    let wheels = generator.wheel_array(count, count, |generator| {
        let speed = generator.between(300.0, 700.0);
        let inertia = size * rate * generator.between(0.7, 1.4) / speed;
        let torque = size * acceleration * generator.between(0.6, 1.5);
        wheel(generator.direction(), inertia, torque, speed)
    });
    let speeds = wheels.iter().map(|wheel| {
        let limit = wheel.max_speed_rad_s.expect("every wheel has one");
        generator.between(-stored, stored) * limit
    });
    let speeds = speeds.collect();
    let turn = generator.direction();
    let angle = generator.between(MIN_TURN, PI);
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: generator.inertia(0.6 * size, 1.2 * size, true),
            max_body_rate_rad_s: [(); 3].map(|()| {
                let limit = rate * generator.between(0.4, 1.0);
                limited.then_some(limit)
            }),
            wheels,
            ..SpacecraftSpec::default()
        },
        start: StateSpec {
            wheel_speed_rad_s: (stored > 0.0).then_some(speeds),
            ..StateSpec::default()
        },
        targets: vec![TargetSpec {
            id: "target".to_owned(),
            attitude: AttitudeSpec::Quaternion(
                Attitude::from_rotation_vector(turn.map(|c| c * angle).into()).xyzw(),
            ),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    }
}
