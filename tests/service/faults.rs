//! Injected failures of solves: their effects and their errors.

use crate::client::Request;
use crate::running::{Service, large, small};
use serde_json::{Value, json};

fn failing(mut scenario: Value, fault: &str) -> Value {
    scenario["name"] = json!(fault);
    scenario
}

/// The last event of a job that has ended.
fn last_event(service: &Service, id: &str) -> Value {
    let stream = service.get(&format!("/v1/plans/{id}/events")).expect(200);
    let data = stream.body.lines().rev();
    let last = data.filter_map(|line| line.strip_prefix("data:")).next();
    serde_json::from_str(last.expect("an event")).expect("JSON")
}

#[test]
fn a_panic_keeps_the_best_plan() {
    let service = Service::start();
    let id = service.submit(&failing(large(), "fault:late"));
    service.wait(&id, |job| !job["incumbent_s"].is_null());
    let path = format!("/v1/plans/{id}/result");
    let before = service.get(&path).expect(200).json();
    service
        .send(&Request::new("POST", &format!("/v1/plans/{id}/stop")))
        .expect(200);
    let job = service.wait_end(&id);
    assert_eq!(
        (&job["state"], &job["code"]),
        (&json!("failed"), &json!("internal_error"))
    );
    let last = service.get(&path).expect(200);
    assert_eq!(last.header("job-state"), Some("failed"));
    let plan = last.json();
    assert_eq!(plan["verification"]["passed"], true);
    assert!(plan["total_time_s"].as_f64() <= before["total_time_s"].as_f64());
    assert_eq!(job["incumbent_s"], plan["total_time_s"]);
    assert_eq!(last_event(&service, &id)["code"], "internal_error");
}

#[test]
fn a_panic_ends_one_of_several_jobs() {
    let service = Service::start_with(&["--jobs", "2", "--threads", "1"]);
    let long = service.submit(&large());
    service.wait(&long, |job| !job["incumbent_s"].is_null());
    let failed = service.submit(&failing(small(), "fault:panic"));
    assert_eq!(service.wait_end(&failed)["state"], "failed");
    assert_eq!(service.job(&long)["state"], "running");
    // The thread of the failed one goes on.
    let next = service.submit(&small());
    assert_eq!(service.wait_end(&next)["state"], "succeeded");
    service.post(&format!("/v1/plans/{long}/stop"), &json!({}));
    assert_eq!(service.wait_end(&long)["state"], "stopped");
}

#[test]
fn memory_limits_and_panics_have_different_codes() {
    let service = Service::start_with(&["--job-memory", "16"]);
    let end = |fault: &str| {
        let id = service.submit(&failing(small(), fault));
        let job = service.wait_end(&id);
        assert_eq!(job["state"], "failed", "{job}");
        (id, job["code"].as_str().expect("a code").to_owned())
    };
    let (panicked, code) = end("fault:panic");
    assert_eq!(code, "internal_error");
    service
        .get(&format!("/v1/plans/{panicked}/result"))
        .expect_problem(409, "no_result");
    let (starved, code) = end("fault:memory");
    assert_eq!(code, "memory_limit");
    let plan = service.get(&format!("/v1/plans/{starved}/result"));
    let plan = plan.expect(200).json();
    assert_eq!(plan["status"], "failed");
    assert_eq!(plan["reasons"][0]["code"], "memory_limit");
    assert_eq!(last_event(&service, &starved)["code"], "memory_limit");
}
