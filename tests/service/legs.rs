//! Leg times.

use crate::running::{Service, belt_of_cones, small};
use serde_json::{Value, json};

fn attitude(roll: f64, yaw: f64) -> Value {
    json!({"roll_pitch_yaw_deg": [roll, 0, yaw]})
}

fn sources(answer: &Value) -> Vec<&str> {
    let legs = answer["legs"].as_array().expect("a list");
    legs.iter()
        .map(|leg| leg["source"].as_str().expect("text"))
        .collect()
}

#[test]
fn a_query_computes_once_and_finds_reversed_legs() {
    let service = Service::start();
    let mut query = json!({
        "spacecraft": small()["spacecraft"], "mode": "cached_only",
        "pairs": [{"from": attitude(15.0, 10.0), "to": attitude(25.0, 50.0)}],
    });
    let ask = |query: &Value| service.post("/v1/legs/query", query).expect(200).json();
    assert_eq!(sources(&ask(&query)), ["missing"]);
    query["mode"] = json!("compute");
    let computed = ask(&query);
    assert_eq!(sources(&computed), ["computed"]);
    query["mode"] = json!("cached_only");
    query["pairs"] = json!([{"from": attitude(25.0, 50.0), "to": attitude(15.0, 10.0)}]);
    let backwards = ask(&query);
    assert_eq!(sources(&backwards), ["cached"]);
    assert_eq!(backwards["legs"][0]["key"], computed["legs"][0]["key"]);
    let times = [&backwards, &computed].map(|answer| answer["legs"][0]["duration_s"].as_f64());
    let [Some(back), Some(forth)] = times else {
        panic!("{times:?}");
    };
    // The same intervals, added in the other order.
    assert!((back - forth).abs() < 1e-12 * forth, "{back} {forth}");
    let key = computed["legs"][0]["key"].as_str().expect("a key");
    let leg = service.get(&format!("/v1/legs/{key}")).expect(200).json();
    let controls = leg["trajectory"]["controls"].as_array().expect("a list");
    let total: f64 = controls
        .iter()
        .filter_map(|control| control["duration_s"].as_f64())
        .sum();
    let duration = leg["duration_s"].as_f64().expect("a number");
    assert!((total - duration).abs() < 1e-9 * duration);
}

#[test]
fn a_query_finds_the_legs_of_a_plan() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let query = json!({
        "spacecraft": small()["spacecraft"], "mode": "cached_only",
        "attitudes": [attitude(0.0, 0.0), attitude(15.0, 10.0), attitude(25.0, 50.0)],
    });
    let answer = service.post("/v1/legs/query", &query).expect(200).json();
    assert_eq!(sources(&answer), ["cached"; 6]);
    let key = answer["spacecraft_key"].as_str().expect("a key");
    let all = service
        .get(&format!("/v1/legs?spacecraft_key={key}"))
        .expect(200)
        .json();
    assert!(all["legs"].as_array().expect("a list").len() >= 3);
    let turn = &all["legs"][0]["turn"];
    let near = ["x", "y", "z", "w"]
        .map(|part| turn[part].to_string())
        .join(",");
    let found = service
        .get(&format!("/v1/legs?attitude={near}&tolerance_deg=0.01"))
        .json();
    assert_eq!(found["legs"][0]["key"], all["legs"][0]["key"]);
    let none = service
        .get(&format!("/v1/legs?spacecraft_key={}", "0".repeat(64)))
        .json();
    assert_eq!(none["legs"], json!([]));
}

