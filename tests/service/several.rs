//! Several services and workers on one database of Postgres.

use crate::client::Request;
use crate::durability::sizeable;
use crate::postgres;
use crate::running::{Service, Worker, large, pause, small};
use serde_json::json;
use std::time::{Duration, Instant};

/// Runs a test with a new database, where Postgres is installed.
fn on_postgres(test: impl FnOnce(&str)) {
    match postgres::new_database() {
        Some(database) => test(&database),
        None => println!("not run: Postgres is not installed"),
    }
}

/// A service that solves no jobs.
fn service(database: &str) -> Service {
    Service::on_database(database.as_ref(), &["--no-worker"])
}

#[test]
fn a_job_is_submitted_solved_followed_and_read_in_different_processes() {
    on_postgres(|database| {
        let [first, second] = [(); 2].map(|()| service(database));
        let worker = Worker::on(database);
        let id = first.submit(&small());
        let stream = second.get(&format!("/v1/plans/{id}/events")).expect(200);
        let ids: Vec<u64> = stream
            .body
            .lines()
            .filter_map(|line| line.strip_prefix("id:")?.trim().parse().ok())
            .collect();
        assert_eq!(ids, (1..=ids.len() as u64).collect::<Vec<_>>());
        let results = [&first, &second].map(|service| {
            service
                .get(&format!("/v1/plans/{id}/result"))
                .expect(200)
                .body
        });
        assert_eq!(results[0], results[1]);
        // The stream goes on at another service after the last event that was received.
        let half = ids.len() / 2;
        let rest = Request::new("GET", &format!("/v1/plans/{id}/events"))
            .header("Last-Event-ID", &half.to_string());
        let rest = first.send(&rest).expect(200);
        let begin = format!("id: {}\n", half + 1);
        assert!(rest.body.starts_with(&begin), "{}", rest.body);
        // Solved legs are those of all workers.
        drop(worker);
        let _other = Worker::on(database);
        let again = first.submit(&small());
        first.wait_end(&again);
        let plan = first.get(&format!("/v1/plans/{again}/result")).json();
        assert_eq!(plan["statistics"]["legs_solved"], 0);
    });
}

#[test]
fn a_job_is_stopped_cancelled_and_deleted_through_another_process() {
    on_postgres(|database| {
        let [first, second] = [(); 2].map(|()| service(database));
        let _worker = Worker::on(database);
        let id = first.submit(&sizeable());
        first.wait(&id, |job| !job["incumbent_s"].is_null());
        let stopped = second.post(&format!("/v1/plans/{id}/stop"), &json!({}));
        assert!([200, 202].contains(&stopped.status));
        let job = second.wait_end(&id);
        assert!(["stopped", "succeeded"].contains(&job["state"].as_str().expect("a state")));

        let id = first.submit(&large());
        first.wait(&id, |job| job["state"] == "running");
        second.post(&format!("/v1/plans/{id}/cancel"), &json!({}));
        assert_eq!(first.wait_end(&id)["state"], "cancelled");

        let id = first.submit(&large());
        first.wait(&id, |job| job["state"] == "running");
        let delete = Request::new("DELETE", &format!("/v1/plans/{id}"));
        second.send(&delete).expect(204);
        // The worker is free again.
        let id = first.submit(&small());
        assert_eq!(first.wait_end(&id)["state"], "succeeded");
    });
}

#[test]
fn another_worker_takes_over_from_a_killed_one() {
    on_postgres(|database| {
        let service = service(database);
        let killed = Worker::on(database);
        let id = service.submit(&sizeable());
        let before = service.wait(&id, |job| !job["incumbent_s"].is_null());
        drop(killed);
        let _next = Worker::on(database);
        let after = service.wait(&id, |job| job["attempt"] == 2);
        let best = |job: &serde_json::Value| job["incumbent_s"].as_f64().expect("a plan");
        assert!(best(&after) <= best(&before), "{after}");
        assert_eq!(service.wait_end(&id)["state"], "succeeded");
    });
}

