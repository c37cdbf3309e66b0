//! `slewplan slew` on the manoeuvres of the sources.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// The slews of an answer, all of them solved.
fn slews(name: &str) -> Vec<Value> {
    let path = fixture(&format!("slews/{name}"));
    let answer = slewplan(&["slew", &path]).expect_code(0).json();
    assert_eq!(answer["complete"], true);
    let slews = answer["slews"].as_array().expect("a list").clone();
    for slew in &slews {
        assert_eq!(
            (&slew["solved"], &slew["status"]),
            (&json!(true), &json!("converged"))
        );
        assert!(number(slew, "/flight/attitude_error_rad") <= 1e-6, "{slew}");
        assert!(number(slew, "/flight/rate_error_rad_s") <= 1e-7, "{slew}");
    }
    slews
}

fn number(slew: &Value, place: &str) -> f64 {
    let value = slew.pointer(place).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("no number at {place} of {slew}"))
}

#[test]
fn more_weight_on_effort_takes_more_time() {
    let slews = slews("olrac-four-wheels.json");
    assert_eq!(slews.len(), 4);
    // The published column of four wheels; the third weight is not published.
    for (slew, best) in [(&slews[0], 24.343), (&slews[1], 26.60), (&slews[3], 65.66)] {
        assert!(
            number(slew, "/objective") <= best * 1.0005,
            "{}",
            slew["objective"]
        );
    }
    for pair in slews.windows(2) {
        assert!(number(&pair[0], "/time_s") < number(&pair[1], "/time_s"));
        assert!(number(&pair[0], "/effort_nm2_s") > number(&pair[1], "/effort_nm2_s"));
    }
}

#[test]
fn samples_are_whole_periods_and_held_wheels_are_not_commanded() {
    let slews = slews("biros-sampled.json");
    assert!((number(&slews[0], "/time_s") - 9.5).abs() < 1e-9);
    assert!(number(&slews[0], "/continuous_time_s") <= 9.30);
    let controls = slews[0]["trajectory"]["controls"]
        .as_array()
        .expect("a list");
    assert_eq!(controls.len(), 19);
    for control in controls {
        assert!((number(control, "/duration_s") - 0.5).abs() < 1e-12);
        assert_eq!(
            control["wheel_torque_begin_nm"],
            control["wheel_torque_end_nm"]
        );
        for held in 3..7 {
            assert_eq!(control["wheel_torque_begin_nm"][held], json!(0.0));
        }
    }
}

#[test]
fn the_bill_is_less_than_what_the_thesis_paid() {
    let slews = slews("lro-least-bill.json");
    assert_eq!(slews[0]["objective_unit"], "J");
    assert!((number(&slews[0], "/time_s") - 910.1).abs() < 1e-9);
    assert!(number(&slews[0], "/energy_bill_j") <= 13.2);
    assert!(number(&slews[0], "/energy_proxy_j") < number(&slews[0], "/energy_bill_j"));
}

#[test]
fn evidence_comes_with_the_slew_and_stopping_has_its_code() {
    let mut slew = fixture_json("slews/olrac-four-wheels.json");
    let members = slew.as_object_mut().expect("an object");
    members.remove("sweep");
    members.remove("objective");
    members.insert("evidence".into(), json!(true));
    let answer = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes());
    let answer = answer.expect_code(0).json();
    let evidence = &answer["slews"][0]["evidence"];
    assert!(number(evidence, "/average_spread") <= 1e-3, "{evidence}");
    assert!(number(evidence, "/hamiltonian").abs() <= 1e-3, "{evidence}");
    slew["options"] = json!({"time_limit_s": 1e-6});
    let stopped = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes());
    let stopped = stopped.expect_code(4).json();
    assert_eq!(stopped["complete"], false);
    assert_eq!(stopped["slews"][0]["solved"], false);
}

#[test]
fn problems_are_listed_with_their_places() {
    let mut slew = fixture_json("slews/lro-least-bill.json");
    slew["drives"][1]["motor"]["efficiency"] = json!(2);
    slew["objective"]["duration_s"] = json!(-1);
    let ended = slewplan_fed(&["slew", "-"], slew.to_string().as_bytes()).expect_code(2);
    for place in ["/drives/1/motor/efficiency", "/objective/duration_s"] {
        assert!(ended.stderr.contains(place), "{ended:?}");
    }
}