#[test]
fn certified_bounds_are_computed_without_legs_and_stored_with_solved_ones() {
    let service = Service::start();
    let mut query = json!({
        "spacecraft": small()["spacecraft"], "mode": "cached_only", "kind": "certified",
        "attitudes": [attitude(15.0, 10.0), attitude(25.0, 50.0)],
    });
    let ask = |query: &Value| service.post("/v1/legs/query", query).expect(200).json();
    assert_eq!(sources(&ask(&query)), ["missing"; 2]);
    query["mode"] = json!("compute");
    let answer = ask(&query);
    assert_eq!(answer["kind"], "certified");
    assert_eq!(sources(&answer), ["computed"; 2]);
    let leg = &answer["legs"][0];
    assert!(leg["duration_s"].is_null() && leg["key"].is_null());
    assert_eq!(leg["status"], "proved");
    let bound = leg["certified_lower_bound_s"].as_f64().expect("a bound");
    assert_eq!(service.get("/v1/legs").json()["legs"], json!([]));

    query["kind"] = json!("rest_to_rest");
    for source in ["computed", "cached"] {
        let answer = ask(&query);
        assert_eq!(sources(&answer), [source; 2]);
        let leg = &answer["legs"][0];
        assert_eq!(leg["certified_lower_bound_s"].as_f64(), Some(bound));
        assert!(leg["duration_s"].as_f64().expect("a time") > bound);
    }
    let listed = service.get("/v1/legs").expect(200).json();
    assert_eq!(
        listed["legs"][0]["certified_lower_bound_s"].as_f64(),
        Some(bound)
    );
}

/// Keys of the legs between two attitudes, quaternions `x,y,z,w`.
fn found_between(service: &Service, from: &str, to: &str) -> Vec<String> {
    let page = service
        .get(&format!("/v1/legs?from={from}&attitude={to}"))
        .expect(200)
        .json();
    let legs = page["legs"].as_array().expect("a list");
    legs.iter()
        .map(|leg| leg["key"].as_str().expect("a key").to_owned())
        .collect()
}

#[test]
fn a_leg_is_listed_by_its_attitudes_in_both_directions_if_reversible() {
    let service = Service::start();
    // A rotation of 60 degrees about x, from an attitude 90 degrees about z away from the
    // reference.
    let ends = [
        "0,0,0.707106781,0.707106781",
        "0.353553391,0.353553391,0.612372436,0.612372436",
    ];
    let place = |text: &str| {
        let parts: Vec<f64> = text
            .split(',')
            .map(|part| part.parse().expect("a number"))
            .collect();
        json!({"quaternion": {"x": parts[0], "y": parts[1], "z": parts[2], "w": parts[3]}})
    };
    let mut query = json!({
        "spacecraft": small()["spacecraft"], "mode": "compute",
        "pairs": [{"from": place(ends[0]), "to": place(ends[1])}],
    });
    let computed = |query: &Value| {
        let answer = service.post("/v1/legs/query", query).expect(200).json();
        assert_eq!(sources(&answer), ["computed"]);
        answer["legs"][0]["key"].as_str().expect("a key").to_owned()
    };
    let symmetric = computed(&query);
    for (from, to) in [(ends[0], ends[1]), (ends[1], ends[0])] {
        assert_eq!(found_between(&service, from, to), [symmetric.as_str()]);
    }
    // The rotation from the identity; absolute attitudes of the ends do not count.
    assert_eq!(
        found_between(&service, "0,0,0,1", "0.5,0,0,0.866025404"),
        [symmetric.as_str()]
    );
    assert_eq!(found_between(&service, "0,0,0,1", ends[1]), [""; 0]);

    // With stored momentum the reversed leg is another one.
    query["start"] = json!({"attitude": place("0,0,0,1"), "wheel_speed_rad_s": [30, 20, 10]});
    let forth = computed(&query);
    query["pairs"] = json!([{"from": place(ends[1]), "to": place(ends[0])}]);
    let back = computed(&query);
    assert_eq!(
        found_between(&service, ends[0], ends[1]),
        [symmetric.clone(), forth]
    );
    assert_eq!(found_between(&service, ends[1], ends[0]), [symmetric, back]);
}

