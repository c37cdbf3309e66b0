//! `GET /metrics`: metrics in the text format of Prometheus.

use super::super::App;
use super::super::describe::ServerErrors;
use super::super::error::ApiError;
use crate::base::contradictions;
use crate::base::metrics::{Scrape, TEXT_FORMAT};
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
    let running = app.jobs().running_here();
    scrape.gauge(
        "slewplan_running_jobs_here",
        "Jobs that this process works on.",
        [],
        [([], running.try_into().unwrap_or(i64::MAX))],
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
    app.jobs().metrics().report(&scrape);
    app.0.metrics.report(&scrape);
    Ok(([(header::CONTENT_TYPE, TEXT_FORMAT)], scrape.text()))
}
