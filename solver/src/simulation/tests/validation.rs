//! Refused simulations, with codes and pointers.

use super::super::{
    ControllerSpec, ErrorsSpec, GainsSpec, PidGainsSpec, Simulation, SimulationSpec,
};
use super::build::{idle, lively, scenario, spec};
use crate::model::drive::{DriveSpec, SpeedLawSpec};
use crate::model::plan::Flight;
use crate::model::problem::{Code, Problem};

fn refused(flight: &Flight, spec: &SimulationSpec) -> Vec<(Code, String)> {
    let scenario = scenario();
    let problems = Simulation::try_new(&scenario, flight, spec, "/simulation").unwrap_err();
    places(problems)
}

fn places(problems: Vec<Problem>) -> Vec<(Code, String)> {
    assert!(
        problems
            .iter()
            .all(|p| !p.message.is_empty() && !p.hint.is_empty())
    );
    problems.into_iter().map(|p| (p.code, p.pointer)).collect()
}

fn at(code: Code, place: &str) -> (Code, String) {
    (code, format!("/simulation{place}"))
}

#[test]
fn all_problems_of_a_description_are_found_at_once() {
    let spec = SimulationSpec {
        controller: ControllerSpec::Quaternion {
            gains: GainsSpec::Bandwidth {
                bandwidth_rad_s: 0.0,
                damping: f64::NAN,
            },
            gyroscopic: false,
        },
        on_board_rate_hz: Some(f64::INFINITY),
        delay_samples: Some(1000),
        settle_s: Some(-1.0),
        max_step_s: Some(0.0),
        drives: vec![DriveSpec::default()],
        errors: ErrorsSpec {
            inertia_3_sigma: Some(1.5),
            alignment_3_sigma_rad: Some(-0.1),
            friction_3_sigma: Some(f64::NAN),
            disturbance_torque_nm: Some([0.0, f64::NAN, 0.0]),
            ..ErrorsSpec::default()
        },
        runs: Some(0),
        tolerance_deg: Some(-0.1),
        ..SimulationSpec::default()
    };
    assert_eq!(
        refused(&lively(), &spec),
        [
            at(Code::WrongLength, "/drives"),
            at(Code::OutOfRange, "/controller/gains/bandwidth_rad_s"),
            at(Code::NotFinite, "/controller/gains/damping"),
            at(Code::NotFinite, "/on_board_rate_hz"),
            at(Code::OutOfRange, "/delay_samples"),
            at(Code::OutOfRange, "/settle_s"),
            at(Code::OutOfRange, "/max_step_s"),
            at(Code::OutOfRange, "/errors/inertia_3_sigma"),
            at(Code::OutOfRange, "/errors/alignment_3_sigma_rad"),
            at(Code::NotFinite, "/errors/friction_3_sigma"),
            at(Code::NotFinite, "/errors/disturbance_torque_nm/1"),
            at(Code::OutOfRange, "/runs"),
            at(Code::OutOfRange, "/tolerance_deg"),
        ]
    );
}

#[test]
fn friction_that_needs_too_short_steps_is_refused() {
    let drive = DriveSpec {
        viscous_friction_nms: Some(1e6),
        ..DriveSpec::default()
    };
    let spec = SimulationSpec {
        drives: vec![drive; spec().spacecraft.wheels.len()],
        ..SimulationSpec::default()
    };
    assert_eq!(refused(&lively(), &spec), [at(Code::OutOfRange, "")]);
}

#[test]
fn gains_are_checked_in_every_form() {
    let settling = ControllerSpec::StepInput {
        gains: GainsSpec::SettlingTime {
            settling_time_s: -1.0,
            damping: 0.0,
        },
        gyroscopic: false,
    };
    let given = ControllerSpec::Quaternion {
        gains: GainsSpec::Given {
            attitude_per_s2: -1.0,
            rate_per_s: f64::NAN,
        },
        gyroscopic: false,
    };
    let poles = ControllerSpec::GeometricPid {
        gains: PidGainsSpec::Bandwidth {
            bandwidth_rad_s: -1.0,
            damping: 0.0,
            integral_rad_s: -0.1,
        },
        anti_windup: true,
    };
    let pid = ControllerSpec::GeometricPid {
        gains: PidGainsSpec::Given {
            attitude_nm: -1.0,
            rate_nms: -1.0,
            integral_nm: -1.0,
            attitude_weight_per_s: f64::NAN,
        },
        anti_windup: false,
    };
    for (controller, names) in [
        (settling, &["settling_time_s", "damping"][..]),
        (given, &["attitude_per_s2", "rate_per_s"]),
        (poles, &["bandwidth_rad_s", "damping", "integral_rad_s"]),
        (
            pid,
            &[
                "attitude_nm",
                "rate_nms",
                "integral_nm",
                "attitude_weight_per_s",
            ],
        ),
    ] {
        let spec = SimulationSpec {
            controller,
            ..SimulationSpec::default()
        };
        let found = refused(&lively(), &spec);
        let found: Vec<_> = found.into_iter().map(|(_, pointer)| pointer).collect();
        let place = |name: &&str| format!("/simulation/controller/gains/{name}");
        let expected: Vec<_> = names.iter().map(place).collect();
        assert_eq!(found, expected);
    }
}

#[test]
fn contradictory_settings_are_refused() {
    let slow_loop = SimulationSpec {
        on_board_rate_hz: Some(10.0),
        wheel_loop_rate_hz: Some(5.0),
        ..SimulationSpec::default()
    };
    assert_eq!(
        refused(&lively(), &slow_loop),
        [at(Code::OutOfRange, "/wheel_loop_rate_hz")]
    );
    // This flight does not end at rest.
    let held = SimulationSpec {
        settle_s: Some(10.0),
        ..SimulationSpec::default()
    };
    assert_eq!(
        refused(&lively(), &held),
        [at(Code::ConflictingFields, "/settle_s")]
    );
    let fine = SimulationSpec {
        max_step_s: Some(1e-9),
        ..SimulationSpec::default()
    };
    assert_eq!(refused(&lively(), &fine), [at(Code::OutOfRange, "")]);
    let law = DriveSpec {
        speed_law: Some(SpeedLawSpec {
            rate_per_s: 1.0,
            speed_rad_s: 0.0,
        }),
        ..DriveSpec::default()
    };
    let spec = SimulationSpec {
        drives: vec![
            law.clone(),
            law,
            DriveSpec::default(),
            DriveSpec::default(),
            DriveSpec::default(),
        ],
        ..SimulationSpec::default()
    };
    assert_eq!(
        refused(&lively(), &spec),
        [at(Code::WheelAxesCoplanar, "/drives")]
    );
}

#[test]
fn flights_that_cannot_be_propagated_are_refused() {
    let plan = |flight: &Flight| {
        let found = refused(flight, &SimulationSpec::default());
        assert!(!found.is_empty());
        assert!(
            found
                .iter()
                .all(|f| *f == (Code::VerificationFailed, "/plan".to_owned())),
            "{found:?}"
        );
    };
    let mut gap = lively();
    gap.controls[1].start_s += 1.0;
    plan(&gap);
    let mut late = lively();
    late.passages[0].time_s = 30.0;
    plan(&late);
    late.passages[0].time_s = f64::NAN;
    plan(&late);
    plan(&idle(0.0));
}
