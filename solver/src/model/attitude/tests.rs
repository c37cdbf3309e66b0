use super::*;
use crate::model::problem::{Code, Problem};
use crate::model::spec::{AttitudeEquivalence, AttitudeSpec, BoresightChoice};
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

fn read(spec: &AttitudeSpec) -> Result<(Attitude, Vec<Problem>), Vec<Problem>> {
    Attitude::try_new(spec, AttitudeEquivalence::Rotation, "/attitude")
}

fn attitude(spec: &AttitudeSpec) -> Attitude {
    let (attitude, warnings) = read(spec).expect("valid");
    assert_eq!(warnings, []);
    attitude
}

/// Largest difference of components: zero only if the signs agree.
fn distance(a: &Attitude, b: &Attitude) -> f64 {
    a.xyzw()
        .iter()
        .zip(b.xyzw())
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn rows(attitude: &Attitude) -> AttitudeSpec {
    let m = attitude.matrix();
    AttitudeSpec::Matrix([0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)])))
}

#[test]
fn roll_pitch_yaw_keeps_the_sign_of_the_half_angle_product() {
    let table = [
        ([15.0, 0.0, 10.0], [0.13002, 0.01137, 0.08641, 0.98767]),
        ([15.0, 0.0, 250.0], [-0.07486, 0.10692, 0.81214, -0.56866]),
    ];
    for (angles, expected) in table {
        let read = attitude(&AttitudeSpec::RollPitchYawDeg(angles));
        let expected = Attitude::from_xyzw(expected).unwrap();
        assert!(distance(&read, &expected) < 1e-5, "{angles:?}: {read:?}");
    }
    let turned = attitude(&AttitudeSpec::RollPitchYawDeg([15.0, 0.0, 370.0]));
    let same = attitude(&AttitudeSpec::RollPitchYawDeg([15.0, 0.0, 10.0]));
    assert!(distance(&turned, &same.negated()) < 1e-15);
}

#[test]
fn a_frame_turned_about_z_sees_the_reference_x_axis_along_its_minus_y() {
    // The worked example of CCSDS 504.0-B, annex F.
    let q = attitude(&AttitudeSpec::Quaternion([
        0.0,
        0.0,
        FRAC_1_SQRT_2,
        FRAC_1_SQRT_2,
    ]));
    assert!((q.to_body(Vector3::x()) + Vector3::y()).norm() < 1e-15);
    assert!((q.to_reference(Vector3::x()) - Vector3::y()).norm() < 1e-15);
}

