//! Tables of leg times: streamed ones, and those that jobs make.

use crate::client::{Answer, Request};
use crate::running::{Service, small};
use serde_json::{Value, json};

/// A query for the full matrix of so many attitudes about two axes.
fn matrix(attitudes: usize) -> Value {
    let attitude = |number: usize| {
        let number = number as f64;
        json!({"roll_pitch_yaw_deg": [3.0 * number % 170.0, 0.0, 7.0 * number % 350.0]})
    };
    let attitudes: Vec<_> = (0..attitudes).map(attitude).collect();
    json!({"spacecraft": small()["spacecraft"], "attitudes": attitudes})
}

fn ask(service: &Service, query: &Value, accept: &str) -> Answer {
    let request = Request::new("POST", "/v1/legs/query").header("Accept", accept);
    service.send(&request.json(query))
}

fn lines(answer: &Answer) -> Vec<Value> {
    let line = |line: &str| serde_json::from_str(line).expect("a line of JSON");
    answer.body.lines().map(line).collect()
}

/// Submits a table and waits for its end.
fn made(service: &Service, query: &Value) -> Value {
    let request = Request::new("POST", "/v1/leg-tables").header("Prefer", "wait=60");
    service.send(&request.json(query)).expect(200).json()
}

fn result(service: &Service, job: &Value, query: &str) -> Answer {
    let id = job["id"].as_str().expect("an id");
    service.get(&format!("/v1/leg-tables/{id}/result{query}"))
}

