use super::super::unknown_members::{is_told, with_an_extra_member};
use super::*;
use slewplan_solver::model::spec::{Accuracy, AttitudeEquivalence, OptionsSpec};

const COMPLETE: &str = r#"{
    "name": "n", "epoch": "2026-01-01T00:00:00Z", "time_system": "UTC",
    "reference_frame": "EME2000",
    "spacecraft": {
        "inertia_kg_m2": [[1, 0, 0], [0, 2, 0], [0, 0, 3]],
        "max_body_rate_rad_s": [0.1, null, 0.3], "max_body_rate_norm_rad_s": 0.4,
        "wheels": [{"axis": [1, 0, 0], "normalize_axis": false, "inertia_kg_m2": 0.1,
            "max_torque_nm": 0.2, "min_torque_nm": -0.3, "max_speed_rad_s": null,
            "enabled": false}],
        "boresights": [{"name": "camera", "axis": [0, 0, 1]}]
    },
    "start": {"attitude": {"mrp": [0, 0, 0]}, "wheel_speed_rad_s": [1, 2]},
    "end": null,
    "targets": [{"id": "t", "attitude": {"mrp": [0.1, 0, 0]}, "zero_rate_axes": ["z", "x"],
        "rate_min_rad_s": [null, -0.1, null], "dwell_s": 1, "settle_s": 2.5, "position": 1,
        "after": ["u", "v"]},
        {"id": "u", "pointing": {"boresight": "camera", "direction": [1, 0, 0], "ra_dec_deg": [2, 3],
            "roll_min_deg": -4, "roll_max_deg": 5}}],
    "keep_out": [{"boresight": "camera", "direction": [1, 0, 0], "half_angle_deg": 30}],
    "options": {"accuracy": "tight", "attitude_equivalence": "quaternion", "time_limit_s": null, "node_limit": 7,
        "relative_gap": 0.01, "alternatives": 3, "torque_authority": 0.9,
        "momentum_authority": 0.8, "seed": 18446744073709551615}
}"#;

fn decoded(text: &str) -> (ScenarioSpec, Vec<Problem>) {
    decode(&document::parse(text.as_bytes()).unwrap())
}

#[test]
fn a_member_that_nobody_knows_is_refused_in_every_object() {
    for changed in with_an_extra_member(COMPLETE) {
        let (_, problems) = decoded(&changed);
        assert!(is_told(&problems), "{problems:?} of {changed}");
    }
}

#[test]
fn every_field_arrives() {
    let (spec, problems) = decoded(COMPLETE);
    assert_eq!(problems, []);
    assert_eq!(spec.epoch.as_deref(), Some("2026-01-01T00:00:00Z"));
    let body = &spec.spacecraft;
    assert_eq!(
        body.inertia_kg_m2[2].map(f64::to_bits),
        [0.0, 0.0, 3.0].map(f64::to_bits)
    );
    assert_eq!(body.max_body_rate_rad_s, [Some(0.1), None, Some(0.3)]);
    assert_eq!(body.max_body_rate_norm_rad_s, Some(0.4));
    let wheel = &body.wheels[0];
    assert!(!wheel.normalize_axis && !wheel.enabled);
    assert_eq!(
        (wheel.min_torque_nm, wheel.max_speed_rad_s),
        (Some(-0.3), None)
    );
    assert_eq!(body.boresights[0].name, "camera");
    assert_eq!(spec.start.wheel_speed_rad_s, Some(vec![1.0, 2.0]));
    assert_eq!(spec.end, None);
    let target = &spec.targets[0];
    assert_eq!(target.zero_rate_axes, Some([true, false, true]));
    assert_eq!(target.rate_min_rad_s, Some([None, Some(-0.1), None]));
    assert_eq!((target.dwell_s, target.settle_s), (1.0, 2.5));
    assert_eq!(target.position, Some(1));
    assert_eq!(target.after, ["u", "v"]);
    let pointing = spec.targets[1].pointing.as_ref().expect("given");
    assert_eq!(pointing.direction, Some([1.0, 0.0, 0.0].into()));
    assert_eq!(pointing.ra_dec_deg, Some([2.0, 3.0]));
    let limits = [pointing.roll_min_deg, pointing.roll_max_deg];
    assert_eq!(limits, [Some(-4.0), Some(5.0)]);
    assert_eq!(
        spec.keep_out[0].half_angle_deg.to_bits(),
        30.0_f64.to_bits()
    );
}

