//! Text for people: summaries of commands whose answer is JSON for programs.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// Asserts that a text has parts, and nothing that only a program likes.
fn assert_text(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
    for ugly in ["0.0e0", "-0.0 %", "\"", "{", "NaN"] {
        assert!(!text.contains(ugly), "{ugly:?} is in\n{text}");
    }
    for word in text.split_whitespace().collect::<Vec<_>>().windows(2) {
        let plural = [
            "legs", "nodes", "NLPs", "slews", "targets", "threads", "starts",
        ];
        let is_wrong = word[0] == "1" && plural.contains(&word[1].trim_end_matches(','));
        assert!(!is_wrong, "{word:?} in\n{text}");
    }
}

#[test]
fn a_plan_has_columns_for_settle_and_dwell() {
    let path = fixture("two-targets.json");
    let text = slewplan(&["solve", &path, "--summary"])
        .expect_code(0)
        .stdout;
    assert_text(
        &text,
        &["settle [s]", "dwell [s]", "1.000", "2.000", "margins"],
    );
    let none = slewplan(&["solve", &fixture("olivares-a.json"), "--summary"]);
    assert!(!none.expect_code(0).stdout.contains("dwell [s]"));
}

#[test]
fn a_slew_and_a_sweep_have_summaries() {
    let quarter = fixture("slews/quarter-turn.json");
    let text = slewplan(&["slew", &quarter, "--summary"])
        .expect_code(0)
        .stdout;
    assert_text(
        &text,
        &[
            "solved, ",
            "duration",
            "effort",
            "verification  passed",
            "iterations",
        ],
    );
    let mut sweep = fixture_json("slews/olrac-four-wheels.json");
    sweep["sweep"]["weights"] = json!([0.1, 1.0]);
    let line = ["slew", "-", "--summary"];
    let text = slewplan_fed(&line, sweep.to_string().as_bytes());
    let text = text.expect_code(0).stdout;
    assert_text(
        &text,
        &["2 of 2 slews solved", "weight", "duration [s]", "0.1000"],
    );
}

#[test]
fn a_table_of_legs_has_a_summary() {
    let path = fixture("two-targets.json");
    let text = slewplan(&["legs", &path, "--summary"])
        .expect_code(0)
        .stdout;
    assert_text(
        &text,
        &[
            "legs of kind rest_to_rest",
            "from",
            "duration [s]",
            "converged",
        ],
    );
    let line = [
        "legs",
        &path,
        "--summary",
        "--kind",
        "certified",
        "--shard",
        "1/2",
    ];
    let text = slewplan(&line).expect_code(0).stdout;
    assert_text(
        &text,
        &["legs of kind certified, part 1 of 2", "bound [s]", "proved"],
    );
}

#[test]
fn the_studies_have_summaries() {
    let text = |name: &str, file: &str, change: &dyn Fn(&mut Value)| {
        let mut study = fixture_json(&format!("studies/{file}.json"));
        change(&mut study);
        let line = ["study", name, "-", "--summary"];
        let ended = slewplan_fed(&line, study.to_string().as_bytes());
        ended.expect_code(0).stdout
    };
    let few = |study: &mut Value| {
        study["simulation"]["runs"] = json!(3);
        let first = study["authorities"][0].clone();
        study["authorities"] = json!([first]);
    };
    assert_text(
        &text("authority", "authority", &few),
        &[
            "1 pair of torque and wheel speed",
            "3 of 3",
            "within at the end",
        ],
    );
    let as_it_is = |_: &mut Value| {};
    assert_text(
        &text("flight", "flight", &as_it_is),
        &[
            "arrival [s]",
            "deg at the end of",
            "at limits",
            "of the time",
        ],
    );
    assert_text(
        &text("envelopes", "pyramid-envelopes", &as_it_is),
        &[
            "torque [N m]",
            "momentum [N m s]",
            "eigenaxis, full",
            "demand [N m]",
        ],
    );
    assert_text(
        &text("comparison", "comparison", &as_it_is),
        &["control", "cmg", "faster from [deg]", "rw_optimal"],
    );
}

#[test]
fn json_and_summary_are_there_together_when_both_are_asked_for() {
    let path = fixture("slews/quarter-turn.json");
    let ended = slewplan(&["slew", &path, "--summary", "-o", "-"]).expect_code(0);
    assert_eq!(ended.json()["complete"], true);
    assert!(ended.stderr.contains("solved, "), "{ended:?}");
}

// `script` has other options elsewhere.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_gets_the_summary() {
    let line = format!(
        "{} legs {} --kind certified",
        env!("CARGO_BIN_EXE_slewplan"),
        fixture("two-targets.json")
    );
    // Gives the command a terminal of its own.
    let output = std::process::Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .output()
        .expect("script starts");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("legs of kind certified"), "{text}");
    assert!(!text.contains("scenario_key"), "{text}");
}

#[test]
fn the_target_of_a_reason_is_named() {
    let mut scenario = fixture_json("two-targets.json");
    // More momentum than the wheels can hold at rest.
    scenario["start"]["body_rate_rad_s"] = json!([0.04, 0.0, 0.0]);
    scenario["start"]["wheel_speed_rad_s"] = json!([700.0, 0.0, 0.0]);
    scenario["end"] = Value::Null;
    let line = ["solve", "-", "--summary"];
    let ended = slewplan_fed(&line, scenario.to_string().as_bytes()).expect_code(3);
    let named = "target \"b\", /targets/1";
    assert!(ended.stdout.contains(named), "{ended:?}");
    for line in [["validate", "-"], ["legs", "-"]] {
        let ended = slewplan_fed(&line, scenario.to_string().as_bytes());
        assert!(
            format!("{ended:?}").contains("target \\\"b\\\", /targets/1"),
            "{ended:?}"
        );
    }
}
