//! Studies over HTTP.

use crate::running::{Service, small};
use serde_json::{Value, json};

fn study(shares: &[(f64, f64)]) -> Value {
    let pair = |(torque, momentum): &(f64, f64)| json!({"torque_authority": torque, "momentum_authority": momentum});
    let pairs: Vec<Value> = shares.iter().map(pair).collect();
    json!({
        "scenario": small(),
        "simulation": {"errors": {"inertia_3_sigma": 0.02}, "runs": 10},
        "authorities": pairs,
    })
}

#[test]
fn smaller_shares_take_longer_and_are_flown_as_often_as_asked() {
    let service = Service::start();
    let body = study(&[(1.0, 1.0), (0.8, 0.8)]);
    let answer = service
        .post("/v1/studies/authority", &body)
        .expect(200)
        .json();
    assert_eq!(answer["complete"], true);
    let rows = answer["rows"].as_array().expect("a list");
    let times: Vec<f64> = rows
        .iter()
        .map(|row| {
            assert_eq!(
                (&row["status"], &row["flights"]["runs"]),
                (&json!("flown"), &json!(10))
            );
            row["total_time_s"].as_f64().expect("a time")
        })
        .collect();
    assert!(times[0] < times[1], "{times:?}");
}

#[test]
fn problems_of_scenario_and_study_have_their_places() {
    let service = Service::start();
    let mut body = study(&[(1.5, 1.0)]);
    body["scenario"]["spacecraft"]["wheels"][0]["max_torque_nm"] = json!(-1);
    let problem = service.post("/v1/studies/authority", &body);
    let problem = problem.expect_problem(422, "invalid_input");
    let errors = problem["errors"].as_array().expect("a list");
    let places: Vec<&str> = errors
        .iter()
        .filter_map(|error| error["pointer"].as_str())
        .collect();
    for place in [
        "/scenario/spacecraft/wheels/0/max_torque_nm",
        "/authorities/0/torque_authority",
    ] {
        assert!(places.contains(&place), "{places:?}");
    }
    let problem = service.post("/v1/studies/authority", &json!({"authorities": 1}));
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/scenario");
}
