//! Studies over HTTP.

use crate::client::Request;
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

/// Pointers of the problems of a refused request.
fn places(problem: &Value) -> Vec<&str> {
    let errors = problem["errors"].as_array().expect("a list");
    let pointers = errors.iter().filter_map(|error| error["pointer"].as_str());
    pointers.collect()
}

#[test]
fn smaller_shares_take_longer_and_are_simulated_as_often_as_requested() {
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
fn many_flights_have_a_share_that_stays_clear_of_cones() {
    let service = Service::start();
    let ask = |body: &Value| {
        let answer = service.post("/v1/studies/authority", body);
        answer.expect(200).json()["rows"][0]["flights"].clone()
    };
    let mut body = study(&[(0.9, 0.9)]);
    body["scenario"]["keep_out"] = json!([]);
    let bare = ask(&body);
    assert_eq!(
        (&bare["share_clear"], &bare["keep_out_clearance_deg"]),
        (&Value::Null, &json!([]))
    );
    // The same direction, once so wide that the flights begin inside, only to be reported.
    let cone = |half_angle_deg: f64, applies: &str| {
        json!({"boresight": "camera",
        "direction": [0, 0, -1], "half_angle_deg": half_angle_deg, "applies": applies})
    };
    body["scenario"]["keep_out"] = json!([cone(1.0, "always"), cone(179.5, "report")]);
    let flights = ask(&body);
    assert_eq!(flights["share_clear"], 1.0);
    let shares: Vec<_> = flights["keep_out_clearance_deg"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| (&one["cone"], &one["applies"], &one["share_clear"]))
        .collect();
    assert_eq!(
        json!(shares),
        json!([
            ["/keep_out/0", "always", 1.0],
            ["/keep_out/1", "report", 0.0]
        ])
    );
}

#[test]
fn problems_of_scenario_and_study_have_pointers() {
    let service = Service::start();
    let mut body = study(&[(1.5, 1.0)]);
    body["scenario"]["spacecraft"]["wheels"][0]["max_torque_nm"] = json!(-1);
    let problem = service.post("/v1/studies/authority", &body);
    let problem = problem.expect_problem(422, "invalid_input");
    let places = places(&problem);
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

#[test]
fn a_stored_spacecraft_has_envelopes_and_slews_within_them() {
    let service = Service::start();
    let craft = &small()["spacecraft"];
    service.send(&Request::new("PUT", "/v1/spacecraft/small").json(craft));
    let mut study = json!({
        "spacecraft": {"ref": "small"},
        "turns": [{
            "from": {"roll_pitch_yaw_deg": [0, 0, 0]},
            "to": {"roll_pitch_yaw_deg": [20, 30, 40]},
        }],
        "demands_nm": [[0.001, 0, 0]],
        "time_optimal": true,
        "options": {"torque_authority": 0.5},
    });
    let path = "/v1/studies/envelopes";
    let answer = service.post(path, &study).expect(200).json();
    assert_eq!(answer["complete"], true);
    let turn = &answer["turns"][0];
    // With three wheels the allocation is unique, so that both optima are equal.
    let times = [0, 1].map(|i| {
        turn["time_optimal"][i]["duration_s"]
            .as_f64()
            .expect("solved")
    });
    assert!((times[0] - times[1]).abs() < 1e-6 * times[0], "{times:?}");
    let samples = turn["time_optimal"][0]["path"]["torque"].as_array();
    let shares = samples.expect("a list").iter().map(|step| {
        let share = step["full_share"].as_f64().expect("a number");
        assert_eq!(
            step["pseudo_inverse_share"]
                .as_f64()
                .map(|s| (s - share).abs() < 1e-9),
            Some(true)
        );
        share
    });
    let most = shares.fold(0.0, f64::max);
    assert!(most <= 1.0 + 1e-6 && most > 1.0 - 1e-3, "{most}");
    study["spacecraft"] = json!({"ref": "other"});
    let problem = service
        .post(path, &study)
        .expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/spacecraft/ref");
}

#[test]
fn the_published_comparison_is_repeated_over_http() {
    let service = Service::start();
    let body = json!({"surface_rows": 2});
    let study = service.post("/v1/studies/comparison", &body).expect(200);
    let study = study.json();
    let crossover = study["mass"]["crossover_kg"].as_f64();
    assert!(crossover.is_some_and(|kg| (kg - 0.908).abs() < 1e-3));
    let wrong = json!({"laws": {"kind": "given", "wheel": {"factor": -1, "exponent": 9}}});
    let problem = service.post("/v1/studies/comparison", &wrong);
    let problem = problem.expect_problem(422, "invalid_input");
    let places = places(&problem);
    assert_eq!(places, ["/laws/wheel/exponent", "/laws/wheel/factor"]);
}

#[test]
fn a_flight_is_simulated_over_http() {
    let service = Service::start();
    let mut body = json!({
        "scenario": small(),
        "simulation": {"errors": {"inertia_3_sigma": 0.02}, "settle_s": 5},
        "keep_every": 20,
    });
    let answer = service.post("/v1/studies/flight", &body).expect(200).json();
    let flight = &answer["flight"];
    let time = |name: &str| flight[name].as_f64().expect("a time");
    assert!((time("flight_time_s") - time("total_time_s") - 5.0).abs() < 1e-9);
    let samples = flight["samples"].as_array().map_or(0, Vec::len);
    assert!(
        (samples as f64 - time("flight_time_s") / 2.0).abs() <= 1.0,
        "{samples}"
    );
    body["keep_every"] = json!(0);
    body["simulation"]["settle_s"] = json!(-5);
    let problem = service.post("/v1/studies/flight", &body);
    let problem = problem.expect_problem(422, "invalid_input");
    let places = places(&problem);
    assert_eq!(places, ["/keep_every", "/simulation/settle_s"]);
}

#[test]
fn a_flight_with_excessive_gains_is_reported_as_lost() {
    let service = Service::start();
    let gains = json!({"kind": "settling_time", "settling_time_s": 5e-324});
    let study = json!({
        "scenario": small(),
        "simulation": {
            "controller": {"kind": "step_input", "gains": gains},
            "errors": {"inertia_3_sigma": 0.02},
        },
    });
    let answer = service.post("/v1/studies/flight", &study).expect(200);
    let flight = &answer.json()["flight"];
    assert_eq!(flight["within_tolerance"], false);
    assert!(flight["end"]["attitude_rad"].as_f64() > Some(1e3));
}
