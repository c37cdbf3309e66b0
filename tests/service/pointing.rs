//! Pointings in the documents of the service.

use crate::running::{Service, small};
use serde_json::{Value, json};

fn star(boresight: &Value) -> Value {
    json!({"boresight": boresight, "ra_dec_deg": [20, 65]})
}

#[test]
fn a_plan_of_pointings_comes_back_with_its_rolls() {
    let service = Service::start();
    let mut scenario = small();
    let target = scenario["targets"][1].as_object_mut().expect("an object");
    target.remove("attitude");
    target.insert("pointing".into(), star(&json!([0, 0, 1])));
    let name = scenario["targets"][1]["id"].clone();
    let id = service.submit(&scenario);
    service.wait_end(&id);
    let plan = service
        .get(&format!("/v1/plans/{id}/result"))
        .expect(200)
        .json();
    for passage in plan["passages"].as_array().expect("a list") {
        let is_pointed = passage["target"] == name;
        assert_eq!(passage["roll_deg"].is_number(), is_pointed, "{passage}");
    }
    let given = service
        .get(&format!("/v1/plans/{id}/scenario"))
        .expect(200)
        .json();
    assert_eq!(
        given["targets"][1]["pointing"],
        scenario["targets"][1]["pointing"]
    );
    let both = json!({"scenario": given, "plan": plan});
    let verified = service.post("/v1/verify", &both).expect(200).json();
    assert_eq!(verified["passed"], true, "{verified}");
    for format in ["csv", "aem-kvn", "open-mct", "wheel-rpm"] {
        let path = format!("/v1/plans/{id}/result?format={format}");
        service.get(&path).expect(200);
    }
}

#[test]
fn a_query_for_legs_takes_pointings_at_both_ends_and_names_their_faults() {
    let service = Service::start();
    let pointing = |boresight: Value| json!({"pointing": star(&boresight)});
    let attitude = json!({"roll_pitch_yaw_deg": [15, 0, 10]});
    let query = |pairs: Value| json!({"spacecraft": small()["spacecraft"], "mode": "cached_only", "pairs": pairs});
    let asked = query(json!([
        {"from": pointing(json!([0, 0, 1])), "to": attitude},
        {"from": attitude, "to": pointing(json!([1, 0, 0]))},
        {"from": pointing(json!([0, 0, 1])), "to": {"pointing": {"boresight": [0, 0, 1], "direction": [1, 0, 0]}}},
    ]));
    let answer = service.post("/v1/legs/query", &asked).expect(200).json();
    assert_eq!(answer["legs"].as_array().map(Vec::len), Some(3));
    let faulty = query(json!([
        {"from": pointing(json!("radar")), "to": attitude},
        {"from": {"pointing": {"boresight": [0, 0, 1]}}, "to": {"mrp": [0, 0, 0], "pointing": star(&json!([0, 0, 1]))}},
    ]));
    let problem = service.post("/v1/legs/query", &faulty).expect(422).json();
    let found = |problem: &Value| -> Vec<(String, String)> {
        let errors = problem["errors"].as_array().expect("a list");
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        errors
            .iter()
            .map(|e| (text(&e["pointer"]), text(&e["code"])))
            .collect()
    };
    let named = [("/pairs/1/to/mrp".to_owned(), "unknown_field".to_owned())];
    assert_eq!(found(&problem), named);
    let mut readable = faulty;
    readable["pairs"][1]["to"] = attitude;
    let problem = service.post("/v1/legs/query", &readable).expect(422).json();
    let expected = [
        ("/pairs/0/from/pointing/boresight", "unknown_reference"),
        ("/pairs/1/from/pointing/direction", "missing_field"),
    ];
    let expected = expected.map(|(pointer, code)| (pointer.to_owned(), code.to_owned()));
    assert_eq!(found(&problem), expected);
}
