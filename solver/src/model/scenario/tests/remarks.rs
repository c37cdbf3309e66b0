//! Hints and warnings.

use super::*;

#[test]
fn the_hint_for_an_unknown_boresight_stays_short() {
    let mut spec = valid();
    spec.keep_out[0].boresight = "kamera".to_owned();
    let long = |number: usize| BoresightSpec {
        name: format!("{number}-{}", "ä".repeat(1000)),
        axis: [0.0, 0.0, 1.0],
    };
    spec.spacecraft.boresights = (0..100).map(long).collect();
    let problems = Scenario::try_new(&spec).unwrap_err();
    let hint = &problems[0].hint;
    assert!(
        hint.contains("\"0-ä") && hint.ends_with("or 90 others"),
        "{hint}"
    );
    assert!(hint.chars().count() < 1000, "{hint}");
    spec.spacecraft.boresights = (0..101).map(long).collect();
    let problems = Scenario::try_new(&spec).unwrap_err();
    assert_eq!(problems[0].pointer, "/spacecraft/boresights");
    assert_eq!(problems[0].code, Code::WrongLength);
}

#[test]
fn rounded_quaternions_warn_with_their_pointer() {
    let mut spec = valid();
    spec.targets[0].attitude = AttitudeSpec::Quaternion([0.13, 0.01137, 0.08641, 0.9877]);
    let warnings = Scenario::try_new(&spec).unwrap().warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].code, Code::AttitudeNormalized);
    assert_eq!(warnings[0].pointer, "/targets/0/attitude/quaternion");
}

#[test]
fn warnings_are_returned_with_the_problems() {
    let mut spec = valid();
    spec.targets[0].attitude = AttitudeSpec::Quaternion([0.13, 0.01137, 0.08641, 0.9877]);
    spec.options.alternatives = 1000;
    let faults = Scenario::examine(&spec).unwrap_err();
    assert_eq!(faults.problems.len(), 1);
    assert_eq!(faults.warnings.len(), 1);
    assert_eq!(faults.warnings[0].code, Code::AttitudeNormalized);
    assert_eq!(Scenario::try_new(&spec).unwrap_err(), faults.problems);
}

#[test]
fn attitudes_inside_a_cone_are_named_with_their_depth() {
    let mut spec = valid();
    // Target 1 looks along the cone's axis, 2 past it by 29 degrees, 3 by 31.
    for (index, pitch) in [(1, 90.0), (2, 61.0), (3, 59.0)] {
        spec.targets[index].attitude = AttitudeSpec::RollPitchYawDeg([0.0, pitch, 0.0]);
    }
    let warnings = Scenario::try_new(&spec).unwrap().warnings;
    let found: Vec<_> = warnings
        .iter()
        .map(|warning| (warning.code, warning.pointer.as_str()))
        .collect();
    assert_eq!(
        found,
        [
            (Code::AttitudeInKeepOut, "/targets/1"),
            (Code::AttitudeInKeepOut, "/targets/2")
        ]
    );
    let id = &spec.targets[2].id;
    let expected = format!(
        "target \"{id}\" points boresight 'camera' 1.000 degrees into the keep-out cone of 30 \
         degrees (/keep_out/0)"
    );
    assert_eq!(warnings[1].message, expected);
    spec.start.attitude = AttitudeSpec::RollPitchYawDeg([0.0, 90.0, 0.0]);
    let warnings = Scenario::try_new(&spec).unwrap().warnings;
    assert_eq!(warnings[0].pointer, "/start");
}
