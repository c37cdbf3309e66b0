//! `GET /metrics`: figures in the text form of Prometheus.

use super::super::App;
use super::super::describe::ServerErrors;
use super::super::error::ApiError;
use crate::base::contradictions;
use crate::base::metrics::{head, sample};
use axum::extract::State;
use axum::http::{HeaderName, header};

/// Read the figures for Prometheus
#[utoipa::path(
    get, path = "/metrics", tag = "operations", operation_id = "get_metrics",
    responses(
        (status = 200, description = "The figures", body = String,
            content_type = "text/plain"),
        ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
) -> Result<([(HeaderName, &'static str); 1], String), ApiError> {
    let mut text = String::new();
    let counts = app.store().counts().await?;
    head(&mut text, "slewplan_jobs", "gauge", "Jobs in every state.");
    for count in counts {
        let labels = format!("state=\"{}\"", count.state.into_str());
        sample(&mut text, "slewplan_jobs", &labels, count.jobs);
    }
    let legs = app.store().leg_count().await?;
    head(
        &mut text,
        "slewplan_cached_legs",
        "gauge",
        "Legs in the database.",
    );
    sample(&mut text, "slewplan_cached_legs", "", legs);
    let tally = app.jobs().tally();
    let name = "slewplan_leg_lookups_total";
    head(
        &mut text,
        name,
        "counter",
        "Legs that the solver looked up.",
    );
    sample(&mut text, name, "outcome=\"hit\"", tally.hits());
    sample(&mut text, name, "outcome=\"miss\"", tally.misses());
    let name = "slewplan_contradictions_total";
    head(
        &mut text,
        name,
        "counter",
        "Flights that contradicted a certified bound or a stored leg: defects of the planner.",
    );
    sample(&mut text, name, "", contradictions::count());
    let name = "slewplan_database_bytes";
    head(
        &mut text,
        name,
        "gauge",
        "Size of the files of the database.",
    );
    for (file, bytes) in app.store().sizes() {
        sample(&mut text, name, &format!("file=\"{file}\""), bytes);
    }
    let name = "slewplan_event_streams_free";
    head(
        &mut text,
        name,
        "gauge",
        "Streams of events that can still be opened.",
    );
    sample(&mut text, name, "", app.0.streams.available_permits());
    app.jobs().job_tally().write(&mut text);
    app.0.metrics.write(&mut text);
    Ok((
        [(
            header::CONTENT_TYPE,
            "text/plain; version=0.0.4; charset=utf-8",
        )],
        text,
    ))
}
