//! Ordinary spacecraft: rate limits for operations and momentum in the wheels.
//!
//! Bodies of 0.03 to 3000 kg m² with 3 to 8 wheels: orthogonal ones, pyramids and random arrays, wheels
//! of one size or of several, torque limits that differ by sign, a locked wheel; rate limits per axis and
//! on the norm at 5 to 100 % of the rates that the wheels can reach; stored momentum of up to 80 % of the
//! momentum that the wheels hold in every direction.

use crate::random::Generator;
use crate::wheel;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::spec::{
    AttitudeEquivalence, AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
    WheelSpec,
};
use std::cell::Cell;

/// Greatest momentum of the scenarios, as a share of that which the wheels hold in every direction.
const MAX_STORED: f64 = 0.8;
/// Greatest wheel speed at the start, as a share of the limit.
const MAX_SPEED: f64 = 0.98;

/// Sum of the body's momenta at a small rate about each of the three axes, as a share of the momentum that
/// the wheels hold in every direction.
const SMALL_RATE: f64 = 0.1;

/// Greatest momentum of a locked wheel, as a share of the same.
const LOCKED: f64 = 0.05;

/// A scenario of an ordinary spacecraft with a number of targets; `spread` is the greatest ratio of the
/// largest to the smallest wheel.
#[must_use]
pub fn scenario(seed: u64, targets: usize, spread: f64) -> ScenarioSpec {
    let mut generator = Generator::new(seed);
    loop {
        if let Some(spec) = attempt(&mut generator, targets, spread) {
            return ScenarioSpec {
                name: Some(format!("ordinary {seed}, {targets} targets")),
                ..spec
            };
        }
    }
}

/// The same with conditions of every kind: dwells, settling, small fixed rates and bounded ones at
/// targets, a rate at the start, an end with or without one, a given position, signs that count, and
/// a locked wheel that turns.
#[must_use]
pub fn conditioned(seed: u64, targets: usize, spread: f64) -> ScenarioSpec {
    let mut spec = scenario(seed, targets, spread);
    let mut generator = Generator::new(!seed);
    let enabled = spec.spacecraft.wheels.iter().filter(|wheel| wheel.enabled);
    let sphere = held_everywhere(&enabled.collect::<Vec<_>>());
    let inertia = spec.spacecraft.inertia_kg_m2;
    let small = SMALL_RATE * sphere / (inertia[0][0] + inertia[1][1] + inertia[2][2]);
    for target in &mut spec.targets {
        (target.zero_rate_axes, target.rate_min_rad_s) = (None, None);
        target.rate_max_rad_s = None;
        match generator.below(5) {
            0 => target.dwell_s = generator.between(1.0, 60.0),
            1 => target.settle_s = generator.between(1.0, 20.0),
            2 => {
                let rate = generator.vector(-small, small).map(Some);
                (target.rate_min_rad_s, target.rate_max_rad_s) = (Some(rate), Some(rate));
            }
            3 => target.zero_rate_axes = Some([true, false, true]),
            _ => {
                target.rate_min_rad_s = Some([Some(-small); 3]);
                target.rate_max_rad_s = Some([Some(small), Some(0.0), Some(2.0 * small)]);
            }
        }
    }
    if generator.coin() {
        let max_speed = generator.between(200.0, 800.0);
        let inertia = LOCKED * sphere / max_speed;
        spec.spacecraft.wheels.push(WheelSpec {
            enabled: false,
            ..wheel(generator.direction(), inertia, 1e-3, max_speed)
        });
        let locked = generator.between(-max_speed, max_speed);
        let speeds = spec.start.wheel_speed_rad_s.get_or_insert_default();
        speeds.push(locked);
    }
    if generator.coin() {
        spec.start.body_rate_rad_s = Some(generator.vector(-small, small));
    }
    if generator.coin() {
        spec.end = Some(StateSpec {
            attitude: AttitudeSpec::Quaternion(generator.quaternion()),
            body_rate_rad_s: generator.coin().then(|| generator.vector(-small, small)),
            ..StateSpec::default()
        });
    }
    if generator.below(4) == 0 {
        spec.targets[0].position = Some(targets);
    }
    if generator.below(3) == 0 {
        spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    }
    ScenarioSpec {
        name: Some(format!("conditioned {seed}, {targets} targets")),
        ..spec
    }
}

