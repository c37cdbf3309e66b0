//! `slewplan plot`.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::json;

#[test]
fn a_plan_is_drawn_with_and_without_its_scenario() {
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    let alone = slewplan_fed(&["plot", "-"], plan.as_bytes())
        .expect_code(0)
        .stdout;
    assert!(alone.starts_with("<svg ") && !alone.contains("limit"));
    let line = ["plot", "-", "--scenario", &scenario];
    let whole = slewplan_fed(&line, plan.as_bytes()).expect_code(0).stdout;
    assert!(whole.contains("two-targets") && whole.contains("Where camera points"));
    assert!(whole.contains("red: excluded by cones") && whole.contains("limit \u{b1}710"));
}

#[test]
fn documents_that_cannot_be_drawn_are_refused() {
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    let unknown = slewplan_fed(&["plot", "-", "--boresight", "nose"], plan.as_bytes());
    assert!(unknown.expect_code(2).stderr.contains("none of x, y, z"));
    let pyramid = fixture("pyramid.json");
    let other = slewplan_fed(&["plot", "-", "--scenario", &pyramid], plan.as_bytes());
    assert!(other.expect_code(2).stderr.contains("wheels"));
    slewplan_fed(&["plot", "-"], b"{}").expect_code(2);
    slewplan(&["plot", "-", "--scenario", "-"]).expect_code(2);
}

#[test]
fn a_slew_is_drawn_over_time_with_the_limits_of_its_request() {
    let mut slew = fixture_json("slews/olrac-three-wheels.json");
    slew["objective"] = json!({"kind": "minimum_time"});
    slew["sweep"] = json!(null);
    let folder = tempfile::tempdir().expect("a folder");
    let request = folder.path().join("slew.json");
    std::fs::write(&request, slew.to_string()).expect("written");
    let request = request.to_str().expect("UTF-8");
    let answer = slewplan(&["slew", request]).expect_code(0).stdout;
    let line = ["plot", "-", "--scenario", request];
    let drawn = slewplan_fed(&line, answer.as_bytes()).expect_code(0).stdout;
    assert!(drawn.contains("olrac-three-wheels") && drawn.contains("limit \u{b1}550"));
    assert!(drawn.contains(">28.6") && drawn.contains("Wheel speed, rad/s"));
    for refused in [["--boresight", "x"], ["--mark", "1"]] {
        slewplan_fed(&["plot", "-", refused[0], refused[1]], answer.as_bytes()).expect_code(2);
    }
}

#[test]
fn a_slew_is_drawn_with_the_clearance_of_the_cones_of_its_request() {
    let mut slew = fixture_json("slews/quarter-turn.json");
    slew["spacecraft"]["boresights"] = serde_json::json!([{"name": "camera", "axis": [1, 0, 0]}]);
    slew["keep_out"] = serde_json::json!([{"boresight": "camera", "direction": [1, 1, 0.05],
        "half_angle_deg": 25, "applies": "report"}]);
    let folder = tempfile::tempdir().expect("a folder");
    let request = folder.path().join("slew.json");
    std::fs::write(&request, slew.to_string()).expect("written");
    let request = request.to_str().expect("UTF-8");
    let answer = slewplan(&["slew", request]).expect_code(0).stdout;
    let line = ["plot", "-", "--scenario", request];
    let drawn = slewplan_fed(&line, answer.as_bytes()).expect_code(0).stdout;
    assert!(drawn.contains("Clearance of cones, deg</text>"));
    assert!(drawn.contains("camera /keep_out/0"));
    // The stay inside is marked on the timelines of rates, speeds, torques and clearance.
    assert!(drawn.contains("keep-out violated where marked red"));
    assert_eq!(drawn.matches("rx=\"0\" fill=\"#C0392B\"").count(), 4);
    let alone = slewplan_fed(&["plot", "-"], answer.as_bytes());
    assert!(!alone.expect_code(0).stdout.contains("Clearance of cones"));
}

#[test]
fn answers_with_a_sweep_are_drawn_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let answer = |name: &str| {
        let path = folder.path().join(name).to_str().expect("UTF-8").to_owned();
        slewplan(&["slew", &fixture(&format!("slews/{name}")), "-o", &path]).expect_code(0);
        path
    };
    let (three, five) = (
        answer("olrac-three-wheels.json"),
        answer("olrac-five-wheels.json"),
    );
    let line = ["plot", &three, &five, "--level", "20"];
    let drawn = slewplan(&line).expect_code(0).stdout;
    for words in [
        "olrac-three-wheels",
        "olrac-five-wheels",
        "Duration, s",
        "0.01",
        "10",
    ] {
        assert!(drawn.contains(&format!(">{words}<")), "{words}");
    }
    assert!(drawn.contains("14 slews over weight of the effort"));
    // Each curve crosses the level once, near a weight of 0.1.
    assert_eq!(drawn.matches("r=\"4.0\"").count(), 2);
    // Answers with another swept quantity and other documents are refused.
    let bill = answer("lro-bill-curve.json");
    slewplan(&["plot", &three, &bill]).expect_code(2);
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    slewplan_fed(&["plot", &three, "-"], plan.as_bytes()).expect_code(2);
    slewplan(&["plot", &three, "--scenario", &scenario]).expect_code(2);
    let energies = slewplan(&["plot", &bill, "--mark", "910.1"]).expect_code(0);
    let energies = energies.stdout;
    assert!(energies.contains(">910.1<") && energies.contains("Energy, J"));
    assert!(!energies.contains("Duration, s"));
}
