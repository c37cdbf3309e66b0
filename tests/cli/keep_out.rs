//! Plans that violate a keep-out cone: what is said, and `--strict`.

use crate::run::{Ended, fixture_json, slewplan, slewplan_fed};
use serde_json::Value;

/// Two targets, and a cone about where the camera looks at the second one; it is only reported.
fn violating() -> Value {
    let mut scenario = fixture_json("two-targets.json");
    let (roll, yaw) = (25.0_f64.to_radians(), 50.0_f64.to_radians());
    let towards = [roll.sin() * yaw.sin(), -roll.sin() * yaw.cos(), roll.cos()];
    scenario["keep_out"][0]["direction"] = towards.to_vec().into();
    scenario["keep_out"][0]["half_angle_deg"] = 5.into();
    scenario["keep_out"][0]["applies"] = "report".into();
    scenario
}

fn solve(scenario: &Value, options: &[&str]) -> Ended {
    let line = [&["solve", "-"], options].concat();
    slewplan_fed(&line, scenario.to_string().as_bytes())
}

#[test]
fn a_target_inside_a_cone_is_named_by_validate() {
    let scenario = violating().to_string();
    let line = ["validate", "-", "--format", "json"];
    let found = slewplan_fed(&line, scenario.as_bytes())
        .expect_code(0)
        .json();
    let warning = &found["warnings"][0];
    assert_eq!(warning["pointer"], "/targets/1");
    assert_eq!(warning["code"], "attitude_in_keep_out");
    let message = warning["message"].as_str().expect("a text");
    assert!(message.starts_with("target \"b\" points boresight 'camera' 5.000 degrees into"));
    assert_eq!(found["warnings"].as_array().map(Vec::len), Some(1));
}

/// The same with the cone enforced.
fn enforced(applies: &str) -> Value {
    let mut scenario = violating();
    scenario["keep_out"][0]["applies"] = applies.into();
    scenario
}

#[test]
fn a_target_inside_an_enforced_cone_is_infeasible() {
    for applies in ["always", "at_targets"] {
        let scenario = enforced(applies);
        let line = ["validate", "-", "--format", "json"];
        let found = slewplan_fed(&line, scenario.to_string().as_bytes());
        let found = found.expect_code(2).json();
        let error = &found["errors"][0];
        assert_eq!(error["pointer"], "/targets/1");
        assert_eq!(error["code"], "attitude_violates_cone");
        let message = error["message"].as_str().expect("a text");
        assert!(message.contains("boresight 'camera'"), "{message}");
        assert!(message.contains("/keep_out/0"), "{message}");
        assert_eq!(found["warnings"], serde_json::json!([]));
        let plan = solve(&scenario, &[]).expect_code(3).json();
        assert_eq!(plan["status"], "infeasible");
        assert_eq!(plan["reasons"][0]["code"], "attitude_violates_cone");
    }
    let mut panel = violating();
    panel["keep_in"] = panel["keep_out"].take();
    panel["keep_out"] = serde_json::json!([]);
    panel["keep_in"][0]["applies"] = "at_targets".into();
    let plan = solve(&panel, &[]).expect_code(3).json();
    assert_eq!(plan["reasons"][0]["pointer"], "/targets/0");
}

#[test]
fn a_plan_that_enters_an_enforced_cone_is_not_passed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (given, plan) = (path("scenario.json"), path("plan.json"));
    solve(&violating(), &["-o", &plan]).expect_code(0);
    for (applies, place) in [("always", ""), ("at_targets", " at targets")] {
        std::fs::write(&given, enforced(applies).to_string()).expect("written");
        let found = slewplan(&["verify", &given, &plan]).expect_code(3).json();
        assert_eq!(found["passed"], false);
        assert_eq!(found["warnings"], serde_json::json!([]));
        let failures = found["failures"].as_array().expect("a list");
        assert_eq!(failures.len(), 1, "{failures:?}");
        let expected = format!(
            "/keep_out/0: boresight 'camera' is inside the keep-out cone of 5 degrees{place} by up \
             to 5 degrees: "
        );
        let failure = failures[0].as_str().expect("a text");
        assert!(failure.starts_with(&expected), "{failure}");
        let text = slewplan(&["verify", &given, &plan, "--summary"]).expect_code(3);
        assert!(text.stdout.contains("NOT PASSED"), "{text:?}");
    }
}

