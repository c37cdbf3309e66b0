//! `GET /v1/limits`: what a request may ask for at most.

use super::super::App;
use super::super::{computing, legs::query, plans::create};
use axum::Json;
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;

/// What a request may ask for at most.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Limits)]
pub(in crate::api) struct Document {
    /// Largest body, bytes.
    max_body_bytes: usize,
    /// Most values in a body, those in lists and objects included, and names of members.
    max_body_values: usize,
    /// Most targets of a scenario.
    max_targets: usize,
    /// Memory that one job may take, bytes.
    job_memory_bytes: u64,
    /// Most jobs that wait.
    queue_limit: i64,
    /// Most jobs of one client that wait, where keys are asked for.
    client_queue_limit: i64,
    /// Longest `Prefer: wait`, s.
    max_wait_s: u64,
    /// Most legs of a query.
    max_leg_pairs: usize,
    /// Longest time that a query for legs may compute, s.
    max_leg_query_s: u64,
    /// Threads of the solver.
    solver_threads: usize,
}

/// Read the limits of this service
#[utoipa::path(
    get, path = "/v1/limits", tag = "operations", operation_id = "get_limits",
    responses((status = 200, description = "The limits", body = Document)),
)]
pub(in crate::api) async fn handler(State(app): State<App>) -> Json<Document> {
    Json(Document {
        max_body_bytes: app.limits().body_bytes,
        max_body_values: app.limits().body_values(),
        max_targets: app.limits().targets,
        job_memory_bytes: app.jobs().memory_limit(),
        queue_limit: app.jobs().queue_limits().all,
        client_queue_limit: app.jobs().queue_limits().client,
        max_wait_s: create::MAX_WAIT_S,
        max_leg_pairs: query::MAX_PAIRS,
        max_leg_query_s: computing::MAX_S,
        solver_threads: app.0.pool.threads(),
    })
}
