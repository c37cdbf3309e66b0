//! The best plan so far of a running job.

use crate::client::{Answer, Request};
use crate::running::{ALONE, Service, large, small};
use serde_json::{Value, json};

/// Waits for the first plan of a running job; the path of its result.
fn first_plan(service: &Service, id: &str) -> String {
    service.wait(id, |job| !job["incumbent_s"].is_null());
    format!("/v1/plans/{id}/result")
}

fn total(plan: &Value) -> f64 {
    plan["total_time_s"].as_f64().expect("a duration")
}

fn tag(answer: &Answer) -> String {
    answer.header("etag").expect("a tag").to_owned()
}

#[test]
fn a_running_job_gives_a_verified_plan_with_its_bound() {
    let service = Service::start();
    let submission = Request::new("POST", "/v1/plans").header("Idempotency-Key", "best-so-far");
    let submission = submission.json(&large());
    let job = service.send(&submission).expect(202).json();
    let id = job["id"].as_str().expect("an identifier");
    let path = first_plan(&service, id);

    let running = service.get(&path).expect(200);
    assert_eq!(running.header("job-state"), Some("running"));
    let plan = running.json();
    assert_eq!(plan["status"], "feasible");
    assert_eq!(plan["verification"]["passed"], true);
    assert_eq!(plan["sequence"].as_array().map(Vec::len), Some(48));
    let bound = plan["lower_bound_s"].as_f64().expect("a bound");
    // With many targets the first plan is found before any bound is proved.
    assert!(0.0 <= bound && bound <= total(&plan), "{bound}");
    let job = service.job(id);
    let told = job["incumbent_s"].as_f64().expect("an incumbent");
    // The job may be newer than the result read before, never older.
    assert!(told <= total(&plan) * (1.0 + 1e-9), "{told}");
    let table = service.get(&format!("{path}?format=csv")).expect(200);
    assert!(table.body.starts_with("time_s,q_x,"));
    let again = service.send(&Request::new("GET", &path).header("If-None-Match", &tag(&running)));
    assert!([200, 304].contains(&again.status), "{again:?}");
    let verify = json!({"scenario": large(), "plan": plan});
    assert_eq!(
        service.post("/v1/verify", &verify).expect(200).json()["passed"],
        true
    );

    service
        .send(&Request::new("POST", &format!("/v1/plans/{id}/stop")))
        .expect(200);
    let last = service.get(&path).expect(200);
    let state = service.job(id)["state"].clone();
    assert_eq!(last.header("job-state"), state.as_str());
    assert_ne!(tag(&last), tag(&running));
    assert!(total(&last.json()) <= total(&plan) * (1.0 + 1e-9));
}

#[test]
fn waiting_for_a_plan_does_not_answer_with_the_best_so_far() {
    let service = Service::start_with(&ALONE);
    let id = service.submit(&large());
    let path = first_plan(&service, &id);
    let submission = Request::new("POST", "/v1/plans").header("Prefer", "wait=0");
    let waiting = service.send(&submission.json(&small())).expect(202).json();
    assert_eq!(waiting["state"], "queued");
    let none = service.get(&format!(
        "/v1/plans/{}/result",
        waiting["id"].as_str().expect("an identifier")
    ));
    assert_eq!(none.header("retry-after"), Some("1"));
    none.expect_problem(409, "result_not_ready");

    service
        .send(&Request::new("POST", &format!("/v1/plans/{id}/cancel")))
        .expect(200);
    service.get(&path).expect_problem(409, "no_result");
}

#[test]
fn the_best_plan_so_far_survives_a_kill_and_is_not_final() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("killed.db");
    let mut service = Service::on(&database, &[]);
    let id = service.submit(&large());
    let path = first_plan(&service, &id);
    let before = service.get(&path).expect(200).json();
    service.kill();

    let service = Service::on(&database, &[]);
    let after = service.get(&path).expect(200);
    assert!(matches!(
        after.header("job-state"),
        Some("queued" | "running")
    ));
    let kept = after.json();
    assert_eq!(kept["status"], "feasible");
    assert!(total(&kept) <= total(&before));
    // The stop may arrive before or after the second attempt has a plan.
    service.wait(&id, |job| job["state"] == "running");
    service
        .send(&Request::new("POST", &format!("/v1/plans/{id}/stop")))
        .expect(200);
    let job = service.job(&id);
    assert_eq!(
        (&job["state"], &job["attempt"]),
        (&json!("stopped"), &json!(2))
    );
    let last = service.get(&path).expect(200);
    assert_eq!(last.header("job-state"), Some("stopped"));
    assert!(total(&last.json()) <= total(&before));
    assert_eq!(job["incumbent_s"], last.json()["total_time_s"]);
}
