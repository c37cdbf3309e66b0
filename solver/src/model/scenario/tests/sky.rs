//! Targets on the sky.

use super::*;
use crate::model::spec::BoresightChoice;

fn pointed(angles: [f64; 3], boresight: BoresightChoice) -> AttitudeSpec {
    AttitudeSpec::RaDecRollDeg { angles, boresight }
}

fn named(name: &str) -> BoresightChoice {
    BoresightChoice::Name(name.to_owned())
}

/// The first target's attitude, with the boresight "camera" along an axis.
fn target(axis: [f64; 3], attitude: AttitudeSpec) -> Attitude {
    let mut spec = valid();
    spec.spacecraft.boresights[0].axis = axis;
    spec.targets[0].attitude = attitude;
    Scenario::try_new(&spec).unwrap().scenario.targets()[0].attitude
}

#[test]
fn a_boresight_may_be_named_wherever_there_is_an_attitude() {
    let axis = [3.0, -1.0, 0.5];
    let angles = [279.235, 38.784, 20.0];
    let by_name = target(axis, pointed(angles, named("camera")));
    let by_axis = target(axis, pointed(angles, BoresightChoice::Axis(axis)));
    assert_eq!(by_name, by_axis);
    let mut spec = valid();
    spec.start.attitude = pointed(angles, named("camera"));
    end(&mut spec).attitude = pointed(angles, named("camera"));
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    assert_eq!(
        Some(scenario.start().attitude),
        scenario.end().map(|end| end.attitude)
    );
}

#[test]
fn at_roll_zero_north_is_up_and_roll_is_clockwise() {
    // Towards (1, 0, 0) north is z and west is -y.
    let upright = target([1.0, 0.0, 0.0], pointed([0.0, 0.0, 0.0], named("camera")));
    assert!((upright.to_reference(Vector3::z()) - Vector3::z()).norm() < 1e-15);
    let rolled = target([1.0, 0.0, 0.0], pointed([0.0, 0.0, 90.0], named("camera")));
    assert!((rolled.to_reference(Vector3::z()) + Vector3::y()).norm() < 1e-15);
    let along_z = target([0.0, 0.0, 1.0], pointed([0.0, 0.0, 0.0], named("camera")));
    assert!((along_z.to_reference(Vector3::x()) - Vector3::z()).norm() < 1e-15);
}

#[test]
fn whole_turns_of_right_ascension_and_roll_change_nothing() {
    let once = target(
        [1.0, 0.0, 0.0],
        pointed([310.4, 45.0, 10.0], named("camera")),
    );
    let again = target(
        [1.0, 0.0, 0.0],
        pointed([-49.6, 45.0, 370.0], named("camera")),
    );
    assert!(once.turn_to(&again).xyzw()[3].abs() > 1.0 - 1e-15);
}

#[test]
fn declinations_beyond_the_poles_and_unknown_names_are_refused() {
    expect_faults(&[
        (
            |s| s.targets[1].attitude = pointed([10.0, 90.5, 0.0], named("camera")),
            Code::OutOfRange,
            "/targets/1/attitude/ra_dec_roll_deg/1",
        ),
        (
            |s| s.start.attitude = pointed([10.0, -120.0, 0.0], named("camera")),
            Code::OutOfRange,
            "/start/attitude/ra_dec_roll_deg/1",
        ),
        (
            |s| s.targets[1].attitude = pointed([10.0, 90.0, 0.0], named("telescope")),
            Code::UnknownReference,
            "/targets/1/attitude/boresight",
        ),
        (
            |s| {
                s.spacecraft.boresights[0].axis = [0.0; 3];
                s.keep_out.clear();
                s.targets[1].attitude = pointed([10.0, 20.0, 0.0], named("camera"));
            },
            Code::ZeroDirection,
            "/spacecraft/boresights/0/axis",
        ),
    ]);
    let mut spec = valid();
    spec.targets[0].attitude = pointed([10.0, 20.0, 0.0], named("camrea"));
    let problems = Scenario::try_new(&spec).unwrap_err();
    let hint = &problems[0].hint;
    assert!(hint.contains("did you mean \"camera\"?"), "{hint}");
}
