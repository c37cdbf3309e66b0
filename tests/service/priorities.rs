//! The priority of a submission.

use crate::running::{ALONE, Service, large, small};
use serde_json::json;

#[test]
fn greater_priorities_are_solved_first() {
    let service = Service::start_with(&ALONE);
    let running = service.submit(&large());
    service.wait(&running, |job| job["state"] == "running");
    let submit = |priority: i64| {
        let path = format!("/v1/plans?priority={priority}");
        let job = service.post(&path, &small()).expect(202).json();
        assert_eq!(job["priority"], priority);
        job["id"].as_str().expect("an identifier").to_owned()
    };
    let ids = [-10, 0, 10].map(submit);
    service.post(&format!("/v1/plans/{running}/cancel"), &json!({}));
    let [last, second, first] = ids.map(|id| {
        let job = service.wait_end(&id);
        let started = job["started_at"].as_str().expect("a time");
        started.to_owned()
    });
    assert!(first < second && second < last, "{first} {second} {last}");
}

#[test]
fn priorities_have_limits() {
    let service = Service::start();
    for path in ["/v1/plans", "/v1/leg-tables"] {
        for priority in ["-11", "11", "high", ""] {
            let path = format!("{path}?priority={priority}");
            service
                .post(&path, &small())
                .expect_problem(400, "invalid_parameter");
        }
    }
}
