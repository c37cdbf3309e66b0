//! Jobs from submission to deletion.

use crate::client::Request;
use crate::running::{ALONE, Service, large, pause, small};
use serde_json::{Value, json};

#[test]
fn a_job_ends_with_a_verified_plan() {
    let service = Service::start();
    let id = service.submit(&small());
    let job = service.wait_end(&id);
    assert_eq!(
        (&job["state"], &job["attempt"]),
        (&json!("succeeded"), &json!(1))
    );
    assert_eq!(
        (&job["name"], &job["targets"]),
        (&json!("two-targets"), &json!(2))
    );
    let answer = service.get(&format!("/v1/plans/{id}/result")).expect(200);
    let plan = answer.json();
    assert_eq!(plan["status"], "optimal");
    assert_eq!(plan["verification"]["passed"], true);
    assert_eq!(plan["total_time_s"], job["incumbent_s"]);

    let tag = answer.header("etag").expect("a tag");
    let again = Request::new("GET", &format!("/v1/plans/{id}/result")).header("If-None-Match", tag);
    assert_eq!(service.send(&again).expect(304).body, "");
}

#[test]
fn the_list_says_which_plans_violate_a_cone() {
    let service = Service::start();
    let clear = service.submit(&small());
    let mut scenario = small();
    // Around where the camera looks at the begin.
    scenario["keep_out"] = json!([{"boresight": "camera", "direction": [0, 0, 1],
        "half_angle_deg": 5, "applies": "report"}]);
    let violated = service.submit(&scenario);
    scenario["keep_out"][0]["applies"] = json!("always");
    let infeasible = service.submit(&scenario);
    let expected = [
        (&clear, "succeeded", json!(false)),
        (&violated, "succeeded", json!(true)),
        (&infeasible, "infeasible", json!(null)),
    ];
    for (id, state, flag) in &expected {
        let job = service.wait_end(id);
        assert_eq!(
            (&job["state"], &job["keep_out_violated"]),
            (&json!(state), flag)
        );
    }
    let page = service.get("/v1/plans").expect(200).json();
    for job in page["plans"].as_array().expect("a list") {
        let (_, _, flag) = expected
            .iter()
            .find(|(id, ..)| job["id"] == **id)
            .expect("one of them");
        assert_eq!(&job["keep_out_violated"], flag, "{job}");
    }
}

#[test]
fn a_second_run_solves_no_leg_and_gives_the_same_plan() {
    let service = Service::start();
    let plan = || {
        let request = Request::new("POST", "/v1/plans").header("Prefer", "wait=60");
        let mut plan = service.send(&request.json(&small())).expect(200).json();
        (plan["statistics"].take(), plan)
    };
    let (cold, first) = plan();
    let (warm, second) = plan();
    assert_eq!(cold["legs_from_cache"], 0);
    assert_eq!(warm["legs_solved"], 0);
    assert_eq!(warm["legs_from_cache"], cold["legs_solved"]);
    assert_eq!(first, second);
}

#[test]
fn the_form_of_a_result_is_selected_by_query_or_by_accept() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let path = format!("/v1/plans/{id}/result");
    let by_query = service.get(&format!("{path}?format=csv")).expect(200);
    assert!(by_query.body.starts_with("time_s,q_x,"));
    let accepting = |form: &str| service.send(&Request::new("GET", &path).header("Accept", form));
    assert_eq!(accepting("text/csv").expect(200).body, by_query.body);
    accepting("image/png").expect_problem(406, "not_acceptable");
    service
        .get(&format!("{path}?format=xml"))
        .expect_problem(400, "invalid_parameter");
}