#[test]
fn every_option_arrives() {
    let expected = OptionsSpec {
        accuracy: Accuracy::Tight,
        attitude_equivalence: AttitudeEquivalence::Quaternion,
        time_limit_s: None,
        node_limit: Some(7),
        relative_gap: 0.01,
        alternatives: 3,
        torque_authority: 0.9,
        momentum_authority: 0.8,
        seed: u64::MAX,
    };
    assert_eq!(decoded(COMPLETE).0.options, expected);
}

#[test]
fn an_empty_object_misses_exactly_the_required_fields() {
    let (spec, problems) = decoded("{}");
    let pointers: Vec<&str> = problems.iter().map(|p| &*p.pointer).collect();
    assert_eq!(pointers, ["/spacecraft", "/start", "/targets"]);
    assert_eq!(spec.options, OptionsSpec::default());
}

#[test]
fn a_stored_spacecraft_is_refused_in_words() {
    let text = COMPLETE.replace(
        "\"inertia_kg_m2\": [[",
        "\"ref\": \"sat\", \"inertia_kg_m2\": [[",
    );
    let (_, problems) = decoded(&text);
    assert_eq!(problems.len(), 1);
    assert_eq!(problems[0].pointer, "/spacecraft/ref");
    assert_eq!(problems[0].code, Code::UnknownReference);
}

#[test]
fn only_what_may_follow_from_a_substitute_is_dropped() {
    let at = |pointer: &str, code| Problem::new(pointer, code, "", "");
    let shape = [
        at("/spacecraft/wheels/1/axis", Code::WrongType),
        at("/targets/0/colour", Code::UnknownField),
    ];
    let follows =
        |pointer: &str, code| follows_from_a_substitute(&at(pointer, code), &replaced(&shape));
    assert!(follows("/spacecraft/wheels", Code::WheelAxesCoplanar));
    assert!(follows("/spacecraft/wheels/1/axis/0", Code::NotFinite));
    assert!(!follows("/start/wheel_speed_rad_s", Code::WrongLength));
    assert!(!follows("/spacecraft/wheels/10", Code::TorqueLimits));
    assert!(!follows("/targets/0", Code::DuplicateId));
}

#[test]
fn a_damaged_wheel_does_not_hide_what_is_wrong_with_all_of_them() {
    let shape = [Problem::new(
        "/spacecraft/wheels/0/inertia_kg_m2",
        Code::MissingField,
        "",
        "",
    )];
    for code in [
        Code::TooFewWheels,
        Code::TooManyWheels,
        Code::WheelAxesCoplanar,
    ] {
        let found = Problem::new("/spacecraft/wheels", code, "", "");
        assert!(
            !follows_from_a_substitute(&found, &replaced(&shape)),
            "{code}"
        );
    }
}

#[test]
fn a_nameless_target_may_be_the_one_that_another_comes_after() {
    let found = Problem::new("/targets/0/after/0", Code::UnknownReference, "", "");
    let follows = |pointer: &str| {
        let shape = [Problem::new(pointer, Code::WrongType, "", "")];
        follows_from_a_substitute(&found, &replaced(&shape))
    };
    for pointer in [
        "/targets",
        "/targets/1",
        "/targets/1/id",
        "/targets/0/after",
    ] {
        assert!(follows(pointer), "{pointer}");
    }
    for pointer in ["/targets/1/attitude", "/targets/1/after/0", "/start"] {
        assert!(!follows(pointer), "{pointer}");
    }
}

#[test]
fn nobody_doubts_the_units_of_a_substitute() {
    let follows = |shape: &str, pointer: &str, code| {
        let shape = [Problem::new(shape, Code::WrongType, "", "")];
        follows_from_a_substitute(&Problem::new(pointer, code, "", ""), &replaced(&shape))
    };
    let (inertia, wheels) = ("/spacecraft/inertia_kg_m2", "/spacecraft/wheels");
    assert!(follows(wheels, inertia, Code::AccelerationImplausible));
    assert!(!follows(
        "/targets/0/id",
        inertia,
        Code::AccelerationImplausible
    ));
    let (boresights, named) = ("/spacecraft/boresights", "/start/attitude/boresight");
    assert!(follows(boresights, named, Code::UnknownReference));
    assert!(!follows("/targets/0/id", named, Code::UnknownReference));
}

#[test]
fn without_wheels_nothing_is_said_about_their_number() {
    let shape = [Problem::new(
        "/spacecraft/wheels",
        Code::MissingField,
        "",
        "",
    )];
    let found = Problem::new("/start/wheel_speed_rad_s", Code::WrongLength, "", "");
    assert!(follows_from_a_substitute(&found, &replaced(&shape)));
}
