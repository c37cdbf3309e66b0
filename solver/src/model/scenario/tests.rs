mod cones;
mod labels;
mod pointing;
mod remarks;
mod sky;
mod unit_slips;
mod windows;

use super::reference::experiment_a;
use super::*;
use crate::model::cone::Applies;
use crate::model::problem::Code;
use crate::model::spec::{AttitudeEquivalence, AttitudeSpec, BoresightSpec, ConeSpec, StateSpec};

/// A change of a valid description, and the code and pointer that are expected.
type Fault = (fn(&mut ScenarioSpec), Code, &'static str);

fn valid() -> ScenarioSpec {
    let mut spec = experiment_a();
    spec.spacecraft.boresights.push(BoresightSpec {
        name: "camera".to_owned(),
        axis: [0.0, 0.0, 1.0],
    });
    spec.keep_out.push(ConeSpec {
        boresight: "camera".to_owned(),
        direction: [3.0, 0.0, 0.0].into(),
        half_angle_deg: 30.0,
        applies: Applies::Report,
    });
    spec
}

fn end(spec: &mut ScenarioSpec) -> &mut StateSpec {
    spec.end.get_or_insert_default()
}

fn bounds(spec: &mut ScenarioSpec, min: [Option<f64>; 3], max: [Option<f64>; 3]) {
    spec.targets[1].zero_rate_axes = None;
    spec.targets[1].rate_min_rad_s = Some(min);
    spec.targets[1].rate_max_rad_s = Some(max);
}

fn expect_faults(table: &[Fault]) {
    for (break_it, code, pointer) in table {
        let mut spec = valid();
        break_it(&mut spec);
        let problems = Scenario::try_new(&spec).expect_err(pointer);
        let found: Vec<_> = problems
            .iter()
            .map(|p| (p.code, p.pointer.as_str()))
            .collect();
        assert_eq!(found, [(*code, *pointer)]);
        assert!(!problems[0].message.is_empty() && !problems[0].hint.is_empty());
    }
}

#[test]
fn a_valid_description_becomes_a_scenario() {
    let mut spec = valid();
    spec.epoch = Some("2026-01-01T00:00:00Z".to_owned());
    spec.time_system = Some(TimeSystem::Utc);
    spec.reference_frame = Some(ReferenceFrame::Eme2000);
    let Validated { scenario, warnings } = Scenario::try_new(&spec).unwrap();
    assert_eq!(warnings, []);
    assert_eq!(
        scenario.epoch(),
        Some(jiff::civil::date(2026, 1, 1).at(0, 0, 0, 0))
    );
    assert_eq!(scenario.time_system(), Some(TimeSystem::Utc));
    assert_eq!(scenario.reference_frame(), Some(ReferenceFrame::Eme2000));
    assert_eq!(scenario.start().wheel_speed, [0.0; 3]);
    assert_eq!(scenario.targets().len(), 6);
    let [x, y, z] = scenario.targets()[0].rate;
    assert_eq!([x, y], [RateCondition::Free; 2]);
    assert_eq!(z, RateCondition::Fixed(0.0));
    assert_eq!(scenario.cones()[0].direction, Vector3::x());
    assert!(scenario.momentum().norm() < f64::MIN_POSITIVE);
}

#[test]
fn faults_of_start_and_end_are_found() {
    expect_faults(&[
        (
            |s| s.start.attitude = AttitudeSpec::Quaternion([0.0; 4]),
            Code::QuaternionNorm,
            "/start/attitude/quaternion",
        ),
        (
            |s| s.start.body_rate_rad_s = Some([0.0, f64::NAN, 0.0]),
            Code::NotFinite,
            "/start/body_rate_rad_s/1",
        ),
        (
            |s| s.start.body_rate_rad_s = Some([0.0, -0.041, 0.0]),
            Code::BodyRateLimit,
            "/start/body_rate_rad_s/1",
        ),
        (
            |s| {
                s.spacecraft.max_body_rate_norm_rad_s = Some(0.04);
                s.start.body_rate_rad_s = Some([0.03, -0.03, 0.0]);
            },
            Code::BodyRateLimit,
            "/start/body_rate_rad_s",
        ),
        (
            |s| s.start.wheel_speed_rad_s = Some(vec![0.0; 4]),
            Code::WrongLength,
            "/start/wheel_speed_rad_s",
        ),
        (
            |s| s.start.wheel_speed_rad_s = Some(vec![0.0, 0.0, -711.0]),
            Code::WheelSpeedLimit,
            "/start/wheel_speed_rad_s/2",
        ),
        (
            |s| {
                s.options.momentum_authority = 0.5;
                s.start.wheel_speed_rad_s = Some(vec![0.0, 356.0, 0.0]);
            },
            Code::WheelSpeedLimit,
            "/start/wheel_speed_rad_s/1",
        ),
        (
            |s| s.start.wheel_speed_rad_s = Some(vec![f64::INFINITY, 0.0, 0.0]),
            Code::NotFinite,
            "/start/wheel_speed_rad_s/0",
        ),
        (
            |s| end(s).attitude = AttitudeSpec::Mrp([f64::NAN, 0.0, 0.0]),
            Code::NotFinite,
            "/end/attitude/mrp/0",
        ),
        (
            |s| end(s).body_rate_rad_s = Some([0.05, 0.0, 0.0]),
            Code::BodyRateLimit,
            "/end/body_rate_rad_s/0",
        ),
        (
            |s| end(s).wheel_speed_rad_s = Some(vec![0.0; 2]),
            Code::WrongLength,
            "/end/wheel_speed_rad_s",
        ),
        (
            |s| end(s).wheel_speed_rad_s = Some(vec![0.0, 800.0, 0.0]),
            Code::WheelSpeedLimit,
            "/end/wheel_speed_rad_s/1",
        ),
        (
            |s| end(s).wheel_speed_rad_s = Some(vec![0.0, 0.0, 0.01]),
            Code::EndMomentumInconsistent,
            "/end/wheel_speed_rad_s",
        ),
    ]);
}

#[test]
fn unlimited_rates_must_have_a_finite_momentum() {
    expect_faults(&[
        (
            |s| {
                s.spacecraft.max_body_rate_rad_s = [None; 3];
                s.start.body_rate_rad_s = Some([1e200, 0.0, 0.0]);
            },
            Code::OutOfRange,
            "/start",
        ),
        (
            |s| {
                s.spacecraft.max_body_rate_rad_s = [None; 3];
                end(s).body_rate_rad_s = Some([1e200, 0.0, 0.0]);
            },
            Code::OutOfRange,
            "/end",
        ),
    ]);
}

#[test]
fn faults_of_targets_are_found() {
    expect_faults(&[
        (
            |s| {
                s.targets.clear();
                s.end = None;
            },
            Code::OutOfRange,
            "/targets",
        ),
        (
            |s| s.targets[3].id = "b".to_owned(),
            Code::DuplicateId,
            "/targets/3/id",
        ),
        (
            |s| s.targets[3].id = "start".to_owned(),
            Code::DuplicateId,
            "/targets/3/id",
        ),
        (
            |s| s.targets[3].id.clear(),
            Code::MissingField,
            "/targets/3/id",
        ),
        (
            |s| s.targets[2].attitude = AttitudeSpec::RollPitchYawDeg([0.0, 0.0, f64::NAN]),
            Code::NotFinite,
            "/targets/2/attitude/roll_pitch_yaw_deg/2",
        ),
        (
            |s| s.targets[1].rate_min_rad_s = Some([None; 3]),
            Code::ConflictingFields,
            "/targets/1/zero_rate_axes",
        ),
        (
            |s| bounds(s, [Some(f64::NAN), None, None], [None; 3]),
            Code::NotFinite,
            "/targets/1/rate_min_rad_s/0",
        ),
        (
            |s| bounds(s, [None, Some(0.02), None], [None, Some(0.01), None]),
            Code::EmptyRange,
            "/targets/1/rate_min_rad_s/1",
        ),
        (
            |s| bounds(s, [None, Some(0.05), None], [None; 3]),
            Code::BodyRateLimit,
            "/targets/1/rate_min_rad_s/1",
        ),
        (
            |s| bounds(s, [None; 3], [None, None, Some(-0.05)]),
            Code::BodyRateLimit,
            "/targets/1/rate_max_rad_s/2",
        ),
        (
            |s| {
                s.spacecraft.max_body_rate_norm_rad_s = Some(0.02);
                bounds(s, [Some(0.015), Some(0.015), None], [None; 3]);
            },
            Code::BodyRateLimit,
            "/targets/1/rate_min_rad_s",
        ),
        (
            |s| {
                s.targets[1].dwell_s = 1.0;
                bounds(s, [Some(0.001), None, None], [None; 3]);
            },
            Code::ConflictingFields,
            "/targets/1/rate_min_rad_s/0",
        ),
        (
            |s| s.targets[4].dwell_s = -1.0,
            Code::OutOfRange,
            "/targets/4/dwell_s",
        ),
        (
            |s| s.targets[4].settle_s = f64::INFINITY,
            Code::NotFinite,
            "/targets/4/settle_s",
        ),
    ]);
}

#[test]
fn faults_of_cones_and_options_are_found() {
    expect_faults(&[
        (
            |s| s.keep_out[0].boresight = "kamera".to_owned(),
            Code::UnknownReference,
            "/keep_out/0/boresight",
        ),
        (
            |s| s.keep_out[0].direction = [0.0; 3].into(),
            Code::ZeroDirection,
            "/keep_out/0/direction",
        ),
        (
            |s| s.keep_out[0].half_angle_deg = 180.0,
            Code::OutOfRange,
            "/keep_out/0/half_angle_deg",
        ),
        (
            |s| s.keep_out[0].half_angle_deg = f64::NAN,
            Code::NotFinite,
            "/keep_out/0/half_angle_deg",
        ),
        (
            |s| s.keep_out = vec![s.keep_out[0].clone(); 1001],
            Code::WrongLength,
            "/keep_out",
        ),
        (
            |s| s.options.time_limit_s = Some(0.0),
            Code::OutOfRange,
            "/options/time_limit_s",
        ),
        (
            |s| s.options.time_limit_s = Some(1e300),
            Code::OutOfRange,
            "/options/time_limit_s",
        ),
        (
            |s| s.options.node_limit = Some(0),
            Code::OutOfRange,
            "/options/node_limit",
        ),
        (
            |s| s.options.relative_gap = 1.0,
            Code::OutOfRange,
            "/options/relative_gap",
        ),
        (
            |s| s.options.relative_gap = f64::NAN,
            Code::NotFinite,
            "/options/relative_gap",
        ),
        (
            |s| s.options.alternatives = 101,
            Code::OutOfRange,
            "/options/alternatives",
        ),
        (
            |s| s.options.torque_authority = 0.0,
            Code::OutOfRange,
            "/options/torque_authority",
        ),
        (
            |s| s.options.momentum_authority = 1.1,
            Code::OutOfRange,
            "/options/momentum_authority",
        ),
    ]);
}

#[test]
fn everything_wrong_is_listed_at_once_in_the_order_of_the_document() {
    let mut spec = valid();
    spec.options.alternatives = 1000;
    spec.keep_out[0].boresight = "none".to_owned();
    spec.targets[5].id = "a".to_owned();
    spec.targets[5].dwell_s = f64::NAN;
    spec.targets[0].attitude = AttitudeSpec::Quaternion([0.0; 4]);
    end(&mut spec).body_rate_rad_s = Some([1.0, 0.0, 0.0]);
    spec.start.wheel_speed_rad_s = Some(vec![1e4, 0.0]);
    spec.spacecraft.inertia_kg_m2[0][0] = -1.0;
    let problems = Scenario::try_new(&spec).unwrap_err();
    let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    assert_eq!(
        pointers,
        [
            "/spacecraft/inertia_kg_m2",
            "/start/wheel_speed_rad_s",
            "/end/body_rate_rad_s/0",
            "/targets/0/attitude/quaternion",
            "/targets/5/id",
            "/targets/5/dwell_s",
            "/keep_out/0/boresight",
            "/options/alternatives",
        ]
    );
}

#[test]
fn quaternion_equivalence_needs_signs_everywhere() {
    let unsigned = AttitudeSpec::Matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let mut spec = valid();
    spec.start.attitude = unsigned.clone();
    spec.targets[2].attitude = unsigned;
    assert!(Scenario::try_new(&spec).is_ok());
    spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    let problems = Scenario::try_new(&spec).unwrap_err();
    let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    assert_eq!(
        pointers,
        ["/start/attitude/matrix", "/targets/2/attitude/matrix"]
    );
    assert!(problems.iter().all(|p| p.code == Code::SignUndefined));
}

#[test]
fn waiting_at_a_target_forces_rest() {
    let mut spec = valid();
    spec.targets[0].dwell_s = 5.0;
    spec.targets[1].settle_s = 1.0;
    bounds(
        &mut spec,
        [Some(-0.001), None, None],
        [Some(0.001), None, None],
    );
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    for target in &scenario.targets()[..2] {
        assert_eq!(target.rate, [RateCondition::Fixed(0.0); 3]);
    }
}

#[test]
fn bounds_become_conditions() {
    let mut spec = valid();
    bounds(
        &mut spec,
        [Some(0.01), Some(-0.01), None],
        [Some(0.01), None, None],
    );
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    let expected = [
        RateCondition::Fixed(0.01),
        RateCondition::Within(-0.01, f64::INFINITY),
        RateCondition::Free,
    ];
    assert_eq!(scenario.targets()[1].rate, expected);
}

#[test]
fn rest_is_required_without_other_conditions() {
    let mut spec = valid();
    spec.targets[0].zero_rate_axes = None;
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    assert_eq!(scenario.targets()[0].rate, [RateCondition::Fixed(0.0); 3]);
}

#[test]
fn wheel_speeds_at_the_end_may_repeat_the_conserved_momentum() {
    let mut spec = valid();
    spec.start.wheel_speed_rad_s = Some(vec![100.0, -50.0, 20.0]);
    let quarter = AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 90.0]);
    end(&mut spec).attitude = quarter;
    // A vector fixed in the reference frame turns backwards in the body.
    end(&mut spec).wheel_speed_rad_s = Some(vec![-50.0, -100.0, 20.0]);
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    assert_eq!(
        scenario.end().unwrap().wheel_speed.as_ref().unwrap().len(),
        3
    );
    end(&mut spec).wheel_speed_rad_s = Some(vec![100.0, -50.0, 20.0]);
    let problems = Scenario::try_new(&spec).unwrap_err();
    assert_eq!(problems[0].code, Code::EndMomentumInconsistent);
}

