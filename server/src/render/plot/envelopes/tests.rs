//! Contents of the SVG of a study of envelopes.

use super::{WrittenEnvelopes, svg};
use crate::documents::study::envelopes::{self, EnvelopeAnswerDocument};
use crate::render::plot::DrawableDocument;
use serde_json::Value;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;

fn answer(rest: &str) -> Vec<u8> {
    let wheel = |axis: &str| {
        format!(
            r#"{{"axis": [{axis}], "inertia_kg_m2": 0.01, "max_torque_nm": 0.1, "max_speed_rad_s": 100}}"#
        )
    };
    let wheels = ["0.8, 0, 0.6", "0, 0.8, 0.6", "-0.8, 0, 0.6", "0, -0.8, 0.6"];
    let wheels = wheels.map(wheel).join(", ");
    let text = format!(
        r#"{{"spacecraft": {{"inertia_kg_m2": [[25, 0, 0], [0, 25, 0], [0, 0, 25]],
            "wheels": [{wheels}]}}{rest}}}"#
    );
    let request = envelopes::read(text.as_bytes()).unwrap();
    let pool = SolverPool::new(None).unwrap();
    let report = request.study.conduct(&pool, &StopSignal::new());
    serde_json::to_vec(&EnvelopeAnswerDocument::new(&request, &report)).unwrap()
}

const TURN: &str = r#", "turns": [{"from": {"roll_pitch_yaw_deg": [0, 0, 0]},
    "to": {"roll_pitch_yaw_deg": [0, 0, 90]}}], "time_optimal": true"#;

#[test]
fn both_quantities_are_drawn_with_their_slews() {
    let document = answer(TURN);
    assert!(matches!(
        DrawableDocument::read(&document),
        Ok(DrawableDocument::Envelopes(_))
    ));
    let study = WrittenEnvelopes::read(&document).unwrap();
    let picture = svg(&study, 0).unwrap();
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"));
    for words in [
        "Momentum, N m s",
        "Torque, N m",
        "fastest, pseudo-inverse",
        "eigenaxis, full envelope",
        "Torque, share of the pseudo-inverse envelope",
        "limit 1",
    ] {
        assert!(picture.contains(&format!(">{words}</text>")), "{words}");
    }
    assert!(picture.contains("90.0 degrees about (0.000, 0.000, 1.000)"));
    assert!(!picture.contains("NaN") && !picture.contains("inf\""));
    assert!(svg(&study, 1).unwrap_err().contains("no turn 1"));
}

#[test]
fn without_turns_and_momentum_there_are_envelopes_of_torque() {
    let document = answer("");
    let mut document: Value = serde_json::from_slice(&document).unwrap();
    document["momentum"] = Value::Null;
    let study = WrittenEnvelopes::read(document.to_string().as_bytes()).unwrap();
    let picture = svg(&study, 0).unwrap();
    assert!(picture.contains("Torque, N m") && !picture.contains("Momentum"));
    assert!(!picture.contains("share of"));
}

#[test]
fn documents_that_cannot_be_drawn_are_refused() {
    let document: Value = serde_json::from_slice(&answer("")).unwrap();
    let refused = |document: &Value| WrittenEnvelopes::read(document.to_string().as_bytes());
    let mut far = document.clone();
    far["torque"]["full"]["facets"][0]["vertices"][0] = 1000.into();
    assert!(refused(&far).unwrap_err().contains("corners"));
    let mut empty = document;
    empty["torque"]["pseudo_inverse"]["facets"] = Value::Array(Vec::new());
    assert!(refused(&empty).unwrap_err().contains("facets"));
}
