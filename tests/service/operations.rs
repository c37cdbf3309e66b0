//! Operations: version, limits, metrics, documentation.

use crate::client::Request;
use crate::running::{self, ALONE, Service, large, pause, small};
use std::time::{Duration, Instant};

#[test]
fn version_limits_and_health_are_answered() {
    let service = Service::start();
    let request = Request::new("GET", "/v1/version").header("X-Request-Id", "my-id.7");
    let answer = service.send(&request).expect(200);
    assert_eq!(answer.header("x-request-id"), Some("my-id.7"));
    assert_eq!(answer.json()["version"], env!("CARGO_PKG_VERSION"));
    let limits = service.get("/v1/limits").expect(200).json();
    assert!(limits["max_body_bytes"].as_u64() > Some(1 << 20));
    let connections = if running::on_postgres() { 12 } else { 6 };
    assert_eq!(limits["database_connections"], connections);
    for path in ["/health/live", "/health/ready"] {
        assert_eq!(service.get(path).expect(200).json()["status"], "ok");
    }
}

#[test]
fn metrics_count_jobs_legs_and_requests() {
    let service = Service::start();
    let id = service.submit(&small());
    service.wait_end(&id);
    let metrics = service.get("/metrics").expect(200).body;
    for line in [
        "slewplan_jobs{state=\"succeeded\"} 1",
        "slewplan_jobs{state=\"queued\"} 0",
    ] {
        assert!(metrics.lines().any(|found| found == line), "{metrics}");
    }
    let posted = "slewplan_http_request_duration_seconds_count{method=\"POST\",\
                  route=\"/v1/plans\",status=\"202\"} 1";
    assert!(metrics.lines().any(|found| found == posted), "{metrics}");
    for name in [
        "slewplan_queue_wait_seconds_count",
        "slewplan_solve_seconds_count",
        "slewplan_gap_at_end_count",
    ] {
        let line = format!("{name} 1");
        assert!(metrics.lines().any(|found| found == line), "{line}");
    }
    let file = if running::on_postgres() {
        "database"
    } else {
        "log"
    };
    let size = format!("slewplan_database_bytes{{file=\"{file}\"}} ");
    assert!(metrics.contains(&size));
    let misses = metrics
        .lines()
        .find(|line| line.contains("outcome=\"miss\""))
        .expect("misses");
    assert!(!misses.ends_with(" 0"));
}

#[test]
fn metrics_tell_for_how_long_the_queue_waits() {
    let service = Service::start_with(&ALONE);
    let waited = || {
        let metrics = service.get("/metrics").expect(200).body;
        let mut lines = metrics.lines();
        let line = lines.find_map(|line| line.strip_prefix("slewplan_queue_oldest_seconds "));
        line.expect("the metric").parse::<u64>().expect("seconds")
    };
    assert_eq!(waited(), 0);
    let running = service.submit(&large());
    service.wait(&running, |job| job["state"] == "running");
    let id = service.submit(&small());
    let begin = Instant::now();
    while waited() == 0 {
        assert!(begin.elapsed() < Duration::from_mins(1), "still no second");
        pause();
    }
    let cancel = Request::new("POST", &format!("/v1/plans/{id}/cancel"));
    service.send(&cancel).expect(200);
    assert_eq!(waited(), 0);
}

#[test]
fn the_documentation_loads_nothing_from_other_hosts() {
    let service = Service::start();
    let page = service.get("/docs/").expect(200).body;
    assert!(
        page.contains("swagger-ui") && !page.contains("https://"),
        "{page}"
    );
    service.get("/docs/swagger-ui-bundle.js").expect(200);
}

#[test]
fn problem_types_lead_to_the_index_of_errors() {
    let service = Service::start();
    let index = service.get("/docs/errors").expect(200).body;
    assert!(!index.contains("https://"), "{index}");
    // Every row has an anchor, a meaning and a remedy.
    let rows: Vec<&str> = index.split("<tr id=").skip(1).collect();
    assert!(rows.len() > 60, "{}", rows.len());
    for row in &rows {
        let cells: Vec<&str> = row.split("<td>").skip(1).collect();
        assert!((3..=4).contains(&cells.len()), "{row}");
        assert!(cells.iter().all(|cell| cell.len() > 2), "{row}");
    }
    for anchor in [
        "queue_full",
        "input-momentum_exceeds_envelope",
        "input-leg_refused",
        "input-stopped_without_plan",
        "end-process_died",
    ] {
        assert!(index.contains(&format!("id=\"{anchor}\"")), "{anchor}");
    }
    let problem = service
        .get("/v1/plans/nothing")
        .expect_problem(404, "not_found");
    let place = problem["type"].as_str().expect("text");
    let anchor = place.strip_prefix("/docs/errors#").expect("the index");
    assert!(index.contains(&format!("id=\"{anchor}\"")), "{anchor}");
}

#[test]
fn cached_documents_are_answered_with_not_modified() {
    let service = Service::start();
    for path in ["/openapi.yaml", "/docs/errors"] {
        let answer = service.get(path).expect(200);
        let tag = answer.header("etag").expect("a tag");
        let again = Request::new("GET", path).header("If-None-Match", tag);
        assert_eq!(service.send(&again).expect(304).body, "");
        let other = Request::new("GET", path).header("If-None-Match", "\"other\"");
        assert_eq!(service.send(&other).expect(200).body, answer.body);
    }
}