/// A query for a quarter turn from a yaw angle, whose camera passes a bright body halfway.
fn past_a_bright_body(from_yaw: f64) -> Value {
    let mut spacecraft = small()["spacecraft"].clone();
    spacecraft["boresights"] = json!([{"name": "camera", "axis": [1, 0, 0]}]);
    let (y, x) = (from_yaw + 45.0).to_radians().sin_cos();
    json!({
        "spacecraft": spacecraft, "mode": "compute",
        "pairs": [{"from": attitude(0.0, from_yaw), "to": attitude(0.0, from_yaw + 90.0)}],
        "keep_out": [{"boresight": "camera", "direction": [x, y, 0.05], "half_angle_deg": 25}],
    })
}

#[test]
fn legs_lead_around_cones_and_are_shared_by_equal_situations() {
    let service = Service::start();
    let ask = |query: &Value| {
        let answer = service.post("/v1/legs/query", query).expect(200).json();
        answer["legs"][0].clone()
    };
    let query = past_a_bright_body(0.0);
    let mut free = query.clone();
    free["keep_out"][0]["applies"] = json!("at_targets");
    let through = ask(&free);
    assert_eq!(through["source"], "computed");
    // The leg without the cone is known, and is not the answer.
    let mut cached = query.clone();
    cached["mode"] = json!("cached_only");
    let missing = ask(&cached);
    assert_eq!(missing["source"], "missing");
    assert!(missing["key"].is_null() && missing["duration_s"].is_null());
    let around = ask(&query);
    assert_eq!(around["source"], "computed");
    assert_ne!(around["key"], through["key"]);
    let time = |leg: &Value| leg["duration_s"].as_f64().expect("a time");
    assert!(time(&around) > 1.001 * time(&through));
    assert!(around["certified_lower_bound_s"].as_f64() <= Some(time(&around)));
    for (leg, count) in [(&through, 0), (&around, 1)] {
        let key = leg["key"].as_str().expect("a key");
        let stored = service.get(&format!("/v1/legs/{key}")).expect(200).json();
        assert_eq!(stored["cones"], count);
        assert_eq!(stored["keep_out"].as_array().map(Vec::len), Some(count));
        if count == 1 {
            let cone = &stored["keep_out"][0];
            assert_eq!(cone["boresight_axis"], json!([1.0, 0.0, 0.0]));
            let angle = cone["half_angle_deg"].as_f64().expect("a number");
            assert!((angle - 25.0).abs() < 1e-9, "{cone}");
        }
    }
    // The same turn past the same cone elsewhere.
    for yaw in [0.0, 30.0] {
        let mut elsewhere = past_a_bright_body(yaw);
        elsewhere["mode"] = json!("cached_only");
        let found = ask(&elsewhere);
        assert_eq!(
            (&found["source"], &found["key"]),
            (&json!("cached"), &around["key"])
        );
    }
}

#[test]
fn queries_without_a_way_and_with_wrong_cones_are_told() {
    let service = Service::start();
    // Closed, and closed by less than the search resolves.
    for (half_angle_deg, status) in [(20.0, "infeasible"), (15.0005, "no_clear_path")] {
        let mut enclosed = past_a_bright_body(0.0);
        enclosed["spacecraft"]["boresights"][0]["axis"] = json!([0, 0, 1]);
        enclosed["pairs"] = json!([{"from": attitude(0.0, 0.0), "to": attitude(180.0, 0.0)}]);
        enclosed["keep_out"] = belt_of_cones(half_angle_deg);
        let answer = service.post("/v1/legs/query", &enclosed).expect(200).json();
        let leg = &answer["legs"][0];
        assert_eq!(leg["status"], status);
        assert!(leg["duration_s"].is_null() && leg["key"].is_null(), "{leg}");
        assert_eq!(leg["source"], "missing");
    }

    let refused = |query: &Value| {
        let problem = service.post("/v1/legs/query", query);
        let problem = problem.expect_problem(422, "invalid_input");
        problem["errors"][0].clone()
    };
    for applies in ["always", "at_targets"] {
        let mut query = past_a_bright_body(0.0);
        query["keep_out"][0]["direction"] = json!([0, 1, 0]);
        query["keep_out"][0]["applies"] = json!(applies);
        let error = refused(&query);
        assert_eq!(error["pointer"], "/pairs/0/to");
        assert_eq!(error["code"], "attitude_violates_cone");
    }
    let mut query = past_a_bright_body(0.0);
    query["keep_in"] =
        json!([{"boresight": "camera", "direction": {"body": "sun"}, "half_angle_deg": 0}]);
    let found: Vec<Value> = {
        let problem = service.post("/v1/legs/query", &query);
        let problem = problem.expect_problem(422, "invalid_input");
        problem["errors"].as_array().expect("a list").clone()
    };
    let codes: Vec<_> = found
        .iter()
        .map(|error| (&error["pointer"], &error["code"]))
        .collect();
    assert_eq!(
        codes,
        [
            (&json!("/keep_in/0/direction"), &json!("epoch_required")),
            (&json!("/keep_in/0/half_angle_deg"), &json!("out_of_range")),
        ]
    );
    // No leg begins at the start, which only says what the momentum is.
    let mut beside = past_a_bright_body(100.0);
    beside["keep_out"][0]["direction"] = json!([1, 0, 0]);
    let answer = service.post("/v1/legs/query", &beside).expect(200).json();
    assert_eq!(sources(&answer), ["computed"]);
}