#[test]
fn a_locked_wheel_keeps_its_speed_and_ignores_the_authority() {
    let mut spec = valid();
    let mut fourth = spec.spacecraft.wheels[2].clone();
    fourth.enabled = false;
    spec.spacecraft.wheels.push(fourth);
    spec.options.momentum_authority = 0.5;
    spec.start.wheel_speed_rad_s = Some(vec![0.0, 0.0, 0.0, 700.0]);
    end(&mut spec).wheel_speed_rad_s = Some(vec![0.0, 0.0, 0.0, 700.0]);
    assert!(Scenario::try_new(&spec).is_ok());
    // The same momentum, moved from the locked wheel to a parallel one.
    end(&mut spec).wheel_speed_rad_s = Some(vec![0.0, 0.0, 100.0, 600.0]);
    let problems = Scenario::try_new(&spec).unwrap_err();
    let found: Vec<_> = problems
        .iter()
        .map(|p| (p.code, p.pointer.as_str()))
        .collect();
    assert_eq!(
        found,
        [(Code::ConflictingFields, "/end/wheel_speed_rad_s/3")]
    );
}

#[test]
fn a_scenario_may_have_an_end_and_no_targets() {
    let mut spec = valid();
    spec.targets.clear();
    assert!(
        Scenario::try_new(&spec)
            .unwrap()
            .scenario
            .targets()
            .is_empty()
    );
}
