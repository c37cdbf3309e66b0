//! Contents of the SVG of a plan.

use super::{DrawnBoresight, WrittenPlan, plan as svg, summary};
use crate::documents;
use crate::render::report::sample;
use serde_json::{Value, json};
use slewplan_solver::model::plan::Outcome;
use slewplan_solver::model::scenario::Scenario;

fn written() -> Vec<u8> {
    let outcome = Outcome::Planned(Box::new(sample::plan()));
    serde_json::to_vec(&documents::plan::document(&outcome, &[], &[])).unwrap()
}

fn scenario() -> Scenario {
    scenario_with(r#"{"id": "a", "attitude": {"roll_pitch_yaw_deg": [0, 0, 5]}}"#)
}

fn scenario_with(targets: &str) -> Scenario {
    let wheel = |axis: &str| {
        format!(r#"{{"axis": [{axis}], "inertia_kg_m2": 0.002, "max_torque_nm": 0.5}}"#)
    };
    let wheels = ["1, 0, 0", "0, 1, 0", "0, 0, 1"].map(wheel).join(", ");
    let text = format!(
        r#"{{"name": "a < b & \"c\"", "reference_frame": "EME2000",
        "spacecraft": {{"inertia_kg_m2": [[4, 0, 0], [0, 5, 0], [0, 0, 6]],
            "max_body_rate_rad_s": [0.6, 0.6, 0.6], "wheels": [{wheels}],
            "boresights": [{{"name": "camera", "axis": [0, 0, 1]}}, {{"name": "x2", "axis": [1, 0, 0]}}]}},
        "start": {{"attitude": {{"roll_pitch_yaw_deg": [0, 0, 0]}}}},
        "targets": [{targets}],
        "keep_out": [{{"boresight": "camera", "direction": [0, 0, 1], "half_angle_deg": 30}}]}}"#
    );
    documents::scenario::read(text.as_bytes(), None)
        .unwrap()
        .scenario
}

fn drawn(scenario: Option<&Scenario>, boresight: Option<&str>) -> String {
    let plan = WrittenPlan::read(&written()).unwrap();
    let boresight = DrawnBoresight::find(boresight, scenario).unwrap();
    svg(&plan, scenario, &boresight).unwrap()
}

#[test]
fn a_plan_alone_is_drawn_without_limits() {
    let picture = drawn(None, None);
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"));
    assert!(picture.contains("30.00 s  \u{b7}  optimal"));
    assert!(picture.contains("body axis x"));
    for words in [
        "1 a",
        "2 b",
        "b \u{2192} end",
        "wheel 2",
        "Body rate, deg/s",
    ] {
        assert!(picture.contains(&format!(">{words}</text>")), "{words}");
    }
    assert!(!picture.contains("limit") && !picture.contains("by cones"));
}

#[test]
fn a_bound_that_is_not_known_is_not_drawn() {
    let mut plan = WrittenPlan::read(&written()).unwrap();
    assert!(summary(&plan).contains("lower bound 30.00 s"));
    (plan.lower_bound_s, plan.relative_gap) = (0.0, 1.0);
    assert!(!summary(&plan).contains("bound") && !summary(&plan).contains("gap"));
}

#[test]
fn the_roll_of_a_pointed_boresight_is_a_tick() {
    let scenario = scenario_with(
        r#"{"id": "a", "attitude": {"roll_pitch_yaw_deg": [0, 0, 5]}},
        {"id": "b", "pointing": {"boresight": "camera", "direction": [0, 0, 1]}}"#,
    );
    let told = |boresight| drawn(Some(&scenario), Some(boresight)).contains("ticks: roll");
    assert!(told("camera") && !told("x2"));
}

