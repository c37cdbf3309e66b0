//! `GET /metrics`: metrics in the text format of Prometheus.

use super::super::App;
use super::super::describe::ServerErrors;
use super::super::error::ApiError;
use crate::base::clock::now_us;
use crate::base::contradictions;
use crate::base::metrics::{Scrape, TEXT_FORMAT};
use crate::jobs::Jobs;
use axum::extract::State;
use axum::http::{HeaderName, header};

/// Read the metrics for Prometheus
#[utoipa::path(
    get, path = "/metrics", tag = "operations", operation_id = "get_metrics",
    responses(
        (status = 200, description = "The metrics", body = String,
            content_type = "text/plain"),
        ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
) -> Result<([(HeaderName, &'static str); 1], String), ApiError> {
    let scrape = Scrape::default();
    let jobs = app.store().counts().await?;
    scrape.gauge(
        "slewplan_jobs",
        "Jobs in every state.",
        ["state"],
        jobs.iter()
            .map(|count| ([count.state.into_str()], count.jobs)),
    );
    let since_us = app.store().waiting_since_us().await?;
    let waited_us = since_us.map_or(0, |since_us| now_us().saturating_sub(since_us).max(0));
    scrape.gauge(
        "slewplan_queue_oldest_seconds",
        "For how long the queued job has waited that was submitted first; 0 without one.",
        [],
        [([], waited_us / 1_000_000)],
    );
    scrape.gauge(
        "slewplan_cached_legs",
        "Legs in the database.",
        [],
        [([], app.store().leg_count().await?)],
    );
    scrape.add(contradictions::counter());
    scrape.gauge(
        "slewplan_database_bytes",
        "Size of the files of the database.",
        ["file"],
        app.store()
            .sizes()
            .await?
            .into_iter()
            .map(|(file, bytes)| ([file], bytes.try_into().unwrap_or(i64::MAX))),
    );
    let free = app.0.streams.available_permits();
    scrape.gauge(
        "slewplan_event_streams_free",
        "Streams of events that can still be opened.",
        [],
        [([], free.try_into().unwrap_or(i64::MAX))],
    );
    of_process(app.jobs(), &scrape);
    app.0.metrics.report(&scrape);
    Ok(([(header::CONTENT_TYPE, TEXT_FORMAT)], scrape.text()))
}

/// What a process without a service tells of itself.
pub(in crate::api) async fn of_worker(
    State(jobs): State<Jobs>,
) -> ([(HeaderName, &'static str); 1], String) {
    let scrape = Scrape::default();
    scrape.add(contradictions::counter());
    of_process(&jobs, &scrape);
    ([(header::CONTENT_TYPE, TEXT_FORMAT)], scrape.text())
}

/// What a process does, whatever others do on the same database.
fn of_process(jobs: &Jobs, scrape: &Scrape) {
    let count = |number: usize| number.try_into().unwrap_or(i64::MAX);
    scrape.gauge(
        "slewplan_running_jobs_here",
        "Jobs that this process works on.",
        [],
        [([], count(jobs.running_here()))],
    );
    let connections = jobs.store().connections();
    scrape.gauge(
        "slewplan_database_connections",
        "Connections of this process for its statements.",
        ["state"],
        connections.map(|(state, number)| ([state], count(number))),
    );
    jobs.metrics().report(scrape);
}