#[test]
fn a_worker_that_is_asked_to_end_gives_its_job_back() {
    on_postgres(|database| {
        let service = service(database);
        let mut worker = Worker::on(database);
        let id = service.submit(&sizeable());
        service.wait(&id, |job| job["state"] == "running");
        assert!(worker.terminate());
        let job = service.job(&id);
        assert_eq!(
            (&job["state"], job["attempt"].as_i64()),
            (&"queued".into(), Some(0))
        );
        let _next = Worker::on(database);
        let job = service.wait_end(&id);
        assert_eq!(
            (&job["state"], job["attempt"].as_i64()),
            (&"succeeded".into(), Some(1))
        );
    });
}

#[test]
fn one_idempotency_key_at_several_services_makes_one_job() {
    on_postgres(|database| {
        let services = [(); 3].map(|()| service(database));
        let request = Request::new("POST", "/v1/plans")
            .json(&small())
            .header("Idempotency-Key", "only-once");
        let ids = std::thread::scope(|scope| {
            let asked = services.each_ref().map(|service| {
                let request = &request;
                scope.spawn(move || service.send(request).expect(202).json()["id"].clone())
            });
            asked.map(|answer| answer.join().expect("an answer"))
        });
        assert!(ids.iter().all(|id| *id == ids[0]), "{ids:?}");
        let list = services[0].get("/v1/plans").expect(200).json();
        assert_eq!(list["plans"].as_array().expect("a list").len(), 1);
    });
}

#[test]
fn a_file_cannot_be_shared() {
    for arguments in [&["work"][..], &["serve", "--no-worker"]] {
        let refused = std::process::Command::new(env!("CARGO_BIN_EXE_slewplan"))
            .args(arguments)
            .args(["--database", "somewhere.db"])
            .output()
            .expect("the binary starts");
        assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    }
}

#[test]
fn while_postgres_is_away_requests_are_refused_and_the_solve_goes_on() {
    let Some(mut server) = postgres::Server::start() else {
        return println!("not run: Postgres is not installed");
    };
    let database = server.new_database();
    let service = service(&database);
    let _worker = Worker::on(&database);
    let id = service.submit(&sizeable());
    service.wait(&id, |job| !job["incumbent_s"].is_null());
    server.kill();
    let refused = service.get(&format!("/v1/plans/{id}"));
    assert!(refused.header("retry-after").is_some(), "{refused:?}");
    refused.expect_problem(503, "database_unavailable");
    service
        .post("/v1/plans", &small())
        .expect_problem(503, "database_unavailable");
    service
        .get("/health/ready")
        .expect_problem(503, "not_ready");
    service.get("/health/live").expect(200);
    server.restart();
    let job = service.wait_end(&id);
    assert_eq!(
        (&job["state"], job["attempt"].as_i64()),
        (&"succeeded".into(), Some(1))
    );
    // An answer of before is given for a second.
    let begin = Instant::now();
    while service.get("/health/ready").status != 200 {
        assert!(begin.elapsed() < Duration::from_mins(1), "still not ready");
        pause();
    }
}

#[test]
fn a_worker_tells_its_metrics_and_whether_it_can_store_what_it_solves() {
    let Some(mut server) = postgres::Server::start() else {
        return println!("not run: Postgres is not installed");
    };
    let database = server.new_database();
    let service = service(&database);
    let (_worker, metrics) = Worker::with_metrics(&database);
    let ask = |path: &str| Request::new("GET", path).send(&metrics);
    let id = service.submit(&small());
    service.wait_end(&id);
    // The worker counts a job after it has handed in its end.
    let expected = [
        "slewplan_running_jobs_here 0",
        "slewplan_solve_seconds_count 1",
    ];
    let begin = Instant::now();
    let told = loop {
        let told = ask("/metrics").expect(200).body;
        if expected
            .iter()
            .all(|line| told.lines().any(|told| told == *line))
        {
            break told;
        }
        assert!(
            begin.elapsed() < Duration::from_mins(1),
            "{expected:?} in {told}"
        );
        pause();
    };
    assert!(
        told.contains("slewplan_database_connections{state=\"idle\"}"),
        "{told}"
    );
    ask("/health/live").expect(200);
    ask("/health/ready").expect(200);
    assert_eq!(ask("/v1/limits").status, 404);
    server.kill();
    ask("/health/live").expect(200);
    ask("/health/ready").expect_problem(503, "not_ready");
}