fn attempt(generator: &mut Generator, targets: usize, spread: f64) -> Option<ScenarioSpec> {
    let size = generator.logarithmic(0.03, 3000.0);
    let rate = generator.logarithmic(1e-3, 0.1);
    let acceleration = rate / generator.logarithmic(2.0, 100.0);
    let mut wheels = array(generator, (size, rate, acceleration), spread);
    if wheels.len() > 4 && generator.below(4) == 0 {
        wheels[0].enabled = false;
    }
    let enabled: Vec<_> = wheels.iter().filter(|wheel| wheel.enabled).collect();
    let sphere = held_everywhere(&enabled);
    let stored = generator.between(0.0, MAX_STORED) * sphere;
    let demand = generator.direction().map(|c| c * stored);
    let momenta = shared(&enabled, demand)?;
    let mut next = enabled.iter().zip(&momenta);
    if next.any(|(wheel, momentum)| momentum.abs() > MAX_SPEED * capacity(wheel)) {
        return None;
    }
    let mut momenta = momenta.into_iter();
    let speeds = wheels.iter().map(|wheel| {
        let momentum = if wheel.enabled { momenta.next() } else { None };
        momentum.unwrap_or(0.0) / wheel.inertia_kg_m2
    });
    let start = StateSpec {
        wheel_speed_rad_s: Some(speeds.collect()),
        ..StateSpec::default()
    };
    let limit = sphere / size * generator.logarithmic(0.05, 1.0);
    let kind = generator.below(4);
    let spacecraft = SpacecraftSpec {
        inertia_kg_m2: generator.inertia(0.7 * size, 1.3 * size, true),
        max_body_rate_rad_s: match kind {
            1 => [Some(limit); 3],
            2 => [Some(limit), None, Some(limit * generator.between(0.5, 2.0))],
            _ => [None; 3],
        },
        max_body_rate_norm_rad_s: (kind == 3).then_some(limit),
        wheels,
        ..SpacecraftSpec::default()
    };
    let targets = (0..targets).map(|i| target(generator, i, limit));
    Some(ScenarioSpec {
        targets: targets.collect(),
        spacecraft,
        start,
        ..ScenarioSpec::default()
    })
}

/// A target at rest, or with rates free about two axes or bounded.
fn target(generator: &mut Generator, index: usize, limit: f64) -> TargetSpec {
    let angle = generator.between(0.05, 3.1);
    let turn = generator.direction().map(|c| c * angle);
    let kind = generator.below(6);
    let bound = 0.1 * limit;
    TargetSpec {
        id: format!("t{index}"),
        attitude: AttitudeSpec::Quaternion(Attitude::from_rotation_vector(turn.into()).xyzw()),
        zero_rate_axes: (kind == 0).then_some([false, false, true]),
        rate_min_rad_s: (kind == 1).then_some([Some(0.0), Some(-bound), None]),
        rate_max_rad_s: (kind == 1).then_some([Some(0.0), Some(bound), None]),
        ..TargetSpec::default()
    }
}

/// Wheels for a body of a size, kg m², a top rate, rad/s, and an acceleration, rad/s².
fn array(
    generator: &mut Generator,
    (size, rate, acceleration): (f64, f64, f64),
    spread: f64,
) -> Vec<WheelSpec> {
    let count = 3 + generator.below(6);
    let kind = generator.below(3);
    let rise = generator.between(0.3, 1.1);
    let next = Cell::new(0);
    generator.wheel_array(count, count, |generator| {
        let index = next.get();
        next.set((index + 1) % count);
        let turn = std::f64::consts::TAU * index as f64 / count as f64;
        let axis = match kind {
            0 if index < 3 => [0, 1, 2].map(|i| f64::from(u8::from(i == index))),
            1 => [rise.cos() * turn.cos(), rise.cos() * turn.sin(), rise.sin()],
            _ => generator.direction(),
        };
        let factor = generator.logarithmic(spread.sqrt().recip(), spread.sqrt());
        let speed = generator.between(200.0, 800.0);
        let torque = size * acceleration * factor * generator.between(0.7, 1.4);
        let least = torque * generator.between(0.4, 1.0);
        WheelSpec {
            min_torque_nm: (generator.below(5) == 0).then_some(-least),
            ..wheel(axis, size * rate * factor / speed, torque, speed)
        }
    })
}

fn capacity(wheel: &WheelSpec) -> f64 {
    wheel.inertia_kg_m2 * wheel.max_speed_rad_s.expect("every wheel has a limit")
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Momentum, N m s, that wheels hold in every direction: the least width of their zonotope, whose
/// faces lie across pairs of axes.
#[must_use]
pub fn held_everywhere(wheels: &[&WheelSpec]) -> f64 {
    let mut least = f64::INFINITY;
    for one in wheels {
        for other in wheels {
            let across = cross(one.axis, other.axis);
            let length = dot(across, across).sqrt();
            if length > 1e-6 {
                let held = wheels
                    .iter()
                    .map(|wheel| dot(across, wheel.axis).abs() * capacity(wheel));
                least = least.min(held.sum::<f64>() / length);
            }
        }
    }
    least
}

/// Momenta with the least weighted sum of squares that add up to a demand, N m s, with weights by the
/// capacity of each wheel: `h = W A^T (A W A^T)^-1 d`.
fn shared(wheels: &[&WheelSpec], demand: [f64; 3]) -> Option<Vec<f64>> {
    let mut gram = nalgebra::Matrix3::zeros();
    for wheel in wheels {
        let axis = nalgebra::Vector3::from(wheel.axis);
        gram += axis * axis.transpose() * capacity(wheel).powi(2);
    }
    let lever = gram.try_inverse()? * nalgebra::Vector3::from(demand);
    let share = |wheel: &&WheelSpec| capacity(wheel).powi(2) * dot(wheel.axis, lever.into());
    Some(wheels.iter().map(share).collect())
}
