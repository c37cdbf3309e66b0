//! `slewplan study`.

use crate::run::{fixture_json, slewplan_fed};
use serde_json::json;

#[test]
fn a_study_answers_for_every_pair() {
    let study = json!({
        "scenario": fixture_json("two-targets.json"),
        "simulation": {
            "controller": {"kind": "geometric_pid", "gains": {"kind": "bandwidth",
                "bandwidth_rad_s": 0.1, "integral_rad_s": 0.01}},
            "errors": {"inertia_3_sigma": 0.02},
            "runs": 5,
        },
        "authorities": [{"torque_authority": 0.9, "momentum_authority": 0.9}],
    });
    let answer = slewplan_fed(&["study", "authority", "-"], study.to_string().as_bytes());
    let answer = answer.expect_code(0).json();
    let row = &answer["rows"][0];
    assert_eq!(
        (&answer["complete"], &row["status"]),
        (&json!(true), &json!("flown"))
    );
    assert_eq!(
        (&row["flights"]["runs"], &row["reasons"]),
        (&json!(5), &json!([]))
    );
    let scenario = fixture_json("two-targets.json");
    let targets = scenario["targets"].as_array().expect("a list").len();
    assert_eq!(
        row["flights"]["passages"].as_array().map(Vec::len),
        Some(targets)
    );
}

#[test]
fn what_is_wrong_is_listed_with_its_place() {
    let study = json!({
        "scenario": fixture_json("two-targets.json"),
        "simulation": {"controller": {"kind": "quaternion"}, "wheels": 3},
        "authorities": [{"torque_authority": 0.9}],
    });
    let answer = slewplan_fed(&["study", "authority", "-"], study.to_string().as_bytes());
    let answer = answer.expect_code(2);
    for place in [
        "/simulation/controller/gains",
        "/simulation/wheels",
        "/authorities/0/momentum_authority",
    ] {
        assert!(answer.stderr.contains(place), "{answer:?}");
    }
}