#[test]
fn a_reported_sun_is_where_the_epoch_says() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["epoch"] = "2026-03-20T14:46:00Z".into();
    scenario["keep_out"][0]["direction"] = serde_json::json!({"body": "sun"});
    scenario["keep_out"][0]["applies"] = "report".into();
    let plan = solve(&scenario, &[]).expect_code(0).json();
    let nearest = &plan["margins"]["keep_out_clearance_deg"][0];
    assert_eq!(nearest["boresight"], "camera");
    assert_eq!(nearest["cone"], "/keep_out/0");
    assert!(nearest["clearance_deg"].as_f64().expect("a number") > 0.0);
    let time = nearest["time_s"].as_f64().expect("a number");
    assert!(time >= 0.0 && time <= plan["total_time_s"].as_f64().expect("a number"));
    // Equinox.
    assert!(nearest["direction"][0].as_f64().expect("a number") > 0.9999);
}

#[test]
fn the_times_inside_the_cone_are_in_the_margins() {
    let plan = solve(&violating(), &[]).expect_code(0).json();
    let stays = plan["margins"]["keep_out_intrusions"]
        .as_array()
        .expect("a list");
    assert_eq!(stays.len(), 1, "{stays:?}");
    let number = |value: &Value| value.as_f64().expect("a number");
    let passage = &plan["passages"].as_array().expect("a list")[0];
    let passage = if passage["target"] == "b" {
        passage
    } else {
        &plan["passages"][1]
    };
    assert!(number(&stays[0]["from_s"]) < number(&passage["time_s"]));
    assert!(number(&stays[0]["to_s"]) > number(&passage["departure_s"]));
    assert!((number(&stays[0]["depth_deg"]) - 5.0).abs() < 1e-3);
    let clear = slewplan(&["solve", &crate::run::fixture("two-targets.json")]);
    let clear = clear.expect_code(0).json();
    assert_eq!(
        clear["margins"]["keep_out_intrusions"],
        serde_json::json!([])
    );
}

#[test]
fn the_summary_begins_with_the_violation_and_its_hint() {
    let text = solve(&violating(), &["--summary"]).expect_code(0).stdout;
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[0].starts_with("two-targets: optimal, but keep-out violated, "),
        "{text}"
    );
    assert_eq!(lines[2], "KEEP-OUT VIOLATED");
    assert!(
        lines[3].contains("target \"b\"") && lines[4].contains("hint: "),
        "{text}"
    );
    assert!(
        text.contains("verification  passed, but keep-out violated"),
        "{text}"
    );
    assert!(!text.contains("to note"), "{text}");
}

#[test]
fn strict_has_an_exit_code_of_its_own_and_writes_the_plan() {
    let scenario = violating();
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (given, plan) = (path("scenario.json"), path("plan.json"));
    std::fs::write(&given, scenario.to_string()).expect("written");
    let ended = solve(&scenario, &["--strict", "-o", &plan]).expect_code(5);
    assert!(ended.stderr.contains("--strict"), "{ended:?}");
    let verified = slewplan(&["verify", &given, &plan]).expect_code(0).json();
    assert_eq!(verified["passed"], true);
    let strict = slewplan(&["verify", &given, &plan, "--strict", "--summary"]).expect_code(5);
    assert!(
        strict.stdout.starts_with("KEEP-OUT VIOLATED\n"),
        "{strict:?}"
    );
    // A plan without a violation is not different with it.
    let clear = fixture_json("two-targets.json");
    solve(&clear, &["--strict"]).expect_code(0);
    let help = slewplan(&["--help"]).expect_code(0).stdout;
    assert!(help.contains("5 a keep-out cone is violated"), "{help}");
}

/// So many cones of 0.2 degrees, evenly on the sphere.
fn narrow_cones(count: u32) -> Value {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let cone = |i: u32| {
        let height = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (around, width) = (golden * f64::from(i), (1.0 - height * height).sqrt());
        serde_json::json!({
            "boresight": "camera",
            "direction": [width * around.cos(), width * around.sin(), height],
            "half_angle_deg": 0.2,
        })
    };
    (0..count).map(cone).collect()
}

#[test]
fn a_thousand_cones_are_kept_and_one_more_is_refused() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["keep_out"] = narrow_cones(1000);
    let plan = solve(&scenario, &[]).expect_code(0).json();
    let margins = &plan["margins"];
    assert_eq!(margins["keep_out_intrusions"], serde_json::json!([]));
    let clearances = margins["keep_out_clearance_deg"].as_array();
    assert_eq!(clearances.map(Vec::len), Some(1000));
    scenario["keep_out"] = narrow_cones(1001);
    let refused = solve(&scenario, &[]).expect_code(2).stderr;
    assert!(refused.contains("the list has 1001 entries"), "{refused}");
}
