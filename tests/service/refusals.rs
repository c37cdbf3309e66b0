//! Refused requests are answered with problem details.

use crate::client::Request;
use crate::running::{Service, large, small};
use serde_json::{Value, json};

#[test]
fn every_error_is_a_problem_document() {
    let service = Service::start_with(&["--max-body-bytes", "2000", "--max-targets", "2"]);
    let post = || Request::new("POST", "/v1/plans").header("Content-Type", "application/json");
    let cases = [
        (Request::new("GET", "/nothing"), 404, "not_found"),
        (Request::new("GET", "/v1/plans/none"), 404, "not_found"),
        (Request::new("GET", "/v1/plans/%ff"), 404, "not_found"),
        (
            Request::new("PATCH", "/v1/plans"),
            405,
            "method_not_allowed",
        ),
        (
            Request::new("POST", "/v1/plans").body("{}"),
            415,
            "unsupported_media_type",
        ),
        (
            post().header("Content-Encoding", "gzip").body("{}"),
            415,
            "unsupported_media_type",
        ),
        (post().body("{"), 400, "malformed_json"),
        (post().body("[1e400]"), 400, "malformed_json"),
        (post().body(""), 400, "malformed_json"),
        (post().body("{}"), 422, "invalid_input"),
        (post().body(large().to_string()), 413, "body_too_large"),
        (
            Request::new("POST", "/v1/plans?validate_only=perhaps").json(&small()),
            400,
            "invalid_parameter",
        ),
    ];
    for (request, status, code) in cases {
        let answer = service.send(&request);
        assert!(answer.header("x-request-id").is_some(), "{request:?}");
        answer.expect_problem(status, code);
    }
    let wrong_method = service.send(&Request::new("PUT", "/v1/plans"));
    assert!(
        wrong_method
            .header("allow")
            .is_some_and(|allow| allow.contains("POST"))
    );
}

#[test]
fn a_body_of_too_many_values_is_refused_before_it_is_read() {
    let service = Service::start();
    let limits = service.get("/v1/limits").expect(200).json();
    let most = limits["max_body_values"].as_u64().expect("a number");
    // As many values as allowed, the list included; then one more.
    let zeros = |count: u64| format!("[{}0]", "0,".repeat(usize::try_from(count).unwrap() - 2));
    for (values, status, code) in [
        (most, 422, "invalid_input"),
        (most + 1, 413, "body_too_large"),
    ] {
        let request = Request::new("POST", "/v1/plans")
            .header("Content-Type", "application/json")
            .body(zeros(values));
        let problem = service.send(&request).expect_problem(status, code);
        let detail = problem["detail"].as_str().expect("text");
        assert_eq!(
            detail.contains("max_body_values"),
            values > most,
            "{detail}"
        );
    }
}

#[test]
fn more_problems_than_are_listed_are_counted() {
    let service = Service::start();
    let told = |count: usize| {
        let mut scenario = small();
        scenario["targets"] = (0..count).map(|_| json!(1)).collect();
        let answer = service.post("/v1/plans", &scenario);
        let problem = answer.expect_problem(422, "invalid_input");
        let listed = problem["errors"].as_array().expect("a list").len();
        (listed, problem["detail"].as_str().expect("text").to_owned())
    };
    assert_eq!(
        told(100),
        (100, "100 problems, listed in errors".to_owned())
    );
    let first = "101 problems, the first 100 of them listed in errors".to_owned();
    assert_eq!(told(101), (100, first));
}

#[test]
fn exceeded_limits_are_named() {
    let service = Service::start_with(&["--max-targets", "3"]);
    for (path, body) in [
        ("plans", large()),
        ("verify", json!({"scenario": large(), "plan": {}})),
        ("studies/flight", json!({"scenario": large()})),
        ("studies/authority", authorities_of(&large())),
    ] {
        let answer = service.post(&format!("/v1/{path}"), &body);
        let problem = answer.expect_problem(413, "too_many_targets");
        let detail = problem["detail"].as_str().expect("a text");
        assert!(detail.contains("max_targets"), "{detail}");
    }
    assert_eq!(
        service.get("/v1/limits").expect(200).json()["max_targets"],
        3
    );
}

#[test]
fn a_job_that_would_need_too_much_memory_is_refused() {
    let service = Service::start_with(&["--job-memory", "16"]);
    service.submit(&small());
    for (path, body) in [
        ("plans", large()),
        ("studies/flight", json!({"scenario": large()})),
        ("studies/authority", authorities_of(&large())),
    ] {
        let answer = service.post(&format!("/v1/{path}"), &body);
        let problem = answer.expect_problem(413, "too_much_memory");
        let detail = problem["detail"].as_str().expect("a text");
        assert!(detail.contains("job_memory_bytes"), "{detail}");
    }
}

/// A study of a scenario with one pair of shares.
fn authorities_of(scenario: &Value) -> Value {
    let shares = json!({"torque_authority": 1.0, "momentum_authority": 1.0});
    json!({"scenario": scenario, "authorities": [shares]})
}

#[test]
fn the_wrong_kind_of_document_is_told_in_words() {
    let service = Service::start();
    let plan = json!({"status": "optimal", "total_time_s": 1.0, "trajectory": {}});
    let swapped = json!({"scenario": plan, "plan": small()});
    let no_plan = json!({"scenario": small(), "plan": small()});
    for (path, body, pointer, words) in [
        ("/v1/plans", &plan, "", "this is a plan, not a scenario"),
        (
            "/v1/verify",
            &swapped,
            "/scenario",
            "this is a plan, not a scenario",
        ),
        (
            "/v1/verify",
            &no_plan,
            "/plan",
            "this is a scenario, not a plan",
        ),
    ] {
        let problem = service
            .post(path, body)
            .expect_problem(422, "invalid_input");
        let errors = problem["errors"].as_array().expect("a list");
        assert_eq!(errors.len(), 1, "{problem}");
        assert_eq!(errors[0]["code"], "wrong_document");
        assert_eq!(errors[0]["pointer"], pointer);
        assert_eq!(errors[0]["message"], words);
    }
    let yaml = Request::new("POST", "/v1/plans").header("Content-Type", "application/json");
    let yaml = service.send(&yaml.body("name: a\nspacecraft:\n"));
    let problem = yaml.expect_problem(400, "malformed_json");
    let detail = problem["detail"].as_str().expect("a text");
    assert!(detail.contains("looks like YAML"), "{detail}");
}

#[test]
fn a_full_queue_answers_with_retry_after() {
    let service = Service::start_with(&["--queue-limit", "1", "--jobs", "1"]);
    let running = service.submit(&large());
    service.wait(&running, |job| job["state"] == "running");
    service.submit(&small());
    let answer = service.post("/v1/plans", &small());
    assert!(answer.header("retry-after").is_some());
    answer.expect_problem(503, "queue_full");
    service
        .get("/health/ready")
        .expect_problem(503, "not_ready");
    service.get("/health/live").expect(200);
}
