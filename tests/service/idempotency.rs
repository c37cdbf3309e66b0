//! Idempotency keys.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::{Value, json};

#[test]
fn a_key_makes_one_job_and_belongs_to_one_body() {
    let service = Service::start();
    let submit = |scenario: &Value, key: &str| {
        service.send(
            &Request::new("POST", "/v1/plans")
                .header("Idempotency-Key", key)
                .json(scenario),
        )
    };
    let first = submit(&small(), "k1").expect(202);
    assert_eq!(first.header("idempotency-replayed"), None);
    let again = submit(&small(), "k1").expect(202);
    assert_eq!(again.header("idempotency-replayed"), Some("true"));
    assert_eq!(first.json()["id"], again.json()["id"]);
    let mut other = small();
    other["name"] = json!("other");
    submit(&other, "k1").expect_problem(422, "idempotency_key_reused");
    submit(&other, "k2").expect(202);
    submit(&other, "two words").expect_problem(400, "invalid_parameter");
    assert_eq!(
        service.get("/v1/plans").json()["plans"]
            .as_array()
            .map(Vec::len),
        Some(2)
    );
}

#[test]
fn concurrent_requests_under_one_key_make_one_job() {
    let service = Service::start();
    let ids: Vec<String> = std::thread::scope(|scope| {
        let submit = || {
            let request = Request::new("POST", "/v1/plans").header("Idempotency-Key", "same");
            service.send(&request.json(&small())).expect(202).json()["id"].to_string()
        };
        let threads: Vec<_> = (0..16).map(|_| scope.spawn(submit)).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().expect("an answer"))
            .collect()
    });
    assert!(ids.iter().all(|id| *id == ids[0]));
    assert_eq!(
        service.get("/v1/plans").json()["plans"]
            .as_array()
            .map(Vec::len),
        Some(1)
    );
}

#[test]
fn refused_requests_do_not_use_up_their_key() {
    let service = Service::start();
    let submit = |scenario: &Value| {
        service.send(
            &Request::new("POST", "/v1/plans")
                .header("Idempotency-Key", "k")
                .json(scenario),
        )
    };
    submit(&json!({})).expect_problem(422, "invalid_input");
    submit(&small()).expect(202);
}
