//! `GET /metrics`: figures in the text form of Prometheus.

use super::super::App;
use super::super::describe::ServerErrors;
use super::super::error::ApiError;
use axum::extract::State;
use axum::http::{HeaderName, header};
use std::fmt::Write;

/// Read the figures for Prometheus
#[utoipa::path(
    get, path = "/metrics", tag = "operations", operation_id = "get_metrics",
    responses(
        (status = 200, description = "The figures", body = String,
            content_type = "text/plain"),
        ServerErrors,
    ),
)]
pub(in crate::http) async fn handler(
    State(app): State<App>,
) -> Result<([(HeaderName, &'static str); 1], String), ApiError> {
    let mut text = String::new();
    let counts = app.store().counts().await?;
    head(&mut text, "slewplan_jobs", "gauge", "Jobs in every state.");
    for count in counts {
        let labels = format!("state=\"{}\"", count.state.as_str());
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
    app.0.metrics.write(&mut text);
    Ok((
        [(
            header::CONTENT_TYPE,
            "text/plain; version=0.0.4; charset=utf-8",
        )],
        text,
    ))
}

/// Writes what a figure is.
pub(in crate::http) fn head(text: &mut String, name: &str, kind: &str, help: &str) {
    // Writing into a text cannot fail.
    let _ = writeln!(text, "# HELP {name} {help}\n# TYPE {name} {kind}");
}

/// Writes one value of a figure.
pub(in crate::http) fn sample(
    text: &mut String,
    name: &str,
    labels: &str,
    value: impl std::fmt::Display,
) {
    let _ = if labels.is_empty() {
        writeln!(text, "{name} {value}")
    } else {
        writeln!(text, "{name}{{{labels}}} {value}")
    };
}
