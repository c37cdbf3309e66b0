//! Several jobs of one process, which share its threads.

use crate::running::{Service, fixture, large, small};
use serde_json::{Value, json};

/// The plan of a job that has ended, without what depends on the machine.
fn plan(service: &Service, id: &str) -> Value {
    assert!(!service.wait_end(id).is_null());
    let answer = service.get(&format!("/v1/plans/{id}/result")).expect(200);
    let mut plan = answer.json();
    plan.as_object_mut().expect("a plan").remove("statistics");
    plan
}

/// A search that ends at the same node on any machine.
fn counted() -> Value {
    let mut scenario = fixture("olivares-b.json");
    scenario["options"] = json!({"node_limit": 40, "time_limit_s": null});
    scenario
}

#[test]
fn a_short_job_ends_while_a_long_one_runs() {
    let service = Service::start_with(&["--threads", "1"]);
    let long = service.submit(&large());
    service.wait(&long, |job| !job["incumbent_s"].is_null());
    let short = service.submit(&fixture("olivares-a.json"));
    assert_eq!(service.wait_end(&short)["state"], "succeeded");
    assert_eq!(service.job(&long)["state"], "running");
    // A request that computes gets its part too.
    let query = json!({
        "spacecraft": fixture("two-targets.json")["spacecraft"],
        "attitudes": [{"roll_pitch_yaw_deg": [0, 0, 0]}, {"roll_pitch_yaw_deg": [0, 0, 40]}],
        "kind": "rest_to_rest", "mode": "compute",
    });
    let legs = service.post("/v1/legs/query", &query).expect(200).json();
    assert!(legs["legs"][0]["duration_s"].as_f64() > Some(0.0), "{legs}");
    let stop = service.post(&format!("/v1/plans/{long}/stop"), &json!({}));
    assert!([200, 202].contains(&stop.status));
    let plan = plan(&service, &long);
    assert_eq!(plan["verification"]["passed"], true);
    assert_eq!(plan["passages"].as_array().map(Vec::len), Some(48));
}

#[test]
fn plans_do_not_depend_on_what_is_solved_beside_them() {
    let alone = Service::start_with(&["--jobs", "1", "--threads", "2"]);
    let scenarios = [counted(), fixture("olivares-a.json"), small()];
    let expected: Vec<Value> = scenarios
        .iter()
        .map(|scenario| plan(&alone, &alone.submit(scenario)))
        .collect();
    let beside = Service::start_with(&["--jobs", "3", "--threads", "2"]);
    let ids = scenarios.each_ref().map(|scenario| beside.submit(scenario));
    let plans = ids.each_ref().map(|id| plan(&beside, id));
    assert!(plans[..] == expected[..]);
}

#[test]
fn a_stop_or_a_cancellation_concerns_one_job() {
    let service = Service::start_with(&["--jobs", "3"]);
    let ids = [(); 3].map(|()| service.submit(&large()));
    for id in &ids {
        service.wait(id, |job| !job["incumbent_s"].is_null());
    }
    let running = "slewplan_running_jobs_here 3";
    let metrics = service.get("/metrics").expect(200).body;
    assert!(metrics.lines().any(|line| line == running), "{metrics}");
    service.post(&format!("/v1/plans/{}/stop", ids[0]), &json!({}));
    assert_eq!(service.wait_end(&ids[0])["state"], "stopped");
    service.post(&format!("/v1/plans/{}/cancel", ids[1]), &json!({}));
    assert_eq!(service.wait_end(&ids[1])["state"], "cancelled");
    let last = service.job(&ids[2]);
    assert_eq!(
        (&last["state"], &last["stop_requested_at"]),
        (&json!("running"), &Value::Null)
    );
}

#[test]
fn a_job_waits_while_as_many_run_as_may() {
    let service = Service::start_with(&["--jobs", "2"]);
    let limits = service.get("/v1/limits").expect(200).json();
    assert_eq!(limits["jobs_at_once"], 2);
    let long = [(); 2].map(|()| service.submit(&large()));
    for id in &long {
        service.wait(id, |job| job["state"] == "running");
    }
    let short = service.submit(&small());
    service.wait(&long[0], |job| !job["incumbent_s"].is_null());
    assert_eq!(service.job(&short)["state"], "queued");
    service.post(&format!("/v1/plans/{}/cancel", long[0]), &json!({}));
    assert_eq!(service.wait_end(&short)["state"], "succeeded");
    assert_eq!(service.job(&long[1])["state"], "running");
}

#[test]
fn jobs_that_need_all_memory_run_one_after_another_and_small_ones_beside_them() {
    // What one of them may need is more than half of it.
    let service = Service::start_with(&["--jobs", "3", "--job-memory", "160"]);
    let first = service.submit(&large());
    service.wait(&first, |job| job["state"] == "running");
    let second = service.submit(&large());
    let small = service.submit(&small());
    assert_eq!(service.wait_end(&small)["state"], "succeeded");
    assert_eq!(service.job(&second)["state"], "queued");
    service.post(&format!("/v1/plans/{first}/cancel"), &json!({}));
    service.wait(&second, |job| job["state"] == "running");
}

#[test]
fn a_shutdown_gives_all_running_jobs_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("both.db");
    let mut service = Service::on(&database, &[]);
    let ids = [(); 2].map(|()| service.submit(&large()));
    for id in &ids {
        service.wait(id, |job| !job["incumbent_s"].is_null());
    }
    assert!(service.terminate());
    let service = Service::on(&database, &[]);
    for id in &ids {
        let job = service.wait(id, |job| job["state"] == "running");
        assert_eq!(job["attempt"], 1, "{job}");
        assert!(job["incumbent_s"].as_f64() > Some(0.0), "{job}");
    }
}
