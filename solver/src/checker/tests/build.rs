//! Slews about the x axis with closed forms, as scenarios and flights.

use super::super::{CheckReport, verify};
use crate::model::plan::{Control, Flight, Passage};
use crate::model::scenario::Scenario;
use crate::model::spec::{AttitudeSpec, ScenarioSpec, SpacecraftSpec, TargetSpec, WheelSpec};

pub(super) const SPIN_INERTIA: f64 = 2e-3;
pub(super) const TORQUE: f64 = 0.02;
/// Half of the standard slew, s.
pub(super) const HALF: f64 = 10.0;

/// `J_eff` about x of [`scenario`].
pub(super) const EFFECTIVE_X: f64 = 4.0 - SPIN_INERTIA;

pub(super) fn wheel(axis: [f64; 3]) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: SPIN_INERTIA,
        max_torque_nm: TORQUE,
        min_torque_nm: None,
        max_speed_rad_s: Some(400.0),
        enabled: true,
    }
}

/// The quaternion of a turn about x, continuous in the angle.
pub(super) fn about_x(angle: f64) -> AttitudeSpec {
    AttitudeSpec::Quaternion([(0.5 * angle).sin(), 0.0, 0.0, (0.5 * angle).cos()])
}

pub(super) fn target(id: &str, angle: f64) -> TargetSpec {
    TargetSpec {
        id: id.to_owned(),
        attitude: about_x(angle),
        ..TargetSpec::default()
    }
}

/// Three wheels on the body axes, from rest at the reference axes, no end.
pub(super) fn scenario(targets: Vec<TargetSpec>) -> ScenarioSpec {
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[4.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 6.0]],
            wheels: vec![
                wheel([1.0, 0.0, 0.0]),
                wheel([0.0, 1.0, 0.0]),
                wheel([0.0, 0.0, 1.0]),
            ],
            ..SpacecraftSpec::default()
        },
        targets,
        ..ScenarioSpec::default()
    }
}

/// Angle of a bang-bang slew with two halves of this length, rad.
pub(super) fn angle(half: f64) -> f64 {
    TORQUE / EFFECTIVE_X * half * half
}

pub(super) fn control(start_s: f64, duration_s: f64, torque_x: f64) -> Control {
    Control {
        start_s,
        duration_s,
        wheel_torque_nm: vec![torque_x, 0.0, 0.0],
    }
}

pub(super) fn passage(id: &str, time_s: f64, departure_s: f64) -> Passage {
    Passage {
        target: id.to_owned(),
        time_s,
        departure_s,
    }
}

/// The standard slew to target "a"; the torque on the body is minus the wheel's.
pub(super) fn bang_bang() -> Flight {
    Flight {
        total_time_s: 2.0 * HALF,
        passages: vec![passage("a", 2.0 * HALF, 2.0 * HALF)],
        controls: vec![control(0.0, HALF, -TORQUE), control(HALF, HALF, TORQUE)],
    }
}

pub(super) fn valid(spec: &ScenarioSpec) -> Scenario {
    Scenario::try_new(spec)
        .expect("the test describes a valid scenario")
        .scenario
}

pub(super) fn report(spec: &ScenarioSpec, flight: &Flight) -> CheckReport {
    let report = verify(&valid(spec), flight);
    assert_eq!(
        report.verification.passed,
        report.verification.failures.is_empty()
    );
    report
}

/// Asserts that a flight passes.
pub(super) fn accepted(spec: &ScenarioSpec, flight: &Flight) -> CheckReport {
    let report = report(spec, flight);
    assert!(report.verification.passed, "{:#?}", report.verification);
    report
}

/// Asserts that a flight is refused for a reason that contains the words.
pub(super) fn refused(spec: &ScenarioSpec, flight: &Flight, words: &str) -> CheckReport {
    let report = report(spec, flight);
    let failures = &report.verification.failures;
    assert!(
        failures.iter().any(|sentence| sentence.contains(words)),
        "no \"{words}\" in {failures:#?}"
    );
    report
}
