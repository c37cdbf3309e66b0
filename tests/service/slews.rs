//! Single slews over HTTP.

use crate::client::Request;
use crate::running::{Service, belt_of_cones};
use serde_json::{Value, json};

fn quarter() -> Value {
    let wheel =
        |axis: [u8; 3]| json!({"axis": axis, "inertia_kg_m2": 0.000_169, "max_torque_nm": 0.0101});
    json!({
        "spacecraft": {
            "inertia_kg_m2": [[6.63, 0, 0], [0, 8.9, 0], [0, 0, 9.63]],
            "wheels": [wheel([1, 0, 0]), wheel([0, 1, 0]), wheel([0, 0, 1])],
        },
        "start": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 0]}},
        "end": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 90]}},
    })
}

#[test]
fn a_slew_is_solved_and_verified() {
    let service = Service::start();
    let answer = service.post("/v1/slews", &quarter()).expect(200).json();
    let slew = &answer["slews"][0];
    assert_eq!(
        (&answer["complete"], &slew["solved"]),
        (&json!(true), &json!(true))
    );
    let error = slew["flight"]["attitude_error_rad"].as_f64();
    assert!(error.is_some_and(|error| error <= 1e-6), "{slew}");
    let mut sweep = quarter();
    sweep["objective"] = json!({"kind": "time_and_effort"});
    sweep["sweep"] = json!({"weights": [1e4, 1e5]});
    let answer = service.post("/v1/slews", &sweep).expect(200).json();
    let times: Vec<f64> = answer["slews"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|slew| slew["time_s"].as_f64().expect("a time"))
        .collect();
    assert!(times.len() == 2 && times[0] < times[1], "{times:?}");
}

#[test]
fn a_stored_spacecraft_can_be_named_and_problems_have_pointers() {
    let service = Service::start();
    let mut slew = quarter();
    let craft = slew["spacecraft"].take();
    let store = Request::new("PUT", "/v1/spacecraft/small").json(&craft);
    service.send(&store);
    slew["spacecraft"] = json!({"ref": "small"});
    let answer = service.post("/v1/slews", &slew).expect(200).json();
    assert_eq!(answer["slews"][0]["status"], "converged");
    slew["command"] = json!({"kind": "sampled", "period_s": 0});
    let problem = service
        .post("/v1/slews", &slew)
        .expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/command/period_s");
}

#[test]
fn the_pseudo_inverse_has_evidence_and_excludes_given_speeds() {
    let service = Service::start();
    let mut slew = quarter();
    slew["allocation"] = json!("pseudo_inverse");
    slew["evidence"] = json!(true);
    let answer = service.post("/v1/slews", &slew).expect(200).json();
    let found = &answer["slews"][0];
    assert_eq!(found["solved"], true);
    assert_eq!(found["evidence"]["controls"], "body_axes");
    let first = &found["evidence"]["intervals"][0]["switching_begin"];
    assert_eq!(first.as_array().map(Vec::len), Some(3));
    slew["final_wheels"] = json!("given");
    slew["end"]["wheel_speed_rad_s"] = json!([0, 0, 0]);
    let problem = service.post("/v1/slews", &slew);
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/allocation");
}

/// The quarter turn of a camera past a bright body.
fn past_a_bright_body() -> Value {
    let mut slew = quarter();
    slew["spacecraft"]["boresights"] = json!([{"name": "camera", "axis": [1, 0, 0]}]);
    slew["keep_out"] = json!([
        {"boresight": "camera", "direction": [1, 1, 0.05], "half_angle_deg": 25},
    ]);
    slew
}

