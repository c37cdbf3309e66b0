//! Shared set-up of the tests: reference scenarios and builders.
//!
//! The data of the multi-target cases is that of the published scheduling experiments A and C (a
//! rigid body with three wheels on its axes, only the z component of the rate vanishing at a
//! target); the pyramid is that of the published envelope of a square array of four wheels.

pub mod extremals;
pub mod general;
pub mod motions;
pub mod orders;
pub mod ordinary;
pub mod orienteering;
pub mod random;
pub mod schedules;
pub mod solving;
pub mod suite;
pub mod windows;

use slewplan_solver::model::spec::{
    AttitudeSpec, BoresightChoice, PointingSpec, ScenarioSpec, SpacecraftSpec, StateSpec,
    TargetSpec, WheelSpec,
};

/// Identifiers and roll, pitch, yaw in degrees of the 18 published targets.
const TARGETS: [(&str, [f64; 3]); 18] = [
    ("a", [15.0, 0.0, 10.0]),
    ("b", [25.0, 0.0, 50.0]),
    ("c", [15.0, 0.0, 130.0]),
    ("d", [25.0, 0.0, 170.0]),
    ("e", [15.0, 0.0, 250.0]),
    ("f", [25.0, 0.0, 290.0]),
    ("g", [40.0, 0.0, 10.0]),
    ("h", [50.0, 0.0, 50.0]),
    ("i", [40.0, 0.0, 130.0]),
    ("j", [50.0, 0.0, 170.0]),
    ("k", [40.0, 0.0, 250.0]),
    ("l", [50.0, 0.0, 290.0]),
    ("m", [85.0, 0.0, 10.0]),
    ("n", [95.0, 0.0, 50.0]),
    ("o", [85.0, 0.0, 130.0]),
    ("p", [95.0, 0.0, 170.0]),
    ("q", [85.0, 0.0, 250.0]),
    ("r", [95.0, 0.0, 290.0]),
];

/// The published experiment A: targets a to f.
#[must_use]
pub fn experiment_a_spec() -> ScenarioSpec {
    experiment_spec("experiment-a", 6)
}

/// The published experiment B: targets a to l.
#[must_use]
pub fn experiment_b_spec() -> ScenarioSpec {
    experiment_spec("experiment-b", 12)
}

/// The published experiment C: targets a to r.
#[must_use]
pub fn experiment_c_spec() -> ScenarioSpec {
    experiment_spec("experiment-c", TARGETS.len())
}

/// Some targets of the published experiments by their identifiers, without an end.
#[must_use]
pub fn published_targets_spec(ids: &[&str]) -> ScenarioSpec {
    let mut spec = experiment_c_spec();
    spec.targets
        .retain(|target| ids.contains(&target.id.as_str()));
    spec.end = None;
    spec
}

/// The published spacecraft with its first targets: from the identity at rest and back there.
fn experiment_spec(name: &str, targets: usize) -> ScenarioSpec {
    ScenarioSpec {
        name: Some(name.to_owned()),
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[6.63, 0.0, 0.0], [0.0, 8.90, 0.0], [0.0, 0.0, 9.63]],
            max_body_rate_rad_s: [Some(0.04); 3],
            wheels: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(|axis| wheel(axis, 0.000_169, 0.0101, 710.0))
                .into(),
            ..SpacecraftSpec::default()
        },
        start: StateSpec::default(),
        end: Some(StateSpec::default()),
        targets: TARGETS[..targets]
            .iter()
            .map(|&(id, angles)| TargetSpec {
                zero_rate_axes: Some([false, false, true]),
                ..target(id, angles)
            })
            .collect(),
        ..ScenarioSpec::default()
    }
}

/// A four-wheel square pyramid (1 N m s at 3000 rpm and 85.7 mN m per wheel) that turns by
/// 120 degrees about the spin axis of its first wheel, rest to rest.
#[must_use]
pub fn pyramid_spec() -> ScenarioSpec {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let max_speed = 3000.0 * std::f64::consts::TAU / 60.0;
    let sin_half = 60.0_f64.to_radians().sin();
    ScenarioSpec {
        name: Some("pyramid".to_owned()),
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[25.4, 0.0, 0.0], [0.0, 25.4, 0.0], [0.0, 0.0, 25.4]],
            wheels: [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]]
                .map(|axis| wheel(axis, 1.0 / max_speed, 0.0857, max_speed))
                .into(),
            ..SpacecraftSpec::default()
        },
        targets: vec![TargetSpec {
            id: "turned".to_owned(),
            attitude: AttitudeSpec::Quaternion([s * sin_half, 0.0, c * sin_half, 0.5]),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    }
}

/// A target at full rest, from roll, pitch and yaw in degrees.
#[must_use]
pub fn target(id: &str, roll_pitch_yaw_deg: [f64; 3]) -> TargetSpec {
    TargetSpec {
        id: id.to_owned(),
        attitude: AttitudeSpec::RollPitchYawDeg(roll_pitch_yaw_deg),
        ..TargetSpec::default()
    }
}

/// A target at full rest where a body axis points to a right ascension and declination; its roll is free
/// or within limits, all in degrees.
#[must_use]
pub fn pointed_target(
    id: &str,
    boresight: [f64; 3],
    ra_dec_deg: [f64; 2],
    roll_deg: Option<[f64; 2]>,
) -> TargetSpec {
    TargetSpec {
        id: id.to_owned(),
        pointing: Some(PointingSpec {
            boresight: BoresightChoice::Axis(boresight),
            direction: None,
            ra_dec_deg: Some(ra_dec_deg),
            roll_min_deg: roll_deg.map(|[least, _]| least),
            roll_max_deg: roll_deg.map(|[_, greatest]| greatest),
        }),
        ..TargetSpec::default()
    }
}

/// An enabled wheel with equal torque limits in both directions: spin inertia in kg m², torque in
/// N m, speed in rad/s.
#[must_use]
pub fn wheel(axis: [f64; 3], inertia: f64, max_torque: f64, max_speed: f64) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: inertia,
        max_torque_nm: max_torque,
        min_torque_nm: None,
        max_speed_rad_s: Some(max_speed),
        enabled: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::scenario::Scenario;
    use slewplan_solver::wheels::envelope::momentum_problems;

    #[test]
    fn the_reference_scenarios_are_valid_without_warnings() {
        for (spec, targets) in [
            (experiment_a_spec(), 6),
            (experiment_c_spec(), 18),
            (pyramid_spec(), 1),
        ] {
            let validated = Scenario::try_new(&spec).expect("valid");
            assert_eq!(validated.warnings, []);
            assert_eq!(validated.scenario.targets().len(), targets);
            assert_eq!(momentum_problems(&validated.scenario), []);
        }
    }

    #[test]
    fn the_pyramid_turns_by_120_degrees_about_a_spin_axis() {
        let scenario = Scenario::try_new(&pyramid_spec()).expect("valid").scenario;
        let turn = scenario
            .start()
            .attitude
            .signed_turn_to(&scenario.targets()[0].attitude);
        let expected = scenario.spacecraft().wheels()[0].axis * 120.0_f64.to_radians();
        assert!((turn - expected).norm() < 1e-14);
    }
}
