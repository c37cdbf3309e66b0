//! The random suite of legs: from a state at rest to one target at rest, on random spacecraft. Seeds give
//! the same legs every time.

use crate::random::Generator;
use crate::wheel;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
};
use slewplan_solver::wheels::envelope::momentum_problems;

/// Spacecraft of the suite.
pub const SPACECRAFT: u64 = 20;
/// Legs of each spacecraft.
pub const LEGS_PER_SPACECRAFT: u64 = 15;
/// Smallest turn of a leg, rad.
const MIN_TURN: f64 = 1e-4;

/// A leg of the suite, named after its seeds.
///
/// The number of the spacecraft determines its properties: 3 to 6 wheels; stored momentum or none; rate
/// limits or none.
///
/// # Panics
///
/// When no wheel speeds are found that the wheels can hold at the target.
#[must_use]
pub fn leg(spacecraft: u64, leg: u64) -> ScenarioSpec {
    let craft = craft(spacecraft);
    let mut generator = Generator::new(1000 + spacecraft * 1000 + leg);
    let share = match spacecraft / 4 {
        0 | 2 => 0.0,
        4 => 0.05,
        _ => 0.25,
    };
    for _ in 0..1000 {
        let from = Attitude::from_xyzw(generator.quaternion()).expect("unit length");
        let angle = generator.logarithmic(MIN_TURN, std::f64::consts::PI);
        let turn = generator.direction().map(|c| c * angle);
        let to = from.then_in_body(&Attitude::from_rotation_vector(turn.into()));
        let speeds = craft.wheels.iter().map(|wheel| {
            let limit = wheel
                .max_speed_rad_s
                .expect("every wheel of the suite has one");
            generator.between(-share, share) * limit
        });
        let spec = ScenarioSpec {
            name: Some(format!("spacecraft {spacecraft}, leg {leg}")),
            start: StateSpec {
                attitude: AttitudeSpec::Quaternion(from.xyzw()),
                wheel_speed_rad_s: Some(speeds.collect()),
                ..StateSpec::default()
            },
            targets: vec![TargetSpec {
                id: "target".to_owned(),
                attitude: AttitudeSpec::Quaternion(to.xyzw()),
                ..TargetSpec::default()
            }],
            spacecraft: craft.clone(),
            ..ScenarioSpec::default()
        };
        let scenario = Scenario::try_new(&spec).expect("a valid scenario").scenario;
        if momentum_problems(&scenario).is_empty() {
            return spec;
        }
    }
    panic!("spacecraft {spacecraft} cannot hold its momentum");
}

/// A spacecraft whose wheels are sized for its inertia: accelerations of 1e-3 to 3e-2 rad/s², top
/// rates of 0.01 to 0.1 rad/s.
fn craft(number: u64) -> SpacecraftSpec {
    let mut generator = Generator::new(number);
    let size = generator.logarithmic(1.0, 1000.0);
    let full = !number.is_multiple_of(3);
    let inertia_kg_m2 = generator.inertia(0.7 * size, 1.2 * size, full);
    let acceleration = generator.logarithmic(1e-3, 3e-2);
    let rate = generator.logarithmic(0.01, 0.1);
    let count = 3 + usize::try_from(number % 4).expect("small");
    let wheels = generator.wheel_array(count, count, |generator| {
        let speed = generator.between(300.0, 700.0);
        let inertia = size * rate * generator.between(0.7, 1.4) / speed;
        let torque = size * acceleration * generator.between(0.6, 1.5);
        wheel(generator.direction(), inertia, torque, speed)
    });
    let limited = matches!(number / 4, 2..=4);
    SpacecraftSpec {
        inertia_kg_m2,
        max_body_rate_rad_s: [(); 3].map(|()| {
            let limit = rate * generator.between(0.4, 1.0);
            (limited && generator.coin()).then_some(limit)
        }),
        wheels,
        ..SpacecraftSpec::default()
    }
}
