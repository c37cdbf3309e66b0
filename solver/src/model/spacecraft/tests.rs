use super::*;
use crate::model::scenario::reference::experiment_a;

/// A change of a valid description, and the code and pointer that are expected.
type Fault = (fn(&mut SpacecraftSpec), Code, &'static str);

fn valid() -> SpacecraftSpec {
    SpacecraftSpec {
        boresights: vec![BoresightSpec {
            name: "camera".to_owned(),
            axis: [0.0, 0.0, 2.0],
        }],
        ..experiment_a().spacecraft
    }
}

fn findings_of(spec: &SpacecraftSpec) -> Vec<(Code, String)> {
    let problems = Spacecraft::try_new(spec, "/spacecraft").expect_err("refused");
    for problem in &problems {
        assert!(
            !problem.message.is_empty() && !problem.hint.is_empty(),
            "{problem}"
        );
    }
    problems.into_iter().map(|p| (p.code, p.pointer)).collect()
}

fn diagonal(x: f64, y: f64, z: f64) -> [[f64; 3]; 3] {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

#[test]
fn a_valid_description_becomes_a_spacecraft() {
    let spacecraft = Spacecraft::try_new(&valid(), "/spacecraft").unwrap();
    let j_eff = spacecraft.effective_inertia();
    assert!((j_eff.m11 - (6.63 - 0.000_169)).abs() < 1e-15);
    let product = j_eff * spacecraft.effective_inertia_inverse();
    assert!((product - Matrix3::identity()).amax() < 1e-14);
    assert!((spacecraft.wheels()[0].min_torque + 0.0101).abs() < 1e-15);
    assert_eq!(spacecraft.boresights()[0].axis, Vector3::z());
    assert!(spacecraft.max_rate_norm().is_infinite());
}

/// Gives an axis another length and switches its normalisation off.
fn unscaled(wheel: &mut crate::model::spec::WheelSpec, length: f64) {
    wheel.normalize_axis = false;
    wheel.axis = wheel.axis.map(|component| component * length);
}

fn expect_faults(table: &[Fault]) {
    for (break_it, code, pointer) in table {
        let mut spec = valid();
        break_it(&mut spec);
        let expected = (*code, format!("/spacecraft{pointer}"));
        assert_eq!(findings_of(&spec), [expected]);
    }
}

#[test]
fn faults_of_the_body_have_their_code_and_place() {
    expect_faults(&[
        (
            |s| s.inertia_kg_m2[1][2] = f64::NAN,
            Code::NotFinite,
            "/inertia_kg_m2/1/2",
        ),
        (
            |s| s.inertia_kg_m2[0][1] = 1e-6,
            Code::InertiaNotSymmetric,
            "/inertia_kg_m2",
        ),
        (
            |s| s.inertia_kg_m2[2][2] = -9.63,
            Code::InertiaNotPositive,
            "/inertia_kg_m2",
        ),
        (
            |s| s.inertia_kg_m2 = [[0.0; 3]; 3],
            Code::InertiaNotPositive,
            "/inertia_kg_m2",
        ),
        (
            |s| s.inertia_kg_m2[2][2] = 15.54,
            Code::InertiaTriangle,
            "/inertia_kg_m2",
        ),
        (
            |s| s.max_body_rate_rad_s[1] = Some(0.0),
            Code::OutOfRange,
            "/max_body_rate_rad_s/1",
        ),
        (
            |s| s.max_body_rate_norm_rad_s = Some(-1.0),
            Code::OutOfRange,
            "/max_body_rate_norm_rad_s",
        ),
    ]);
}

#[test]
fn faults_of_wheels_and_boresights_have_their_code_and_place() {
    expect_faults(&[
        (
            |s| s.wheels[0].axis = [0.0; 3],
            Code::ZeroDirection,
            "/wheels/0/axis",
        ),
        (
            |s| s.wheels[0].axis[2] = f64::INFINITY,
            Code::NotFinite,
            "/wheels/0/axis/2",
        ),
        (
            |s| unscaled(&mut s.wheels[0], 1e-60),
            Code::OutOfRange,
            "/wheels/0/axis",
        ),
        (
            |s| unscaled(&mut s.wheels[2], 1e-170),
            Code::OutOfRange,
            "/wheels/2/axis",
        ),
        (
            |s| unscaled(&mut s.wheels[1], 1e4),
            Code::OutOfRange,
            "/wheels/1/axis",
        ),
        (
            |s| s.wheels[1].inertia_kg_m2 = 0.0,
            Code::OutOfRange,
            "/wheels/1/inertia_kg_m2",
        ),
        (
            |s| s.wheels[1].max_torque_nm = 0.0,
            Code::TorqueLimits,
            "/wheels/1/max_torque_nm",
        ),
        (
            |s| s.wheels[2].min_torque_nm = Some(0.0),
            Code::TorqueLimits,
            "/wheels/2/min_torque_nm",
        ),
        (
            |s| s.wheels[2].max_speed_rad_s = Some(0.0),
            Code::OutOfRange,
            "/wheels/2/max_speed_rad_s",
        ),
        (
            |s| s.wheels[0].enabled = false,
            Code::TooFewWheels,
            "/wheels",
        ),
        (|s| s.wheels.clear(), Code::TooFewWheels, "/wheels"),
        (
            |s| s.wheels.extend(vec![s.wheels[0].clone(); 15]),
            Code::TooManyWheels,
            "/wheels",
        ),
        (
            |s| s.wheels[2].axis = [5.0, -3.0, 1e-8],
            Code::WheelAxesCoplanar,
            "/wheels",
        ),
        (
            |s| s.wheels[0].inertia_kg_m2 = 6.63,
            Code::WheelInertiaExceedsBody,
            "/wheels",
        ),
        (
            |s| s.boresights[0].axis = [0.0; 3],
            Code::ZeroDirection,
            "/boresights/0/axis",
        ),
        (
            |s| s.boresights[0].name.clear(),
            Code::MissingField,
            "/boresights/0/name",
        ),
        (
            |s| s.boresights.push(s.boresights[0].clone()),
            Code::DuplicateId,
            "/boresights/1/name",
        ),
    ]);
}

#[test]
fn all_faults_are_listed_in_the_order_of_the_document() {
    let mut spec = valid();
    spec.boresights[0].axis = [0.0; 3];
    spec.wheels[1].max_torque_nm = -1.0;
    spec.wheels[1].min_torque_nm = Some(1.0);
    spec.wheels[2].inertia_kg_m2 = f64::NAN;
    spec.max_body_rate_rad_s[2] = Some(-0.1);
    spec.inertia_kg_m2[0][0] = 100.0;
    let expected = [
        (Code::InertiaTriangle, "/spacecraft/inertia_kg_m2"),
        (Code::OutOfRange, "/spacecraft/max_body_rate_rad_s/2"),
        (Code::TorqueLimits, "/spacecraft/wheels/1/max_torque_nm"),
        (Code::TorqueLimits, "/spacecraft/wheels/1/min_torque_nm"),
        (Code::NotFinite, "/spacecraft/wheels/2/inertia_kg_m2"),
        (Code::ZeroDirection, "/spacecraft/boresights/0/axis"),
    ];
    assert_eq!(
        findings_of(&spec),
        expected.map(|(code, pointer)| (code, pointer.to_owned()))
    );
}

#[test]
fn limiting_inertias_are_accepted_at_any_scale() {
    // A flat plate meets the triangle inequality with equality.
    for scale in [1e-120, 1.0, 1e120] {
        let mut spec = valid();
        spec.inertia_kg_m2 = diagonal(scale, 2.0 * scale, 3.0 * scale);
        for wheel in &mut spec.wheels {
            wheel.inertia_kg_m2 = 1e-6 * scale;
        }
        let spacecraft = Spacecraft::try_new(&spec, "").unwrap();
        let product = spacecraft.effective_inertia() * spacecraft.effective_inertia_inverse();
        assert!((product - Matrix3::identity()).amax() < 1e-14);
    }
}

#[test]
fn mirrored_entries_that_differ_by_rounding_are_averaged() {
    let mut spec = valid();
    spec.inertia_kg_m2[0][1] = 0.1;
    spec.inertia_kg_m2[1][0] = 0.1 + 1e-10;
    let spacecraft = Spacecraft::try_new(&spec, "").unwrap();
    let inertia = spacecraft.inertia();
    assert!((inertia - inertia.transpose()).amax() < f64::EPSILON);
    assert!((inertia.m12 - 0.100_000_000_05).abs() < 1e-15);
}

#[test]
fn an_axis_keeps_its_length_without_normalisation() {
    let mut spec = valid();
    spec.wheels[0].axis = [2.0, 0.0, 0.0];
    let unit = Spacecraft::try_new(&spec, "").unwrap();
    assert_eq!(unit.wheels()[0].axis, Vector3::x());
    spec.wheels[0].normalize_axis = false;
    let given = Spacecraft::try_new(&spec, "").unwrap();
    assert_eq!(given.wheels()[0].axis, Vector3::x() * 2.0);
    let difference = unit.effective_inertia() - given.effective_inertia();
    assert!((difference.m11 - 3.0 * 0.000_169).abs() < 1e-15);
}

#[test]
fn a_disabled_wheel_spans_no_axis_and_stays_in_the_inertia() {
    let mut spec = valid();
    let mut fourth = spec.wheels[2].clone();
    fourth.axis = [1.0, 1.0, 1.0];
    spec.wheels.push(fourth);
    spec.wheels[2].enabled = false;
    let spacecraft = Spacecraft::try_new(&spec, "").unwrap();
    let enabled: Vec<_> = spacecraft.enabled_wheels().map(|(i, _)| i).collect();
    assert_eq!(enabled, [0, 1, 3]);
    let expected = 9.63 - 0.000_169 / 3.0;
    assert!((spacecraft.effective_inertia().m33 - expected).abs() < 1e-14);
}
