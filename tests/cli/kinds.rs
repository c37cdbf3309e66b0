//! The wrong kind of document, and texts that are not JSON.

use crate::run::{Ended, fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::json;

/// A file with this text, and its path.
fn file(name: &str, text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    let path = path.to_str().expect("a path").to_owned();
    (folder, path)
}

/// The refusal has one problem, in these words, and the file's name.
#[track_caller]
fn expect_told(ended: Ended, name: &str, code: &str, words: &str) {
    let ended = ended.expect_code(2);
    let told = format!("{}{}", ended.stdout, ended.stderr);
    assert!(told.contains(name), "{told}");
    assert_eq!(told.matches("hint: ").count(), 1, "{told}");
    assert!(told.contains(&format!("[{code}]")), "{told}");
    assert!(told.contains(words), "{told}");
}

#[test]
fn a_plan_is_no_scenario() {
    let plan = slewplan(&["solve", &fixture("quarter-turn.json")]).expect_code(0);
    let (_folder, path) = file("my-plan.json", &plan.stdout);
    for line in [
        &["solve", &path][..],
        &["validate", &path],
        &["legs", &path],
        &["verify", &path, &path],
    ] {
        let words = "this is a plan, not a scenario";
        expect_told(slewplan(line), "my-plan.json", "wrong_document", words);
    }
}

#[test]
fn a_scenario_is_no_plan() {
    let path = fixture("quarter-turn.json");
    for line in [
        &["verify", &path, &path][..],
        &["certify", &path, &path],
        &["export", &path, &path, "--format", "csv"],
        &["plot", &path],
    ] {
        let words = "this is a scenario, not a plan";
        expect_told(slewplan(line), "quarter-turn.json", "wrong_document", words);
    }
}

#[test]
fn a_drawing_that_fails_names_the_file() {
    let (_folder, path) = file("odd.json", "{\"total_time_s\": 1}");
    let told = slewplan(&["plot", &path]).expect_code(2).stderr;
    assert!(told.contains("odd.json"), "{told}");
}

#[test]
fn yaml_and_comments_are_recognised() {
    let (_folder, yaml) = file("scenario.yaml", "name: a\nspacecraft:\n  wheels: []\n");
    let commented = format!("// a tour\n{}", fixture_json("quarter-turn.json"));
    let (_other, commented) = file("commented.json", &commented);
    for command in ["solve", "validate", "legs", "plot"] {
        let told = slewplan(&[command, &yaml]);
        expect_told(told, "scenario.yaml", "malformed_json", "looks like YAML");
        let told = slewplan(&[command, &commented]);
        expect_told(told, "commented.json", "malformed_json", "a comment");
    }
}

#[test]
fn an_inertia_of_three_numbers_gets_its_matrix_as_a_hint() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["spacecraft"]["inertia_kg_m2"] = json!([6.5, 8, 9.25]);
    let ended = slewplan_fed(&["solve", "-"], scenario.to_string().as_bytes());
    let matrix = "[[6.5, 0, 0], [0, 8, 0], [0, 0, 9.25]]";
    expect_told(ended, "/spacecraft/inertia_kg_m2: ", "wrong_type", matrix);
    scenario["spacecraft"]["inertia_kg_m2"] = json!([6.5, 0, 0, 0, 8, 0, 0, 0, 9]);
    let ended = slewplan_fed(&["solve", "-"], scenario.to_string().as_bytes());
    expect_told(
        ended,
        "/spacecraft/inertia_kg_m2: ",
        "wrong_type",
        "such as [[6.6, 0, 0]",
    );
}
