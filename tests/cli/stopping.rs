//! Stopping by limits and by signals.

use crate::run::{Ended, binary, fixture, fixture_json, names_in, slewplan, slewplan_fed};
use signal_hook::consts::{SIGINT, SIGTERM};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};

fn send(child: &Child, signal: i32) {
    let sent = Command::new("kill")
        .args([format!("-{signal}"), child.id().to_string()])
        .status()
        .expect("kill is there");
    assert!(sent.success());
}

/// Experiment C with additional targets, so that the first plan takes a while.
fn crowded(folder: &Path) -> String {
    let mut scenario = fixture_json("olivares-c.json");
    let targets = (0..240).map(|i| {
        let (roll, yaw) = (f64::from(i % 16) * 7.5, f64::from(i / 16) * 23.0);
        serde_json::json!({
            "id": format!("t{i}"),
            "attitude": {"roll_pitch_yaw_deg": [roll, 0, yaw]},
            "zero_rate_axes": ["z"],
        })
    });
    scenario["targets"] = targets.collect();
    let path = folder.join("crowded.json");
    std::fs::write(&path, scenario.to_string()).expect("a file");
    path.to_str().expect("UTF-8").to_owned()
}

/// Solves a scenario and sends a signal at the first matching line of progress.
fn signalled(scenario: &str, signal: i32, output: &Path, when: impl Fn(&str) -> bool) -> Ended {
    let mut child = binary()
        .args(["solve", scenario, "--progress", "json", "-o"])
        .arg(output)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut reader = BufReader::new(child.stderr.take().expect("piped"));
    let mut stderr = String::new();
    loop {
        let mut line = String::new();
        let read = reader.read_line(&mut line).expect("UTF-8");
        assert!(read > 0, "ended before the signal: {stderr}");
        stderr.push_str(&line);
        if when(&line) {
            break;
        }
    }
    send(&child, signal);
    reader.read_to_string(&mut stderr).expect("UTF-8");
    let output = child.wait_with_output().expect("the binary ends");
    Ended {
        stderr,
        ..output.into()
    }
}

#[test]
fn a_signal_before_the_first_plan_ends_without_a_plan() {
    for (signal, code) in [(SIGTERM, 143), (SIGINT, 130)] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("plan.json");
        let scenario = crowded(folder.path());
        let first = |line: &str| line.contains("\"incumbent_s\":null");
        signalled(&scenario, signal, &path, first).expect_code(code);
        assert_eq!(names_in(folder.path()), ["crowded.json"]);
    }
}

#[test]
fn a_signal_after_the_first_plan_ends_with_the_best_so_far() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plan.json");
    let known =
        |line: &str| line.contains("\"incumbent_s\":") && !line.contains("\"incumbent_s\":null");
    let scenario = crowded(folder.path());
    signalled(&scenario, SIGTERM, &path, known).expect_code(4);
    let text = std::fs::read_to_string(&path).expect("the plan is there");
    let plan: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(plan["status"], "feasible");
    assert_eq!(plan["verification"]["passed"], true);
    assert!(plan["relative_gap"].as_f64().expect("a number") > 0.0);
}

#[test]
fn a_node_limit_ends_with_the_best_so_far() {
    let mut scenario = fixture_json("olivares-b.json");
    scenario["options"]["node_limit"] = serde_json::json!(1);
    let text = scenario.to_string();
    let plan = slewplan_fed(&["solve", "-"], text.as_bytes())
        .expect_code(4)
        .json();
    assert_eq!(plan["status"], "feasible");
}

#[test]
fn a_time_limit_without_a_plan_is_a_failure_with_its_reason() {
    let path = fixture("olivares-c.json");
    let ended = slewplan(&["solve", &path, "--time-limit", "1e-6"]).expect_code(1);
    let plan = ended.json();
    assert_eq!(plan["status"], "failed");
    assert_eq!(plan["reasons"][0]["pointer"], "/options/time_limit_s");
    assert_eq!(plan["reasons"][0]["code"], "stopped_without_plan");
    assert!(
        ended.stderr.contains("stopped before a first plan"),
        "{ended:?}"
    );
}