#[test]
fn the_columns_of_the_matrix_are_the_body_axes() {
    let quarter = AttitudeSpec::Matrix([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let expected = Attitude::from_rotation_vector(Vector3::z() * (0.5 * PI));
    assert!(distance(&attitude(&quarter), &expected) < 1e-15);
}

#[test]
fn a_printed_matrix_is_projected_with_a_warning() {
    let printed = AttitudeSpec::Matrix([
        [0.8627, 0.4981, -0.0872],
        [-0.5, 0.8660, 0.0],
        [0.0755, 0.0436, 0.9962],
    ]);
    let (read, warnings) = read(&printed).unwrap();
    assert_eq!(warnings[0].code, Code::AttitudeNormalized);
    assert_eq!(warnings[0].pointer, "/attitude/matrix");
    let expected = attitude(&AttitudeSpec::RollPitchYawDeg([2.506, -4.33, -30.094]));
    assert!(
        read.angle_to(&expected) < 1e-3,
        "{}",
        read.angle_to(&expected)
    );
}

#[test]
fn right_ascension_declination_and_roll_follow_the_stated_convention() {
    let along_x = AttitudeSpec::RaDecRollDeg {
        angles: [40.0, 30.0, 20.0],
        boresight: BoresightChoice::Axis([2.0, 0.0, 0.0]),
    };
    let same = attitude(&AttitudeSpec::RollPitchYawDeg([20.0, -30.0, 40.0]));
    assert!(distance(&attitude(&along_x), &same) < 1e-15);

    let pole = attitude(&AttitudeSpec::RaDecRollDeg {
        angles: [0.0, 90.0, 0.0],
        boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
    });
    assert!((pole.to_reference(Vector3::z()) - Vector3::z()).norm() < 1e-15);
    assert!((pole.to_reference(Vector3::x()) + Vector3::x()).norm() < 1e-15);

    let oblique = Vector3::new(1.0, -2.0, 0.5);
    let pointed = attitude(&AttitudeSpec::RaDecRollDeg {
        angles: [200.0, -35.0, 77.0],
        boresight: BoresightChoice::Axis(oblique.into()),
    });
    let (ra, dec) = (200.0_f64.to_radians(), -35.0_f64.to_radians());
    let direction = Vector3::new(dec.cos() * ra.cos(), dec.cos() * ra.sin(), dec.sin());
    assert!((pointed.to_reference(oblique.normalize()) - direction).norm() < 1e-15);
}

#[test]
fn small_deviations_of_the_norm_warn_and_large_ones_are_refused() {
    let scaled = |scale: f64| AttitudeSpec::Quaternion([0.6 * scale, 0.0, 0.0, 0.8 * scale]);
    assert_eq!(read(&scaled(1.0 + 1e-7)).unwrap().1, []);
    let (read_back, warnings) = read(&scaled(1.0 - 1e-4)).unwrap();
    assert_eq!(warnings[0].code, Code::AttitudeNormalized);
    assert!(distance(&read_back, &attitude(&scaled(1.0))) < 1e-15);
    let problems = read(&scaled(1.01)).unwrap_err();
    assert_eq!(problems[0].code, Code::QuaternionNorm);
    assert!(
        problems[0].message.contains("1.01"),
        "{}",
        problems[0].message
    );
}

#[test]
fn impossible_forms_are_refused_at_the_offending_value() {
    let zero = [0.0; 3];
    let mirror = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
    let sheared = [[1.0, 0.01, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let angles = [0.0, f64::INFINITY, 0.0];
    let table = [
        (
            AttitudeSpec::Quaternion([0.0; 4]),
            Code::QuaternionNorm,
            "/quaternion",
        ),
        (
            AttitudeSpec::Quaternion([1e200; 4]),
            Code::QuaternionNorm,
            "/quaternion",
        ),
        (
            AttitudeSpec::Quaternion([0.0, f64::NAN, 0.0, 1.0]),
            Code::NotFinite,
            "/quaternion/y",
        ),
        (
            AttitudeSpec::RollPitchYawDeg(angles),
            Code::NotFinite,
            "/roll_pitch_yaw_deg/1",
        ),
        (
            AttitudeSpec::Mrp([f64::NAN, 0.0, 0.0]),
            Code::NotFinite,
            "/mrp/0",
        ),
        (
            AttitudeSpec::Mrp([1e200, 0.0, 0.0]),
            Code::OutOfRange,
            "/mrp",
        ),
        (
            AttitudeSpec::Matrix(mirror),
            Code::MatrixNotRotation,
            "/matrix",
        ),
        (
            AttitudeSpec::Matrix(sheared),
            Code::MatrixNotRotation,
            "/matrix",
        ),
        (
            AttitudeSpec::Matrix([[1e200; 3]; 3]),
            Code::MatrixNotRotation,
            "/matrix",
        ),
        (
            AttitudeSpec::Matrix([angles, zero, zero]),
            Code::NotFinite,
            "/matrix/0/1",
        ),
        (
            AttitudeSpec::RaDecRollDeg {
                angles: zero,
                boresight: BoresightChoice::Axis(zero),
            },
            Code::ZeroDirection,
            "/boresight",
        ),
        (
            AttitudeSpec::RaDecRollDeg {
                angles,
                boresight: BoresightChoice::Axis([1.0, 0.0, 0.0]),
            },
            Code::NotFinite,
            "/ra_dec_roll_deg/1",
        ),
    ];
    for (spec, code, pointer) in table {
        let problems = read(&spec).expect_err("refused");
        assert_eq!(problems.len(), 1, "{problems:?}");
        assert_eq!(problems[0].code, code, "{spec:?}");
        assert_eq!(problems[0].pointer, format!("/attitude{pointer}"));
    }
}

#[test]
fn forms_without_a_sign_are_refused_where_the_sign_matters() {
    let pointing = AttitudeSpec::RaDecRollDeg {
        angles: [0.0; 3],
        boresight: BoresightChoice::Axis([1.0, 0.0, 0.0]),
    };
    let unsigned = [
        (rows(&Attitude::identity()), "/matrix"),
        (pointing, "/ra_dec_roll_deg"),
    ];
    for (spec, pointer) in unsigned {
        let problems = Attitude::try_new(&spec, AttitudeEquivalence::Quaternion, "").unwrap_err();
        assert_eq!(problems[0].code, Code::SignUndefined);
        assert_eq!(problems[0].pointer, pointer);
        attitude(&spec);
    }
    let signed = [
        AttitudeSpec::Quaternion([0.0, 0.0, 0.0, -1.0]),
        AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 360.0]),
        AttitudeSpec::Mrp([3.0, 0.0, 0.0]),
    ];
    for spec in signed {
        let (read, _) = Attitude::try_new(&spec, AttitudeEquivalence::Quaternion, "").unwrap();
        assert!(read.xyzw()[3] < 0.0, "{spec:?}");
    }
}

#[test]
fn opposite_quaternions_are_one_attitude_and_a_full_turn_apart() {
    let q = Attitude::from_rotation_vector(Vector3::new(0.3, -1.0, 0.2));
    assert!(q.angle_to(&q.negated()) < 1e-15);
    assert!((q.signed_turn_to(&q.negated()).norm() - TAU).abs() < 1e-15);
}

prop_compose! {
    fn any_attitude()(xyzw in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_filter("too short to have a direction", |c| c.iter().map(|c| c * c).sum::<f64>() > 0.01)
    ) -> Attitude {
        Attitude::from_xyzw(xyzw).expect("not zero")
    }
}

proptest! {
    #[test]
    fn retracting_by_the_signed_turn_arrives_with_the_right_sign(
        from in any_attitude(),
        to in any_attitude(),
    ) {
        let turn = from.signed_turn_to(&to);
        prop_assert!(turn.norm() <= TAU);
        prop_assert!(distance(&from.retract(turn), &to) < 1e-14);
        prop_assert!((from.angle_to(&to) - turn.norm().min(TAU - turn.norm())).abs() < 1e-14);
    }

    #[test]
    fn the_signed_turn_recovers_a_rotation_vector(
        from in any_attitude(),
        direction in any_attitude(),
        angle in 1e-6..(TAU - 1e-6),
    ) {
        let vector = direction.to_reference(Vector3::x()) * angle;
        let turn = from.signed_turn_to(&from.retract(vector));
        // Near a full turn the axis is inaccurate: the vector part is short.
        prop_assert!((turn - vector).norm() < 1e-14 / (0.5 * angle).sin());
    }

    #[test]
    fn modified_rodrigues_parameters_keep_the_quaternion(q in any_attitude()) {
        let [x, y, z, w] = q.xyzw();
        prop_assume!(1.0 + w > 1e-3);
        let s = [x, y, z].map(|v| v / (1.0 + w));
        prop_assert!(distance(&attitude(&AttitudeSpec::Mrp(s)), &q) < 1e-12);
    }

    #[test]
    fn a_matrix_keeps_the_attitude_but_not_the_sign(q in any_attitude()) {
        let read = attitude(&rows(&q));
        prop_assert!(read.angle_to(&q) < 1e-14);
        prop_assert!(read.xyzw()[3] >= 0.0);
    }

    #[test]
    fn roll_pitch_yaw_is_yaw_then_pitch_then_roll(
        angles in [-400.0..400.0_f64, -400.0..400.0, -400.0..400.0],
    ) {
        let [roll, pitch, yaw] = angles.map(f64::to_radians);
        // The rotation vector of each turn covers the sphere twice, as the half angles do.
        let steps = [Vector3::z() * yaw, Vector3::y() * pitch, Vector3::x() * roll];
        let expected = steps.into_iter().fold(Attitude::identity(), |q, step| q.retract(step));
        prop_assert!(distance(&attitude(&AttitudeSpec::RollPitchYawDeg(angles)), &expected) < 1e-14);
    }
}

#[test]
fn quaternions_of_opposite_sign_are_not_equal() {
    let attitude = Attitude::from_rotation_vector(Vector3::new(0.3, -0.2, 0.1));
    assert_ne!(attitude, attitude.negated());
    assert_eq!(attitude, attitude.negated().negated());
    assert_eq!(attitude.negated().nearest_sign(&attitude), attitude);
}
