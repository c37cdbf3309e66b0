//! Single slews over HTTP.

use crate::client::Request;
use crate::running::Service;
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
