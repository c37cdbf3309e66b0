//! Realistic spacecraft with rate limits and stored momentum: `fixtures/gallery`.

use crate::run::{fixture, fixture_json, names_in, slewplan, slewplan_fed};
use serde_json::{Value, json};
use std::path::Path;

/// The scenarios of the gallery, named as fixtures.
fn gallery() -> Vec<String> {
    let mut names = names_in(Path::new(&fixture("gallery")));
    names.retain(|name| Path::new(name).extension() == Some("json".as_ref()));
    assert_eq!(names.len(), 8);
    names.iter().map(|name| format!("gallery/{name}")).collect()
}

fn number(value: &Value, place: &str) -> f64 {
    let number = value.pointer(place).and_then(Value::as_f64);
    number.unwrap_or_else(|| panic!("no number at {place} of {value}"))
}

#[test]
fn every_tour_is_planned_and_verified() {
    for name in gallery() {
        let plan = slewplan(&["solve", &fixture(&name)]).expect_code(0).json();
        assert_eq!(plan["status"], "optimal", "{name}");
        assert_eq!(plan["verification"]["passed"], true, "{name}");
        let total = number(&plan, "/total_time_s");
        assert!(number(&plan, "/certified_lower_bound_s") <= total, "{name}");
        let legs = plan["legs"].as_array().expect("a list");
        let open = |leg| 1.0 - number(leg, "/certified_lower_bound_s") / number(leg, "/duration_s");
        let most = legs.iter().map(open).fold(0.0, f64::max);
        let told = number(&plan, "/largest_open_share");
        assert!((most - told).abs() <= 1e-9, "{name}: {most} and {told}");
    }
}

#[test]
fn every_leg_converges() {
    for name in gallery() {
        for kind in ["lower_bound", "rest_to_rest"] {
            let table = slewplan(&["legs", &fixture(&name), "--kind", kind]);
            for leg in table.expect_code(0).json()["legs"]
                .as_array()
                .expect("a list")
            {
                assert_eq!(leg["status"], "converged", "{name}: {leg}");
                let bound = number(leg, "/certified_lower_bound_s");
                assert!(
                    number(leg, "/duration_s") >= bound * (1.0 - 1e-6),
                    "{name}: {leg}"
                );
            }
        }
    }
}

#[test]
fn every_objective_and_command_is_solved() {
    let commands = [
        None,
        Some(json!({"kind": "uniform", "intervals": 60})),
        Some(json!({"kind": "smooth", "intervals": 30})),
    ];
    for name in gallery() {
        let scenario = fixture_json(&name);
        let mut slew = json!({
            "spacecraft": scenario["spacecraft"],
            "start": scenario["start"],
            "end": {"attitude": scenario["targets"][1]["attitude"]},
        });
        for command in &commands {
            if let Some(command) = command {
                slew["command"] = command.clone();
            }
            for objective in [
                json!({"kind": "minimum_time"}),
                json!({"kind": "time_and_effort", "weight": 1}),
            ] {
                slew["objective"] = objective;
                let answer = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes());
                let answer = answer.expect_code(0).json();
                let outcome = &answer["slews"][0];
                assert_eq!(
                    outcome["status"], "converged",
                    "{name}: {}",
                    slew["command"]
                );
                assert_eq!(outcome["solved"], true, "{name}: {}", slew["command"]);
            }
        }
    }
}