#[test]
fn the_scenario_adds_limits_and_the_cones_of_the_boresight() {
    let scenario = scenario();
    let picture = drawn(Some(&scenario), None);
    assert!(picture.contains("a &lt; b &amp; \"c\""));
    assert!(picture.contains("Where camera points in EME2000<"));
    assert!(picture.contains("dashed: far side; red: excluded by cones"));
    // 0.6 rad/s and 0.5 N m.
    assert!(picture.contains("limit \u{b1}34.377") && picture.contains("limit \u{b1}500"));
    assert!(picture.contains(">no limit<"));
    assert!(picture.contains("Clearance of cones, deg</text>"));
    assert!(
        picture.contains(">camera /keep_out/0</text>") && picture.contains(">at least 0</text>")
    );
    assert!(!drawn(None, None).contains("Clearance of cones"));
    // The cones of other boresights are not drawn.
    assert!(!drawn(Some(&scenario), Some("x2")).contains("by cones"));
    assert!(!drawn(Some(&scenario), Some("-z")).contains("by cones"));
}

#[test]
fn stays_inside_a_cone_are_marked_on_every_timeline() {
    let mut document: Value = serde_json::from_slice(&written()).unwrap();
    let x = DrawnBoresight::find(None, None).unwrap();
    let marks = |document: &Value| {
        let plan = WrittenPlan::read(document.to_string().as_bytes()).unwrap();
        let picture = svg(&plan, None, &x).unwrap();
        (picture.matches("fill=\"#C0392B\"").count(), picture)
    };
    let (before, picture) = marks(&document);
    assert!(!picture.contains("keep-out violated"));
    document["margins"]["keep_out_intrusions"] = json!([
        {"boresight": "camera", "cone": "/keep_out/0", "from_s": 3.0, "to_s": 6.0, "depth_deg": 2.0},
        {"boresight": "camera", "cone": "/keep_out/1", "from_s": 9.0, "to_s": 9.0, "depth_deg": 0.1},
    ]);
    let (after, picture) = marks(&document);
    assert_eq!(after - before, 6);
    assert!(picture.contains("keep-out violated where marked red"));
    document["margins"] = json!(null);
    assert_eq!(marks(&document).0, before);
}

#[test]
fn the_svg_is_well_formed_and_has_finite_numbers() {
    let scenario = scenario();
    for picture in [drawn(None, Some("-y")), drawn(Some(&scenario), None)] {
        assert!(!picture.contains("NaN") && !picture.contains("inf"));
        for tag in ["svg", "text", "title"] {
            let opened = picture.matches(&format!("<{tag}")).count();
            assert_eq!(opened, picture.matches(&format!("</{tag}>")).count());
        }
        for line in picture.lines() {
            let closed = ["/>", "</text>", "</title>", "</svg>"];
            let is_head = line.starts_with("<svg");
            assert!(
                is_head || closed.iter().any(|end| line.ends_with(end)),
                "{line}"
            );
        }
    }
}

#[test]
fn documents_that_cannot_be_drawn_are_refused() {
    let scenario = scenario();
    assert!(DrawnBoresight::find(Some("w"), None).is_err());
    let named = DrawnBoresight::find(Some("w"), Some(&scenario)).unwrap_err();
    assert!(named.contains("camera, x2"));
    let infeasible = r#"{"status": "infeasible", "total_time_s": null}"#;
    assert!(WrittenPlan::read(infeasible.as_bytes()).is_err());
    let document: Value = serde_json::from_slice(&written()).unwrap();
    let mut still = document.clone();
    still["total_time_s"] = 0.0.into();
    let mut ragged = document.clone();
    ragged["trajectory"]["states"][1]["wheel_speed_rad_s"] = json!([1.0, 2.0]);
    for refused in [still, ragged] {
        assert!(WrittenPlan::read(refused.to_string().as_bytes()).is_err());
    }
    let mut without_wheels = document;
    for (list, member) in [
        ("states", "wheel_speed_rad_s"),
        ("controls", "wheel_torque_nm"),
    ] {
        let entries = without_wheels["trajectory"][list].as_array_mut().unwrap();
        for entry in entries {
            entry[member] = json!([]);
        }
    }
    let plan = WrittenPlan::read(without_wheels.to_string().as_bytes()).unwrap();
    let x = DrawnBoresight::find(None, None).unwrap();
    assert!(
        svg(&plan, Some(&scenario), &x)
            .unwrap_err()
            .contains("wheels")
    );
}
