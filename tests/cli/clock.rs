//! Windows, values and the latest end: what is refused, what a plan says, and what is made of it.

use crate::refusals::expect_refused;
use crate::run::{fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// The two-target fixture with an epoch and the windows of its first target.
fn with_windows(windows: &Value) -> Value {
    let mut scenario = fixture_json("two-targets.json");
    scenario["epoch"] = json!("2026-01-01T00:00:00Z");
    scenario["targets"][0]["windows"] = windows.clone();
    scenario
}

fn refused(scenario: &Value, expected: &[(&str, &str)]) {
    expect_refused(scenario.to_string().as_bytes(), expected);
}

#[test]
fn the_campaign_of_two_hundred_stars_is_valid() {
    let campaign = fixture_json("campaign/campaign.json");
    assert_eq!(campaign["targets"].as_array().map(Vec::len), Some(200));
    slewplan_fed(&["validate", "-"], campaign.to_string().as_bytes()).expect_code(0);
}

#[test]
fn windows_that_are_none_are_refused_where_they_stand() {
    let at = |rest: &str| format!("/targets/0/windows{rest}");
    let cases = [
        (json!({"from_s": 60, "to_s": 30}), "/0", "empty_range"),
        (json!({"from_s": 60, "to_s": 60}), "/0", "empty_range"),
        (json!({"from_s": 60}), "/0", "missing_field"),
        (
            json!({"from_s": 0, "from": "2026-01-01T00:00:00Z", "to_s": 30}),
            "/0",
            "conflicting_fields",
        ),
        (
            json!({"from_s": 0, "to": "tomorrow"}),
            "/0/to",
            "invalid_epoch",
        ),
        (
            json!({"from_s": 0, "to": "2026-02-29T00:00:00Z"}),
            "/0/to",
            "invalid_epoch",
        ),
        (
            json!({"from_s": 0, "to_s": 1e308}),
            "/0/to_s",
            "out_of_range",
        ),
        (
            json!({"from_s": -1e12, "to_s": 9}),
            "/0/from_s",
            "out_of_range",
        ),
        (json!({"from_s": "0", "to_s": 9}), "/0/from_s", "wrong_type"),
        (
            json!({"from_s": 0, "to_s": 9, "until": 3}),
            "/0/until",
            "unknown_field",
        ),
    ];
    for (window, pointer, code) in cases {
        let scenario = with_windows(&json!([window]));
        refused(&scenario, &[(&at(pointer), code)]);
    }
    refused(&with_windows(&json!({})), &[(&at(""), "wrong_type")]);
    let overlapping =
        json!([{"from_s": 50, "to_s": 90}, {"from_s": 0, "to": "2026-01-01T00:00:51Z"}]);
    refused(
        &with_windows(&overlapping),
        &[(&at("/1"), "windows_overlap")],
    );
    let touching = json!([{"from_s": 50, "to_s": 90}, {"from_s": 0, "to_s": 50}]);
    let valid = with_windows(&touching).to_string();
    slewplan_fed(&["validate", "-"], valid.as_bytes()).expect_code(0);
}

#[test]
fn dates_of_windows_need_an_epoch() {
    let dated = json!([{"from": "2026-01-01T00:01:00Z", "to": "2026-01-01T00:02:00Z"}]);
    let mut scenario = with_windows(&dated);
    scenario["epoch"] = json!(null);
    let ends = [
        ("/targets/0/windows/0/from", "epoch_required"),
        ("/targets/0/windows/0/to", "epoch_required"),
    ];
    refused(&scenario, &ends);
    // An epoch that cannot be read is the only fault.
    scenario["epoch"] = json!("soon");
    refused(&scenario, &[("/epoch", "invalid_epoch")]);
}

#[test]
fn values_and_the_latest_end_are_numbers_above_zero() {
    let mut scenario = fixture_json("two-targets.json");
    for wrong in [json!(0), json!(-1), json!(1e308)] {
        scenario["targets"][1]["value"] = wrong.clone();
        refused(&scenario, &[("/targets/1/value", "out_of_range")]);
        scenario["targets"][1]["value"] = json!(null);
        scenario["latest_end_s"] = wrong;
        refused(&scenario, &[("/latest_end_s", "out_of_range")]);
        scenario["latest_end_s"] = json!(null);
    }
    scenario["targets"][1]["value"] = json!("high");
    refused(&scenario, &[("/targets/1/value", "wrong_type")]);
    let text = scenario.to_string().replace("\"high\"", "NaN");
    expect_refused(text.as_bytes(), &[("", "malformed_json")]);
}

#[test]
fn all_problems_of_the_clock_are_found_at_once() {
    let mut scenario = with_windows(
        &json!([{"from_s": 60, "to_s": 30}, {"from_s": 0}, {"to_s": 1e99, "from_s": 0}]),
    );
    scenario["targets"][1]["windows"] =
        json!([{"from_s": 0, "to_s": 60}, {"from_s": 10, "to_s": 20}]);
    scenario["targets"][1]["value"] = json!(-2);
    scenario["latest_end_s"] = json!(-5);
    let expected = [
        ("/latest_end_s", "out_of_range"),
        ("/targets/0/windows/0", "empty_range"),
        ("/targets/0/windows/1", "missing_field"),
        ("/targets/0/windows/2/to_s", "out_of_range"),
        ("/targets/1/value", "out_of_range"),
        ("/targets/1/windows/1", "windows_overlap"),
    ];
    refused(&scenario, &expected);
}

/// Rests at four targets: "a" is required and waits for its window, "c" cannot be reached in its own.
fn schedule() -> Value {
    let mut scenario = fixture_json("two-targets.json");
    scenario["epoch"] = json!("2026-01-01T00:00:00Z");
    scenario["targets"] = json!([
        {"id": "a", "attitude": {"roll_pitch_yaw_deg": [15, 0, 10]}, "dwell_s": 10,
         "windows": [{"from": "2026-01-01T00:03:20Z", "to": "2026-01-01T00:04:00Z"}]},
        {"id": "b", "attitude": {"roll_pitch_yaw_deg": [25, 0, 50]}, "dwell_s": 5, "value": 2},
        {"id": "c", "attitude": {"roll_pitch_yaw_deg": [0, 0, 90]}, "windows": [{"from_s": 0, "to_s": 3}], "value": 1}
    ]);
    scenario["latest_end_s"] = json!(400);
    scenario
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn a_plan_keeps_the_clock_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scenario.json");
    std::fs::write(&path, schedule().to_string()).expect("written");
    let path = path.to_str().expect("UTF-8");
    let solved = slewplan(&["solve", path, "--summary"]).expect_code(0);
    assert!(solved.stdout.contains("value 2, "), "{}", solved.stdout);
    assert!(
        solved.stdout.contains("c: window_unreachable"),
        "{}",
        solved.stdout
    );
    let plan = slewplan(&["solve", path]).expect_code(0).json();
    assert_eq!(
        (&plan["status"], &plan["objective"]),
        (&json!("optimal"), &json!("value_then_time"))
    );
    assert_eq!(
        (number(&plan["value"]), number(&plan["value_bound"])),
        (2.0, 2.0)
    );
    assert_eq!(plan["skipped"][0]["target"], "c");
    let passages = plan["passages"].as_array().expect("a list");
    let visit = passages
        .iter()
        .find(|it| it["target"] == "a")
        .expect("visited");
    assert!(
        number(&visit["time_s"]) >= 200.0 - 1e-6 && number(&visit["departure_s"]) <= 240.0 + 1e-6
    );
    assert!(
        !plan["waits"].as_array().expect("a list").is_empty(),
        "{plan:#}"
    );

    let verify = |plan: &Value| slewplan_fed(&["verify", path, "-"], plan.to_string().as_bytes());
    verify(&plan).expect_code(0);
    let damaged = |pointer: &str, value: Value, words: &str| {
        let mut other = plan.clone();
        *other.pointer_mut(pointer).expect("is there") = value;
        let told = verify(&other).expect_code(3).stdout;
        assert!(told.contains(words), "no {words:?} in {told}");
    };
    damaged("/value", json!(3), "claims a value of 3");
    damaged("/skipped/0/target", json!("b"), "left out and visited");
    damaged("/skipped", json!([]), "neither visited nor left out");
    damaged("/waits/0/to_s", json!(-1), "no span of time");

    let drawn = slewplan_fed(
        &["plot", "-", "--scenario", path],
        plan.to_string().as_bytes(),
    );
    let drawn = drawn.expect_code(0).stdout;
    for words in ["Left out: 1", "c (window unreachable)", "UTC", "00:02"] {
        assert!(drawn.contains(words), "no {words:?} in the picture");
    }
}

#[test]
fn plans_without_a_clock_say_nothing_about_it() {
    let scenario = fixture_json("two-targets.json").to_string();
    let plan = slewplan_fed(&["solve", "-"], scenario.as_bytes())
        .expect_code(0)
        .json();
    for name in ["objective", "value", "value_bound", "skipped", "waits"] {
        assert!(plan.get(name).is_none(), "{name}");
    }
}

#[test]
fn targets_that_exclude_each_other_are_named() {
    let mut scenario = schedule();
    let window = json!([{"from_s": 100, "to_s": 112}]);
    scenario["targets"][0]["windows"] = window.clone();
    scenario["targets"][1]["windows"] = window;
    scenario["targets"][1]["value"] = json!(null);
    let plan = slewplan_fed(&["solve", "-"], scenario.to_string().as_bytes())
        .expect_code(3)
        .json();
    assert_eq!(plan["status"], "infeasible");
    let told = plan["reasons"].to_string();
    assert!(
        told.contains("\\\"a\\\"") && told.contains("\\\"b\\\""),
        "{told}"
    );
}
