//! `slewplan import`.

use crate::legs::past_a_bright_body;
use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};
use std::path::Path;

/// A file of legs with their motions.
fn file(scenario: &str, kind: &str) -> Value {
    let arguments = ["legs", scenario, "--kind", kind, "--trajectories"];
    slewplan(&arguments).expect_code(0).json()
}

/// Imports a file into a database, expecting an exit code; the answer.
fn import(file: &Value, database: &Path, code: i32) -> Value {
    let database = database.to_str().expect("UTF-8");
    let arguments = ["import", "-", "--database", database];
    slewplan_fed(&arguments, file.to_string().as_bytes())
        .expect_code(code)
        .json()
}

#[test]
fn a_plan_with_imported_legs_is_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = fixture("two-targets.json");
    let solve = |database: &Path| {
        let database = database.to_str().expect("UTF-8");
        slewplan(&["solve", &scenario, "--database", database])
            .expect_code(0)
            .json()
    };
    let mut cold = solve(&folder.path().join("cold.db"));
    let database = folder.path().join("warm.db");
    let mut imported = 0;
    for kind in ["rest_to_rest", "lower_bound"] {
        let file = file(&scenario, kind);
        let legs = file["trajectories"].as_array().expect("a list").len();
        let found = import(&file, &database, 0);
        let expected = [&found["imported"], &found["known"]].map(|n| n.as_u64().expect("a count"));
        // Legs between targets at rest are the same for both kinds.
        assert_eq!(expected[0] + expected[1], legs as u64, "{found}");
        assert_eq!(found["refused"], json!([]));
        imported += expected[0];
        let again = import(&file, &database, 0);
        assert_eq!(again["imported"], 0);
        assert_eq!(again["known"].as_u64(), Some(legs as u64));
    }
    assert!(imported >= 3, "{imported}");
    let mut warm = solve(&database);
    assert_eq!(cold["statistics"]["legs_from_cache"], 0);
    assert_eq!(warm["statistics"]["legs_solved"], 0);
    assert!(warm["statistics"]["legs_from_cache"].as_u64() > Some(0));
    for plan in [&mut cold, &mut warm] {
        plan["statistics"] = Value::Null;
    }
    assert_eq!(warm, cold);
}

#[test]
fn legs_around_cones_are_imported_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let tabulated = |applies, line: &[&str]| {
        let scenario = past_a_bright_body(applies).to_string();
        let line = [&["legs", "-", "--trajectories"], line].concat();
        slewplan_fed(&line, scenario.as_bytes())
            .expect_code(0)
            .json()
    };
    let count = |file: &Value| file["trajectories"].as_array().map(Vec::len);
    let file = tabulated("always", &[]);
    assert!(count(&file) > count(&tabulated("report", &[])));
    let found = import(&file, &database, 0);
    assert_eq!(found["refused"], json!([]));
    assert_eq!(found["imported"].as_u64(), count(&file).map(|n| n as u64));
    let database = database.to_str().expect("UTF-8");
    let again = tabulated("always", &["--database", database]);
    assert_eq!(again["trajectories"], file["trajectories"]);
}

#[test]
fn legs_that_fail_the_check_are_listed_and_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let mut file = file(&fixture("two-targets.json"), "rest_to_rest");
    let motions = file["trajectories"].as_array_mut().expect("a list");
    let count = motions.len();
    assert!(count >= 3);
    // One misses its end, another is not a leg of the scenario. Legs without rotation cannot miss
    // their end.
    let duration = |motion: &Value| -> f64 {
        let lengths = motion["lengths_s"].as_array().expect("a list");
        lengths.iter().filter_map(Value::as_f64).sum()
    };
    let missing = motions.iter().position(|motion| duration(motion) > 1.0);
    let missing = missing.expect("a leg that turns");
    let unknown = (missing + 1) % count;
    for length in motions[missing]["lengths_s"]
        .as_array_mut()
        .expect("a list")
    {
        *length = json!(1.001 * length.as_f64().expect("a number"));
    }
    motions[unknown]["key"] = json!("0".repeat(64));
    let found = import(&file, &database, 3);
    assert_eq!(found["imported"].as_u64(), Some(count as u64 - 2));
    let refused = found["refused"].as_array().expect("a list");
    assert_eq!(refused.len(), 2);
    let at = |pointer: String| {
        let mut problems = refused.iter();
        let found = problems.find(|problem| problem["pointer"] == pointer.as_str());
        found.unwrap_or_else(|| panic!("nothing at {pointer}: {refused:?}"))
    };
    let stranger = at(format!("/trajectories/{unknown}/key"));
    assert_eq!(stranger["code"], "unknown_reference");
    let missed = at(format!("/trajectories/{missing}"));
    assert_eq!(missed["code"], "leg_refused");
    let why = missed["message"].as_str().expect("a text");
    assert!(why.contains("the end is missed by"), "{why}");
}

#[test]
fn files_that_cannot_be_imported_are_refused_with_all_problems() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let database = database.to_str().expect("UTF-8");
    let refused = |file: &Value, problems: &[&str]| {
        let text = file.to_string();
        let told = slewplan_fed(&["import", "-", "--database", database], text.as_bytes());
        let told = told.expect_code(2);
        for problem in problems {
            assert!(told.stderr.contains(problem), "{problem}\n{}", told.stderr);
        }
        assert_eq!(told.stderr.matches("hint: ").count(), problems.len());
    };
    let plain = slewplan(&["legs", &fixture("two-targets.json"), "--kind", "certified"]);
    let mut plain = plain.expect_code(0).json();
    plain["version"] = json!("0.0.1");
    refused(
        &plain,
        &[
            "/version: ",
            "/kind: ",
            "/scenario: the table has no scenario [missing_field]",
            "/trajectories: the table has no trajectories [missing_field]",
        ],
    );
    let mut file = file(&fixture("two-targets.json"), "lower_bound");
    file["scenario"] = fixture_json("olivares-a.json");
    refused(&file, &["/scenario_key: "]);
    file["scenario"] = fixture_json("two-targets.json");
    file["trajectories"][1] = file["trajectories"][0].clone();
    refused(&file, &["/trajectories/1/key: "]);
    file["trajectories"][1] = json!({"key": "x", "lengths_s": [1, "2"]});
    refused(
        &file,
        &[
            "/trajectories/1/key: ",
            "/trajectories/1/solve_time_s: ",
            "/trajectories/1/lengths_s/1: ",
            "/trajectories/1/attitudes_xyzw: ",
            "/trajectories/1/wheel_momenta_nms: ",
        ],
    );
    assert!(!Path::new(database).exists());
}