#[test]
fn validate_only_queues_nothing() {
    let service = Service::start();
    let valid = service
        .post("/v1/plans?validate_only=true", &small())
        .expect(200)
        .json();
    assert_eq!(
        (&valid["valid"], &valid["errors"]),
        (&json!(true), &json!([]))
    );
    let mut wrong = small();
    wrong["targets"][1]["id"] = json!("a");
    let problem = service.post("/v1/plans?validate_only=true", &wrong);
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/targets/1/id");
    assert_eq!(problem["warnings"], json!([]));
    let off = json!({"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1.0005}});
    wrong["targets"][0]["attitude"] = off.clone();
    for path in ["/v1/plans?validate_only=true", "/v1/plans"] {
        let problem = service.post(path, &wrong);
        let problem = problem.expect_problem(422, "invalid_input");
        assert_eq!(problem["errors"].as_array().map(Vec::len), Some(1));
        assert_eq!(problem["warnings"][0]["code"], "attitude_normalized");
    }
    let mut impossible = too_much_momentum();
    impossible["targets"][0]["attitude"] = off;
    let problem = service.post("/v1/plans?validate_only=true", &impossible);
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["code"], "momentum_exceeds_envelope");
    assert_eq!(problem["warnings"][0]["code"], "attitude_normalized");
    assert_eq!(
        service.get("/v1/plans").expect(200).json()["plans"],
        json!([])
    );
}

/// A scenario with momentum that the wheels cannot hold at rest.
fn too_much_momentum() -> Value {
    let mut scenario = small();
    scenario["start"]["wheel_speed_rad_s"] = json!([700, 700, 700]);
    scenario["options"] = json!({"momentum_authority": 1.0});
    scenario
}

#[test]
fn an_infeasible_scenario_ends_with_its_reasons() {
    let service = Service::start();
    let id = service.submit(&too_much_momentum());
    let job = service.wait_end(&id);
    assert_eq!(job["state"], "infeasible", "{job}");
    let plan = service
        .get(&format!("/v1/plans/{id}/result"))
        .expect(200)
        .json();
    assert_eq!(plan["status"], "infeasible");
    assert_eq!(plan["reasons"][0]["code"], "momentum_exceeds_envelope");
    service
        .get(&format!("/v1/plans/{id}/result?format=csv"))
        .expect_problem(409, "no_result");
}

#[test]
fn a_time_limit_without_a_plan_is_a_failure_with_its_reason() {
    let service = Service::start();
    let mut scenario = small();
    scenario["options"] = json!({"time_limit_s": 1e-6});
    let id = service.submit(&scenario);
    let job = service.wait_end(&id);
    assert_eq!(
        (&job["state"], &job["code"]),
        (&json!("failed"), &json!("stopped_without_plan"))
    );
    let plan = service.get(&format!("/v1/plans/{id}/result")).expect(200);
    let reason = &plan.json()["reasons"][0];
    assert_eq!(reason["code"], "stopped_without_plan");
    assert_eq!(reason["pointer"], "/options/time_limit_s");
}

#[test]
fn a_list_is_filtered_and_paged() {
    let service = Service::start();
    let ids: Vec<String> = (0..3)
        .map(|number| {
            let mut scenario = small();
            scenario["name"] = json!(format!("n{number}"));
            service.submit(&scenario)
        })
        .collect();
    for id in &ids {
        service.wait_end(id);
    }
    let identifiers = |page: &Value| -> Vec<String> {
        let plans = page["plans"].as_array().expect("a list");
        plans
            .iter()
            .map(|job| job["id"].as_str().expect("text").to_owned())
            .collect()
    };
    let first = service.get("/v1/plans?limit=2").expect(200).json();
    assert_eq!(identifiers(&first), [ids[2].clone(), ids[1].clone()]);
    let cursor = first["next_cursor"].as_str().expect("there is more");
    let second = service
        .get(&format!("/v1/plans?limit=2&cursor={cursor}"))
        .expect(200)
        .json();
    assert_eq!(identifiers(&second), [ids[0].clone()]);
    assert!(second["next_cursor"].is_null());
    let named = service
        .get("/v1/plans?name=n1&state=succeeded")
        .expect(200)
        .json();
    assert_eq!(identifiers(&named), [ids[1].clone()]);
    for wrong in [
        "limit=0",
        "limit=x",
        "state=asleep",
        "cursor=-1",
        "colour=red",
    ] {
        service
            .get(&format!("/v1/plans?{wrong}"))
            .expect_problem(400, "invalid_parameter");
    }
}

#[test]
fn a_list_is_searched_by_parts_of_names_and_identifiers() {
    let service = Service::start();
    let names = ["Comet 67P 50% lit", "comet_tail", "cometatail", "moon"];
    let ids = names.map(|name| {
        let mut scenario = small();
        scenario["name"] = json!(name);
        service.submit(&scenario)
    });
    let unnamed = {
        let mut scenario = small();
        scenario.as_object_mut().expect("an object").remove("name");
        service.submit(&scenario)
    };
    let found = |search: &str| -> Vec<String> {
        let page = service.get(&format!("/v1/plans?search={search}"));
        let page = page.expect(200).json();
        let plans = page["plans"].as_array().expect("a list").iter();
        let id = |job: &Value| job["id"].as_str().expect("text").to_owned();
        plans.map(id).collect()
    };
    let of = |numbers: &[usize]| -> Vec<String> {
        let newest_first = numbers.iter().rev();
        newest_first.map(|&number| ids[number].clone()).collect()
    };
    assert_eq!(found("COMET"), of(&[0, 1, 2]));
    assert_eq!(found("et_t"), of(&[1]));
    assert_eq!(found("50%25"), of(&[0]));
    assert_eq!(found("nowhere"), of(&[]));
    assert_eq!(found(&ids[3][..36].to_uppercase()), of(&[3]));
    assert_eq!(found(&unnamed), std::slice::from_ref(&unnamed));
    let both = service.get("/v1/plans?search=comet&name=comet_tail");
    assert_eq!(both.expect(200).json()["plans"][0]["id"], json!(ids[1]));
}

#[test]
fn a_name_may_be_long() {
    let service = Service::start();
    let mut scenario = small();
    let parts = (1_u64..1_000).map(|n| format!("{:x}", n.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    scenario["name"] = json!(parts.collect::<String>());
    let id = service.submit(&scenario);
    let job = service.get(&format!("/v1/plans/{id}")).expect(200).json();
    assert_eq!(job["name"], scenario["name"]);
}

#[test]
fn stop_answers_with_the_best_plan_so_far() {
    let service = Service::start_with(&ALONE);
    let id = service.submit(&large());
    let queued = service.submit(&small());
    service
        .post(&format!("/v1/plans/{queued}/stop"), &json!(null))
        .expect_problem(409, "not_running");
    service
        .get(&format!("/v1/plans/{id}/result"))
        .expect_problem(409, "result_not_ready");
    service.wait(&id, |job| !job["incumbent_s"].is_null());
    let job = service
        .send(&Request::new("POST", &format!("/v1/plans/{id}/stop")))
        .expect(200)
        .json();
    assert!(
        job["state"] == "stopped" || job["state"] == "succeeded",
        "{job}"
    );
    let plan = service
        .get(&format!("/v1/plans/{id}/result"))
        .expect(200)
        .json();
    assert_eq!(plan["verification"]["passed"], true);
    assert!(plan["lower_bound_s"].as_f64() <= plan["total_time_s"].as_f64());
    service
        .post(&format!("/v1/plans/{id}/cancel"), &json!(null))
        .expect_problem(409, "job_has_ended");
}

#[test]
fn cancel_frees_the_threads_for_the_next_job() {
    let service = Service::start_with(&ALONE);
    let id = service.submit(&large());
    let next = service.submit(&small());
    service.wait(&id, |job| job["state"] == "running");
    let cancel = Request::new("POST", &format!("/v1/plans/{id}/cancel"));
    assert_eq!(
        service.send(&cancel).expect(200).json()["state"],
        "cancelled"
    );
    assert_eq!(
        service.send(&cancel).expect(200).json()["state"],
        "cancelled"
    );
    assert_eq!(service.wait_end(&next)["state"], "succeeded");
    service
        .get(&format!("/v1/plans/{id}/result"))
        .expect_problem(409, "no_result");
}

#[test]
fn waiting_for_a_cancelled_job_is_answered_with_its_end() {
    let service = Service::start_with(&ALONE);
    let first = service.submit(&large());
    service.wait(&first, |job| job["state"] == "running");
    let submission = Request::new("POST", "/v1/plans")
        .header("Prefer", "wait=60")
        .header("Idempotency-Key", "waited-for")
        .json(&small());
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| service.send(&submission));
        // Queued behind the running job.
        let id = loop {
            let queued = service.get("/v1/plans?state=queued").expect(200).json();
            if let Some(id) = queued["plans"][0]["id"].as_str() {
                break id.to_owned();
            }
            pause();
        };
        let cancel = Request::new("POST", &format!("/v1/plans/{id}/cancel"));
        service.send(&cancel).expect(200);
        let answer = waiting.join().expect("an answer").expect(200);
        assert_eq!(answer.header("location"), Some(&*format!("/v1/plans/{id}")));
        let job = answer.json();
        assert_eq!(
            (&job["id"], &job["state"]),
            (&json!(id), &json!("cancelled"))
        );
    });
    // The same request again does not wait.
    let again = service.send(&submission).expect(200);
    assert_eq!(again.json()["state"], "cancelled");
}

#[test]
fn deleting_a_running_job_cancels_it() {
    let service = Service::start_with(&ALONE);
    let id = service.submit(&large());
    let next = service.submit(&small());
    service.wait(&id, |job| job["state"] == "running");
    let path = format!("/v1/plans/{id}");
    assert_eq!(
        service
            .send(&Request::new("DELETE", &path))
            .expect(204)
            .body,
        ""
    );
    for gone in [Request::new("DELETE", &path), Request::new("GET", &path)] {
        service.send(&gone).expect_problem(404, "not_found");
    }
    for part in ["result", "events"] {
        service
            .get(&format!("{path}/{part}"))
            .expect_problem(404, "not_found");
    }
    for act in ["stop", "cancel"] {
        service
            .send(&Request::new("POST", &format!("{path}/{act}")))
            .expect_problem(404, "not_found");
    }
    assert_eq!(service.wait_end(&next)["state"], "succeeded");
}
