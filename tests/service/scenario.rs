//! Reading the scenario of a job.

use crate::client::Request;
use crate::running::{Service, small};
use serde_json::json;

#[test]
fn the_scenario_of_a_job_is_returned_as_submitted() {
    let service = Service::start();
    let id = service.submit(&small());
    let path = format!("/v1/plans/{id}/scenario");
    let answer = service.get(&path).expect(200);
    assert_eq!(answer.json(), small());
    assert_eq!(answer.header("content-type"), Some("application/json"));
    let tag = answer.header("etag").expect("a tag");
    let again = Request::new("GET", &path).header("If-None-Match", tag);
    service.send(&again).expect(304);
    service
        .get("/v1/plans/nothing/scenario")
        .expect_problem(404, "not_found");
}

#[test]
fn the_scenario_of_a_job_has_a_stored_spacecraft_written_out() {
    let service = Service::start();
    let spacecraft = small()["spacecraft"].clone();
    let put = Request::new("PUT", "/v1/spacecraft/agile").json(&spacecraft);
    service.send(&put).expect(201);
    let mut scenario = small();
    scenario["spacecraft"] = json!({"ref": "agile"});
    let id = service.submit(&scenario);
    let stored = service.get(&format!("/v1/plans/{id}/scenario")).expect(200);
    let found = stored.json();
    assert_eq!(
        found["spacecraft"]["wheels"].as_array().map(Vec::len),
        Some(3)
    );
    assert_eq!(found["targets"], scenario["targets"]);
}
