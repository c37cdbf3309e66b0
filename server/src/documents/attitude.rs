//! The input forms of an attitude.

use super::reader::{Cursor, Fields};
use slewplan_solver::model::problem::Code;
use slewplan_solver::model::spec::AttitudeSpec;

const FORMS: [&str; 5] = [
    "quaternion",
    "roll_pitch_yaw_deg",
    "mrp",
    "matrix",
    "ra_dec_roll_deg",
];
const FORM_HINT: &str = "give exactly one of quaternion, roll_pitch_yaw_deg, mrp, matrix, or \
                         ra_dec_roll_deg together with boresight";

/// Reads an attitude; the identity stands in where it cannot be read.
pub(crate) fn read(cursor: &Cursor<'_>) -> AttitudeSpec {
    try_read(cursor).unwrap_or_default()
}

fn try_read(cursor: &Cursor<'_>) -> Option<AttitudeSpec> {
    let fields = cursor.object(&[
        "quaternion",
        "roll_pitch_yaw_deg",
        "mrp",
        "matrix",
        "ra_dec_roll_deg",
        "boresight",
    ])?;
    let given: Vec<&str> = FORMS
        .into_iter()
        .filter(|form| fields.raw(form).is_some())
        .collect();
    let [form] = given[..] else {
        let message = if given.is_empty() {
            "the attitude is given in no form".to_owned()
        } else {
            format!(
                "the attitude is given in {} forms: {}",
                given.len(),
                given.join(", ")
            )
        };
        cursor.report(Code::AttitudeForm, message, FORM_HINT);
        return None;
    };
    if form != "ra_dec_roll_deg"
        && let Some(boresight) = fields.raw("boresight")
    {
        boresight.report(
            Code::AttitudeForm,
            format!("boresight has no meaning beside {form}"),
            "remove boresight, or give the attitude as ra_dec_roll_deg",
        );
    }
    read_form(&fields, form)
}

fn read_form(fields: &Fields<'_>, form: &str) -> Option<AttitudeSpec> {
    let value = fields.raw(form)?;
    match form {
        "quaternion" => quaternion(&value).map(AttitudeSpec::Quaternion),
        "roll_pitch_yaw_deg" => value.numbers().map(AttitudeSpec::RollPitchYawDeg),
        "mrp" => value.numbers().map(AttitudeSpec::Mrp),
        "matrix" => value.matrix().map(AttitudeSpec::Matrix),
        _ => {
            let angles = value.numbers();
            let boresight = fields.required("boresight").and_then(|axis| axis.numbers());
            Some(AttitudeSpec::RaDecRollDeg {
                angles: angles?,
                boresight: boresight?,
            })
        }
    }
}

fn quaternion(cursor: &Cursor<'_>) -> Option<[f64; 4]> {
    let fields = cursor.object(&["x", "y", "z", "w"])?;
    let [x, y, z, w] = ["x", "y", "z", "w"].map(|name| {
        fields
            .required(name)
            .and_then(|component| component.number())
    });
    Some([x?, y?, z?, w?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;
    use crate::documents::reader::Sink;
    use slewplan_solver::model::problem::Problem;

    fn read_text(text: &str) -> (AttitudeSpec, Vec<Problem>) {
        let node = parse(text.as_bytes()).unwrap();
        let sink = Sink::default();
        let spec = read(&Cursor::root(&node, &sink));
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
                    boresight: [0.0, 0.0, 1.0],
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
}
