//! `GET /v1/limits`: the limits on requests.

use super::super::App;
use super::super::{computing, jobs::submission, legs::query};
use crate::documents::leg_query::MAX_LEGS;
use axum::Json;
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;

/// Limits on requests.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Limits)]
pub(in crate::api) struct LimitsDocument {
    /// Maximum size of a body, bytes.
    max_body_bytes: usize,
    /// Maximum number of values in a body, nested ones included, and names of members.
    max_body_values: usize,
    /// Maximum number of targets of a scenario.
    max_targets: usize,
    /// Number of jobs that this process solves at once; 0 where only others on the same database solve.
    jobs_at_once: usize,
    /// Maximum number of connections of this process to its database.
    database_connections: u32,
    /// Memory limit of one job, and of those together that are solved at once, bytes.
    job_memory_bytes: u64,
    /// Maximum number of queued jobs.
    queue_limit: i64,
    /// Maximum number of queued jobs of one client, where keys are required.
    client_queue_limit: i64,
    /// Longest `Prefer: wait`, s.
    max_wait_s: u64,
    /// Maximum number of legs that a query computes.
    max_leg_pairs: usize,
    /// Maximum number of legs of a table: looked up, certified, or computed by a job.
    max_table_legs: usize,
    /// Longest time that a query for legs may compute, s.
    max_leg_query_s: u64,
    /// Threads of the solver.
    solver_threads: usize,
}

/// Read the limits of this service
#[utoipa::path(
    get, path = "/v1/limits", tag = "operations", operation_id = "get_limits",
    responses((status = 200, description = "The limits", body = LimitsDocument)),
)]
pub(in crate::api) async fn handler(State(app): State<App>) -> Json<LimitsDocument> {
    Json(LimitsDocument {
        max_body_bytes: app.limits().body_bytes,
        max_body_values: app.limits().body_values(),
        max_targets: app.limits().targets,
        jobs_at_once: app.limits().jobs,
        database_connections: app.store().max_connections(),
        job_memory_bytes: app.jobs().memory_limit(),
        queue_limit: app.jobs().queue_limits().all,
        client_queue_limit: app.jobs().queue_limits().client,
        max_wait_s: submission::MAX_WAIT_S,
        max_leg_pairs: query::MAX_PAIRS,
        max_table_legs: MAX_LEGS,
        max_leg_query_s: computing::MAX_S,
        solver_threads: app.0.pool.threads(),
    })
}
