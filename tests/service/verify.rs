//! Verification of plans of any origin.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::{Value, json};

#[test]
fn a_plan_of_the_service_passes_and_a_damaged_one_does_not() {
    let service = Service::start();
    let request = Request::new("POST", "/v1/plans")
        .header("Prefer", "wait=60")
        .json(&small());
    let mut plan = service.send(&request).expect(200).json();
    let verify =
        |plan: &Value| service.post("/v1/verify", &json!({"scenario": small(), "plan": plan}));
    let report = verify(&plan).expect(200).json();
    assert_eq!(
        (&report["passed"], &report["failures"]),
        (&json!(true), &json!([]))
    );
    plan["trajectory"]["controls"][0]["wheel_torque_nm"][0] = json!(0.0);
    let report = verify(&plan).expect(200).json();
    assert_eq!(report["passed"], false);
    assert_ne!(report["failures"], json!([]));
}

#[test]
fn a_plan_whose_total_time_was_changed_gives_null_and_contradicts_its_bounds() {
    let service = Service::start();
    let request = Request::new("POST", "/v1/plans")
        .header("Prefer", "wait=60")
        .json(&small());
    let mut plan = service.send(&request).expect(200).json();
    plan["total_time_s"] = json!(1.0);
    let body = json!({"scenario": small(), "plan": plan});
    let report = service.post("/v1/verify", &body).expect(200).json();
    assert_eq!(report["passed"], false);
    assert_eq!(report["max_attitude_error_rad"], Value::Null);
    assert_eq!(report["margins"]["torque"], Value::Null);
    let warnings = report["warnings"].as_array().expect("a list");
    let named = warnings.iter().any(|warning| {
        warning["code"] == "bound_above_time" && warning["pointer"] == "/plan/lower_bound_s"
    });
    assert!(named, "{report}");
}

#[test]
fn plans_that_cannot_be_propagated_are_refused_with_pointers() {
    let service = Service::start();
    let problem = service.post("/v1/verify", &json!({"scenario": small()}));
    assert_eq!(
        problem.expect_problem(422, "invalid_input")["errors"][0]["pointer"],
        "/plan"
    );
    let problem = service.post("/v1/verify", &json!({"scenario": small(), "plan": {}}));
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/plan/total_time_s");
    let problem = service.post("/v1/verify", &json!({"scenario": {}, "plan": {}}));
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/scenario/spacecraft");
    let mut unknown = small();
    unknown["spacecraft"] = json!({"ref": "nowhere"});
    let problem = service.post("/v1/verify", &json!({"scenario": unknown, "plan": {}}));
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/scenario/spacecraft/ref");
    assert_eq!(problem["errors"][0]["code"], "unknown_reference");
    let mut misspelt = small();
    misspelt["spacecraft"] = json!({"ref": 7});
    let problem = service.post("/v1/verify", &json!({"scenario": misspelt, "plan": {}}));
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/scenario/spacecraft/ref");
}