#[test]
fn wrong_queries_are_refused_with_pointers() {
    let service = Service::start();
    let spacecraft = &small()["spacecraft"];
    let cases = [
        (json!({"spacecraft": spacecraft}), "/attitudes"),
        (
            json!({"spacecraft": spacecraft, "attitudes": [attitude(0.0, 0.0)]}),
            "/attitudes",
        ),
        (json!({"spacecraft": spacecraft, "pairs": []}), "/pairs"),
        (
            json!({"spacecraft": spacecraft, "pairs": [{"from": attitude(0.0, 0.0),
                "to": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 2}}}]}),
            "/pairs/0/to/quaternion",
        ),
        (
            json!({"spacecraft": spacecraft, "pairs": [{}], "kind": "fast"}),
            "/pairs/0/from",
        ),
    ];
    for (query, pointer) in cases {
        let problem = service
            .post("/v1/legs/query", &query)
            .expect_problem(422, "invalid_input");
        assert_eq!(problem["errors"][0]["pointer"], pointer, "{problem}");
    }
    let attitudes: Vec<Value> = (0..40)
        .map(|number| attitude(f64::from(number), 0.0))
        .collect();
    let query = json!({"spacecraft": spacecraft, "attitudes": attitudes, "mode": "compute"});
    let problem = service
        .post("/v1/legs/query", &query)
        .expect_problem(413, "too_many_pairs");
    assert!(
        problem["detail"]
            .as_str()
            .expect("text")
            .contains("max_leg_pairs")
    );
    // The matrix of all pairs would not fit into memory.
    let query = json!({"spacecraft": spacecraft, "attitudes": vec![attitude(1.0, 0.0); 20_000]});
    service
        .post("/v1/legs/query", &query)
        .expect_problem(413, "too_many_pairs");
    service
        .get("/v1/legs/unknown")
        .expect_problem(404, "not_found");
    for wrong in [
        "attitude=1,2",
        "from=1,2,3",
        "tolerance_deg=-1",
        "limit=0",
        "spacecraft_key=x",
    ] {
        service
            .get(&format!("/v1/legs?{wrong}"))
            .expect_problem(400, "invalid_parameter");
    }
    let nowhere = service
        .get("/v1/legs?attitude=0,0,0,0")
        .expect_problem(422, "invalid_input");
    assert_eq!(nowhere["errors"][0]["pointer"], "/attitude");
    assert_eq!(nowhere["errors"][0]["code"], "zero_direction");
    let mut unknown = json!({"attitudes": [attitude(0.0, 0.0), attitude(1.0, 0.0)]});
    unknown["spacecraft"] = json!({"ref": "nowhere"});
    let problem = service
        .post("/v1/legs/query", &unknown)
        .expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/spacecraft/ref");
}
