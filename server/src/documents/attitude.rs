//! The input forms of an attitude, as JSON.

use super::document::parse;
use super::reader::{Cursor, Sink};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::spec::{AttitudeSpec, BoresightChoice};

fn read_text(text: &str) -> (AttitudeSpec, Vec<Problem>) {
    let node = parse(text.as_bytes()).expect("JSON");
    let sink = Sink::default();
    let spec = AttitudeSpec::read(&Cursor::root(&node, &sink)).unwrap_or_default();
    (spec, sink.into_problems())
}

#[test]
fn every_form_is_read() {
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let cases = [
        (
            r#"{"quaternion": {"w": 4, "z": 3, "y": 2, "x": 1}}"#,
            AttitudeSpec::Quaternion([1.0, 2.0, 3.0, 4.0]),
        ),
        (
            r#"{"roll_pitch_yaw_deg": [15, 0, 10]}"#,
            AttitudeSpec::RollPitchYawDeg([15.0, 0.0, 10.0]),
        ),
        (
            r#"{"mrp": [0.1, 0, 0]}"#,
            AttitudeSpec::Mrp([0.1, 0.0, 0.0]),
        ),
        (
            r#"{"matrix": [[1,0,0],[0,1,0],[0,0,1]]}"#,
            AttitudeSpec::Matrix(identity),
        ),
        (
            r#"{"ra_dec_roll_deg": [1, 2, 3], "boresight": [0, 0, 1]}"#,
            AttitudeSpec::RaDecRollDeg {
                angles: [1.0, 2.0, 3.0],
                boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
            },
        ),
        (
            r#"{"ra_dec_roll_deg": [1, 2, 3], "boresight": "camera"}"#,
            AttitudeSpec::RaDecRollDeg {
                angles: [1.0, 2.0, 3.0],
                boresight: BoresightChoice::Name("camera".to_owned()),
            },
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(read_text(text), (expected, Vec::new()));
    }
}

#[test]
fn no_form_two_forms_and_a_stray_boresight_are_refused() {
    let cases = [
        ("{}", ""),
        (r#"{"mrp": [0,0,0], "roll_pitch_yaw_deg": [0,0,0]}"#, ""),
        (r#"{"mrp": [0,0,0], "boresight": [0,0,1]}"#, "/boresight"),
    ];
    for (text, pointer) in cases {
        let (_, problems) = read_text(text);
        assert_eq!(problems.len(), 1, "{text}");
        assert_eq!(
            (problems[0].code, &*problems[0].pointer),
            (Code::AttitudeForm, pointer)
        );
    }
}

#[test]
fn every_missing_component_is_named() {
    let (_, problems) = read_text(r#"{"quaternion": {"x": 0, "w": 1}}"#);
    let pointers: Vec<&str> = problems.iter().map(|p| &*p.pointer).collect();
    assert_eq!(pointers, ["/quaternion/y", "/quaternion/z"]);
}
