//! Large tables of legs, of which idle workers solve parts.

use crate::client::Request;
use crate::postgres;
use crate::running::{Service, Worker, fixture, pause};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

const ATTITUDES: u8 = 30;
const LEGS: i64 = ATTITUDES as i64 * (ATTITUDES as i64 - 1);

/// A query for the legs between all attitudes.
fn query() -> Value {
    let attitude = |number: u8| {
        let number = f64::from(number);
        json!({"roll_pitch_yaw_deg": [7.3 * number - 60.0, 11.9 * (number % 5.0), 3.7 * number]})
    };
    json!({
        "spacecraft": fixture("two-targets.json")["spacecraft"],
        "attitudes": (0..ATTITUDES).map(attitude).collect::<Value>(),
        "kind": "rest_to_rest",
    })
}

/// Number of legs that a worker has solved.
fn solved(metrics: &str) -> f64 {
    let told = Request::new("GET", "/metrics").send(metrics).expect(200);
    let mut lines = told.body.lines();
    let count = lines.find_map(|line| line.strip_prefix("slewplan_legs_solved_total "));
    count.and_then(|text| text.parse().ok()).expect("a count")
}

/// A table on which two workers are at work.
struct SharedTable {
    service: Service,
    /// Has begun it, and offers parts.
    owner: Worker,
    /// Solves some of them.
    helper: Worker,
    /// Of the helper.
    metrics: String,
    path: String,
}

impl SharedTable {
    /// A table in a database, of which a helper has solved something.
    fn begun(database: &str) -> Self {
        let service = Service::on_database(database.as_ref(), &["--no-worker"]);
        let owner = Worker::spreading(database);
        let job = service.post("/v1/leg-tables", &query()).expect(202).json();
        let path = format!("/v1/leg-tables/{}", job["id"].as_str().expect("an id"));
        let begin = Instant::now();
        while service.get(&path).json()["state"] == "queued" {
            assert!(begin.elapsed() < Duration::from_mins(2), "nobody begins");
            pause();
        }
        // Only now, so that this one cannot be the owner.
        let (helper, metrics) = Worker::with_metrics(database);
        while solved(&metrics) == 0.0 {
            let job = service.get(&path).json();
            assert!(job["finished_at"].is_null(), "nobody helps: {job}");
            pause();
        }
        Self {
            service,
            owner,
            helper,
            metrics,
            path,
        }
    }
}

/// Waits for the end of a table that has all its legs.
fn assert_made(service: &Service, path: &str) -> Value {
    let begin = Instant::now();
    loop {
        let job = service.get(path).expect(200).json();
        if !job["finished_at"].is_null() {
            let counts = ["legs", "done", "missing"].map(|name| job[name].as_i64());
            assert_eq!(job["state"], "succeeded");
            assert_eq!(counts, [Some(LEGS), Some(LEGS), Some(0)]);
            return job;
        }
        assert!(begin.elapsed() < Duration::from_mins(2), "still {job}");
        pause();
    }
}

#[test]
fn an_idle_worker_solves_parts_of_a_table_of_another() {
    let Some(database) = postgres::new_database() else {
        return println!("not run: Postgres is not installed");
    };
    let table = SharedTable::begun(&database);
    let job = assert_made(&table.service, &table.path);
    let own = job["computed"].as_i64().expect("a count");
    let helped = solved(&table.metrics);
    assert!(0 < own && own < LEGS && helped > 0.0, "{own} {helped}");
    // Nobody sees the parts, and none is left.
    let tables = table.service.get("/v1/leg-tables").expect(200).json();
    let listed = tables["leg_tables"].as_array().map(Vec::len);
    assert_eq!(listed, Some(1), "{tables}");
    let told = table.service.get("/metrics").expect(200).body;
    let queued = "slewplan_jobs{state=\"queued\"} 0";
    assert!(told.lines().any(|line| line == queued), "{told}");
}

#[test]
fn a_table_is_made_when_its_helper_is_killed() {
    let Some(database) = postgres::new_database() else {
        return println!("not run: Postgres is not installed");
    };
    let SharedTable {
        service,
        owner: _owner,
        helper,
        path,
        ..
    } = SharedTable::begun(&database);
    drop(helper);
    assert_made(&service, &path);
}

#[test]
fn the_helper_takes_over_a_table_whose_worker_was_killed() {
    let Some(database) = postgres::new_database() else {
        return println!("not run: Postgres is not installed");
    };
    let SharedTable {
        service,
        owner,
        helper: _helper,
        path,
        ..
    } = SharedTable::begun(&database);
    drop(owner);
    let job = assert_made(&service, &path);
    assert_eq!(job["attempt"], 2, "{job}");
}
