//! `slewplan validate`.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::json;

#[test]
fn every_fixture_is_valid() {
    for name in [
        "olivares-a.json",
        "olivares-b.json",
        "olivares-c.json",
        "two-targets.json",
        "pyramid.json",
        "pyramid-one-disabled.json",
        "pyramid-momentum-bias.json",
        "olivares-a-quaternion.json",
        "quarter-turn.json",
        "ra-dec.json",
        "gallery/biros.json",
        "gallery/cubesat-6u.json",
        "gallery/envelope-pyramid.json",
        "gallery/imager-500kg.json",
        "gallery/lro.json",
        "gallery/olrac.json",
        "gallery/smallsat-100kg.json",
        "gallery/telescope-2t.json",
    ] {
        let ended = slewplan(&["validate", &fixture(name)]).expect_code(0);
        assert!(ended.stdout.ends_with("is valid\n"), "{ended:?}");
        let document = slewplan(&["validate", &fixture(name), "--format", "json"]).json();
        assert_eq!(
            document,
            json!({"valid": true, "errors": [], "warnings": []})
        );
    }
}

#[test]
fn a_quaternion_with_a_small_norm_error_is_a_warning() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["targets"][0]["attitude"] =
        json!({"quaternion": {"x": 0, "y": 0, "z": 0.0, "w": 1.0005}});
    let text = scenario.to_string();
    let document = slewplan_fed(&["validate", "-", "--format", "json"], text.as_bytes())
        .expect_code(0)
        .json();
    assert_eq!(document["valid"], true);
    assert_eq!(
        document["warnings"][0]["pointer"],
        "/targets/0/attitude/quaternion"
    );
    assert_eq!(document["warnings"][0]["code"], "attitude_normalized");
    let told = slewplan_fed(&["validate", "-"], text.as_bytes())
        .expect_code(0)
        .stdout;
    assert!(
        told.contains("1 warning") && told.contains("[attitude_normalized]"),
        "{told}"
    );
}

#[test]
fn slips_of_units_are_warnings_that_name_the_slip() {
    let mut scenario = fixture_json("two-targets.json");
    let craft = &mut scenario["spacecraft"];
    craft["max_body_rate_rad_s"] = json!([2.3, 2.3, 2.3]);
    craft["wheels"][0]["inertia_kg_m2"] = json!(0.1);
    craft["wheels"][0]["max_speed_rad_s"] = json!(6000);
    craft["wheels"][1]["max_torque_nm"] = json!(10.1);
    scenario["targets"] = json!([]);
    let text = scenario.to_string();
    let line = ["validate", "-", "--format", "json"];
    let document = slewplan_fed(&line, text.as_bytes()).expect_code(0).json();
    let told: Vec<(&str, &str, &str)> = document["warnings"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|warning| {
            let text = |name: &str| warning[name].as_str().expect("a text");
            (text("code"), text("pointer"), text("hint"))
        })
        .collect();
    let expected = [
        ("no_targets", "/targets", "targets"),
        (
            "rate_limit_unreachable",
            "/spacecraft/max_body_rate_rad_s/2",
            "degrees per second",
        ),
        (
            "wheel_speed_implausible",
            "/spacecraft/wheels/0/max_speed_rad_s",
            "revolutions per minute",
        ),
        (
            "acceleration_implausible",
            "/spacecraft/inertia_kg_m2",
            "g mm2",
        ),
    ];
    assert_eq!(told.len(), expected.len(), "{document:#}");
    for (told, expected) in told.iter().zip(expected) {
        assert_eq!((told.0, told.1), (expected.0, expected.1));
        assert!(told.2.contains(expected.2), "{told:?}");
    }
}

#[test]
fn warnings_are_reported_with_the_errors() {
    let mut scenario = fixture_json("two-targets.json");
    scenario["targets"][0]["attitude"] =
        json!({"quaternion": {"x": 0, "y": 0, "z": 0.0, "w": 1.0005}});
    scenario["targets"][1]["id"] = json!("a");
    scenario["comment"] = json!("?");
    let text = scenario.to_string();
    let document = slewplan_fed(&["validate", "-", "--format", "json"], text.as_bytes())
        .expect_code(2)
        .json();
    assert_eq!(document["errors"].as_array().map(Vec::len), Some(2));
    assert_eq!(document["warnings"].as_array().map(Vec::len), Some(1));
    assert_eq!(document["warnings"][0]["code"], "attitude_normalized");
    let told = slewplan_fed(&["validate", "-"], text.as_bytes())
        .expect_code(2)
        .stdout;
    assert!(
        told.contains("2 problems")
            && told.contains(
                "1 warning
"
            ),
        "{told}"
    );
}

/// Momentum that the x wheel holds at the start, but that exceeds the wheels at the target's
/// attitude.
fn too_much_momentum() -> String {
    let mut scenario = fixture_json("two-targets.json");
    scenario["start"]["wheel_speed_rad_s"] = json!([700, 700, 700]);
    scenario["targets"][1]["attitude"] = json!({"roll_pitch_yaw_deg": [0, 30, 45]});
    scenario.to_string()
}

#[test]
fn a_rest_that_the_wheels_cannot_hold_is_an_error() {
    let scenario = too_much_momentum();
    let document = slewplan_fed(&["validate", "-", "--format", "json"], scenario.as_bytes())
        .expect_code(2)
        .json();
    let codes: Vec<(&str, &str)> = document["errors"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|e| {
            (
                e["pointer"].as_str().expect("text"),
                e["code"].as_str().expect("text"),
            )
        })
        .collect();
    assert_eq!(codes, [("/targets/1", "momentum_exceeds_envelope")]);
}

#[test]
fn solving_a_rest_that_cannot_be_held_is_infeasible() {
    let ended = slewplan_fed(&["solve", "-"], too_much_momentum().as_bytes()).expect_code(3);
    let plan = ended.json();
    assert_eq!(plan["status"], "infeasible");
    assert_eq!(plan["total_time_s"], serde_json::Value::Null);
    assert_eq!(plan["reasons"][0]["pointer"], "/targets/1");
    assert_eq!(plan["reasons"][0]["code"], "momentum_exceeds_envelope");
    assert!(
        ended.stderr.contains("momentum_exceeds_envelope"),
        "{}",
        ended.stderr
    );
    let ended = slewplan_fed(&["legs", "-"], too_much_momentum().as_bytes()).expect_code(3);
    assert!(
        ended.stderr.contains("momentum_exceeds_envelope"),
        "{}",
        ended.stderr
    );
}