#[test]
fn a_job_makes_a_table_that_is_read_in_every_form() {
    let service = Service::start();
    let query = matrix(5);
    let job = made(&service, &query);
    assert_eq!(job["state"], "succeeded");
    let counts = ["legs", "done", "cached", "computed", "missing"].map(|name| job[name].as_i64());
    assert_eq!(counts, [20, 20, 0, 20, 0].map(Some));
    let answer = result(&service, &job, "").expect(200);
    assert_eq!(answer.header("content-type"), Some("application/x-ndjson"));
    assert_eq!(answer.header("job-state"), Some("succeeded"));
    let rows = lines(&answer);
    assert_eq!(rows.len(), 20);
    for (row, place) in rows.iter().zip(0..) {
        let (from, to) = (place / 4, place % 4);
        let to = to + i32::from(to >= from);
        assert_eq!((&row["from"], &row["to"]), (&json!(from), &json!(to)));
        let (time, bound) = (&row["duration_s"], &row["certified_lower_bound_s"]);
        assert!(
            bound.as_f64() <= time.as_f64() && time.as_f64() > Some(0.0),
            "{row}"
        );
    }
    // The legs are cached, under the same keys and with the same times.
    let cached = ask(&service, &query, "application/x-ndjson").expect(200);
    let times = |rows: &[Value]| -> Vec<Value> {
        let told = |row: &Value| json!([row["duration_s"], row["key"], row["status"]]);
        rows.iter().map(told).collect()
    };
    let cached = lines(&cached);
    assert_eq!(times(&cached), times(&rows));
    assert!(cached.iter().all(|row| row["source"] == "cached"));

    let csv = result(&service, &job, "?format=csv").expect(200);
    assert_eq!(csv.header("content-type"), Some("text/csv"));
    let csv = csv.body;
    let head = "from,to,duration_s,certified_lower_bound_s,status,source,key";
    assert_eq!(csv.lines().next(), Some(head));
    assert_eq!(csv.lines().count(), 21);
    let json = result(&service, &job, "?format=json").expect(200).json();
    assert_eq!(json["legs"], Value::from(rows));
    let parquet = result(&service, &job, "?format=parquet").expect(200).bytes;
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    result(&service, &job, "?format=xml").expect_problem(400, "invalid_parameter");

    let again = made(&service, &query);
    assert_eq!(
        (&again["cached"], &again["computed"]),
        (&json!(20), &json!(0))
    );
    let id = again["id"].as_str().expect("an id");
    let events = service
        .get(&format!("/v1/leg-tables/{id}/events"))
        .expect(200);
    let events = events.body;
    assert!(events.contains(r#""done":20,"cached":20"#), "{events}");
    let listed = service.get("/v1/leg-tables").expect(200).json();
    assert_eq!(listed["leg_tables"].as_array().map(Vec::len), Some(2));
    assert_eq!(listed["leg_tables"][0]["id"], again["id"]);
}

#[test]
fn tables_and_plans_are_not_mistaken_for_each_other() {
    let service = Service::start();
    let plan = service.submit(&small());
    service.wait_end(&plan);
    let table = made(&service, &matrix(3));
    let table = table["id"].as_str().expect("an id");
    for (path, id) in [("plans", table), ("leg-tables", plan.as_str())] {
        for rest in ["", "/result", "/events"] {
            let path = format!("/v1/{path}/{id}{rest}");
            service.get(&path).expect_problem(404, "not_found");
        }
        for rest in ["/stop", "/cancel"] {
            let path = format!("/v1/{path}/{id}{rest}");
            service
                .post(&path, &json!({}))
                .expect_problem(404, "not_found");
        }
        let delete = Request::new("DELETE", &format!("/v1/{path}/{id}"));
        service.send(&delete).expect_problem(404, "not_found");
    }
    let path = format!("/v1/plans/{table}/scenario");
    service.get(&path).expect_problem(404, "not_found");
    let plans = service.get("/v1/plans").json();
    assert_eq!(plans["plans"].as_array().map(Vec::len), Some(1));
    let path = format!("/v1/leg-tables/{table}");
    service.send(&Request::new("DELETE", &path)).expect(204);
    service.get(&path).expect_problem(404, "not_found");
}

#[test]
fn a_running_table_is_read_stopped_and_cancelled() {
    let service = Service::start();
    let started = |query: &Value| {
        let job = service.post("/v1/leg-tables", query).expect(202).json();
        let id = job["id"].as_str().expect("an id").to_owned();
        let path = format!("/v1/leg-tables/{id}");
        loop {
            let job = service.get(&path).expect(200).json();
            assert!(
                job["state"] == "queued" || job["state"] == "running",
                "{job}"
            );
            if job["done"].as_i64() > Some(0) {
                return (path, job);
            }
            crate::running::pause();
        }
    };
    // Far more legs than are solved meanwhile.
    let (path, _) = started(&matrix(400));
    let partial = service.get(&format!("{path}/result")).expect(200);
    assert_eq!(partial.header("job-state"), Some("running"));
    let rows = lines(&partial);
    assert!(rows.len() >= 512 && rows[0]["source"] == "computed");
    let stopped = service.post(&format!("{path}/stop"), &json!({})).json();
    assert_eq!(stopped["state"], "stopped", "{stopped}");
    assert_eq!(
        (&stopped["detail"], &stopped["code"]),
        (
            &json!("stopped on request before all legs were solved"),
            &json!(null)
        )
    );
    let done = stopped["done"].as_u64().expect("a count");
    let kept = lines(&service.get(&format!("{path}/result")).expect(200));
    assert_eq!(kept.len() as u64, done);
    assert_eq!(kept[..rows.len()], rows);

    let mut other = matrix(401);
    other["options"] = json!({"seed": 2});
    let (path, _) = started(&other);
    let cancelled = service.post(&format!("{path}/cancel"), &json!({})).json();
    assert_eq!(cancelled["state"], "cancelled", "{cancelled}");
    let result = service.get(&format!("{path}/result"));
    result.expect_problem(409, "no_result");
    let again = service.post(&format!("{path}/stop"), &json!({}));
    again.expect_problem(409, "job_has_ended");
}

#[test]
fn an_idempotency_key_makes_one_table() {
    let service = Service::start();
    let submit = |query: &Value| {
        let request = Request::new("POST", "/v1/leg-tables").header("Idempotency-Key", "k");
        service.send(&request.json(query))
    };
    let first = submit(&matrix(3)).expect(202).json();
    let again = submit(&matrix(3)).expect(202);
    assert_eq!(again.header("idempotency-replayed"), Some("true"));
    assert_eq!(again.json()["id"], first["id"]);
    submit(&matrix(4)).expect_problem(422, "idempotency_key_reused");
    let wrong = json!({"spacecraft": small()["spacecraft"], "pairs": []});
    let problem = service.post("/v1/leg-tables", &wrong);
    let problem = problem.expect_problem(422, "invalid_input");
    assert_eq!(problem["errors"][0]["pointer"], "/pairs");
}

#[test]
fn a_killed_table_goes_on_where_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("test.db");
    let mut service = Service::on(&database, &[]);
    let query = matrix(60);
    let job = service.post("/v1/leg-tables", &query).expect(202).json();
    let path = format!("/v1/leg-tables/{}", job["id"].as_str().expect("an id"));
    while service.get(&path).json()["done"].as_i64() < Some(512) {
        crate::running::pause();
    }
    service.kill();
    let service = Service::on(&database, &[]);
    let job = loop {
        let job = service.get(&path).expect(200).json();
        if job["state"] == "succeeded" {
            break job;
        }
        assert!(
            job["state"] == "queued" || job["state"] == "running",
            "{job}"
        );
        crate::running::pause();
    };
    assert_eq!(job["attempt"], 2);
    assert_eq!(job["done"], 60 * 59);
    let rows = lines(&service.get(&format!("{path}/result")).expect(200));
    assert_eq!(rows.len(), 60 * 59);
    assert!(
        rows.iter()
            .all(|row| row["duration_s"].as_f64() > Some(0.0))
    );
}

#[test]
fn large_tables_that_solve_nothing_are_streamed() {
    let service = Service::start();
    // More than one part, and more than a query may solve.
    let mut query = matrix(100);
    query["mode"] = json!("cached_only");
    let rows = lines(&ask(&service, &query, "application/x-ndjson").expect(200));
    assert_eq!(rows.len(), 9900);
    assert_eq!(rows[9899]["from"], 99);
    assert!(rows.iter().all(|row| row["source"] == "missing"));
    query["mode"] = json!("compute");
    let refused = ask(&service, &query, "*/*").expect_problem(413, "too_many_pairs");
    let detail = refused["detail"].as_str().expect("text");
    assert!(detail.contains("max_leg_pairs"), "{detail}");
    query["kind"] = json!("certified");
    let csv = ask(&service, &query, "text/csv").expect(200);
    assert_eq!(csv.header("content-type"), Some("text/csv"));
    let plain = csv.body;
    assert_eq!(plain.lines().count(), 9901);

    let request = Request::new("POST", "/v1/legs/query").header("Accept", "text/csv");
    let request = request.header("Accept-Encoding", "gzip");
    let packed = service.send(&request.json(&query)).expect(200);
    assert_eq!(packed.header("content-encoding"), Some("gzip"));
    assert!(packed.bytes.starts_with(&[0x1f, 0x8b]) && packed.bytes.len() < plain.len() / 2);
    ask(&service, &query, "image/png").expect_problem(406, "not_acceptable");
}