#[test]
fn a_slew_keeps_out_of_a_cone() {
    let service = Service::start();
    let solved = |slew: &Value| {
        let answer = service.post("/v1/slews", slew).expect(200).json();
        assert_eq!(answer["slews"][0]["solved"], true, "{answer}");
        answer["slews"][0].clone()
    };
    let around = solved(&past_a_bright_body());
    let nearest = &around["flight"]["keep_out_clearance_deg"][0];
    assert_eq!(nearest["boresight"], "camera");
    assert_eq!(nearest["cone"], "/keep_out/0");
    let clearance = nearest["clearance_deg"].as_f64().expect("a number");
    assert!((-6e-5..0.1).contains(&clearance), "{nearest}");
    let time = |slew: &Value| slew["time_s"].as_f64().expect("a time");
    let when = nearest["time_s"].as_f64().expect("a time");
    assert!(0.0 < when && when < time(&around), "{nearest}");
    assert_eq!(around["flight"]["keep_out_intrusions"], json!([]));
    assert_eq!(around["reasons"], json!([]));

    let mut reported = past_a_bright_body();
    reported["keep_out"][0]["applies"] = json!("report");
    let through = solved(&reported);
    assert!(time(&through) < time(&around));
    let flight = &through["flight"];
    let intrusion = &flight["keep_out_intrusions"][0];
    assert!(intrusion["depth_deg"].as_f64() > Some(3.0), "{flight}");
    let warning = &flight["warnings"][0];
    assert_eq!(
        (&warning["pointer"], &warning["code"]),
        (&json!("/keep_out/0"), &json!("keep_out_violated"))
    );
}

/// From pole to pole across a belt of cones 30 degrees apart.
fn across_a_belt(half_angle_deg: f64) -> Value {
    let mut slew = past_a_bright_body();
    slew["spacecraft"]["boresights"][0]["axis"] = json!([0, 0, 1]);
    slew["end"]["attitude"] = json!({"roll_pitch_yaw_deg": [180, 0, 0]});
    slew["keep_out"] = belt_of_cones(half_angle_deg);
    slew
}

#[test]
fn a_slew_whose_way_is_not_found_is_not_called_infeasible() {
    let service = Service::start();
    // The cones overlap by less than the search resolves.
    let slew = across_a_belt(15.0005);
    let answer = service.post("/v1/slews", &slew).expect(200).json();
    assert_eq!(answer["complete"], true);
    let slew = &answer["slews"][0];
    assert_eq!(
        (&slew["solved"], &slew["status"]),
        (&json!(false), &json!("no_clear_path"))
    );
    let reason = &slew["reasons"][0];
    assert_eq!(
        (&reason["pointer"], &reason["code"]),
        (&json!("/end"), &json!("no_clear_path"))
    );
    let message = reason["message"].as_str().expect("a text");
    for words in ["a clearance of", "nearest point that was reached", "cells"] {
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_slew_without_a_way_and_wrong_cones_are_told() {
    let service = Service::start();
    let enclosed = across_a_belt(20.0);
    let answer = service.post("/v1/slews", &enclosed).expect(200).json();
    let slew = &answer["slews"][0];
    assert_eq!(
        (&slew["solved"], &slew["status"]),
        (&json!(false), &json!("infeasible"))
    );
    let reason = &slew["reasons"][0];
    assert_eq!(
        (&reason["pointer"], &reason["code"]),
        (&json!("/end"), &json!("no_clear_path"))
    );
    let wrong = [
        (
            "half_angle_deg",
            json!(180),
            "half_angle_deg",
            "out_of_range",
        ),
        (
            "boresight",
            json!("mirror"),
            "boresight",
            "unknown_reference",
        ),
        (
            "applies",
            json!("at_targets"),
            "applies",
            "conflicting_fields",
        ),
        (
            "direction",
            json!({"body": "sun"}),
            "direction",
            "epoch_required",
        ),
        ("direction", json!([0, 1, 0]), "", "attitude_violates_cone"),
    ];
    for (field, value, place, code) in wrong {
        let mut slew = past_a_bright_body();
        slew["keep_out"][0][field] = value;
        let problem = service.post("/v1/slews", &slew);
        let problem = problem.expect_problem(422, "invalid_input");
        let pointer = match place {
            "" => "/end".to_owned(),
            place => format!("/keep_out/0/{place}"),
        };
        let error = &problem["errors"][0];
        assert_eq!(
            (&error["pointer"], &error["code"]),
            (&json!(pointer), &json!(code)),
            "{problem}"
        );
    }
}
