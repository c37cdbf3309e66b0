//! `GET /health/live` and `GET /health/ready`.

use super::super::error::{ApiError, ErrorCode, ProblemDetails};
use super::super::{App, describe};
use crate::base::clock::now_us;
use crate::base::contradictions::ContradictionObserver;
use crate::documents;
use crate::jobs::Jobs;
use crate::store::StoreError;
use axum::Json;
use axum::extract::State;
use serde::Serialize;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, NoStore};
use slewplan_solver::tour::planner::{self, Run, Shard};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::Mutex;
use utoipa::ToSchema;

/// A positive answer of a health check.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Health)]
pub(in crate::api) struct HealthDocument {
    /// Always `ok`.
    status: &'static str,
}

/// `Retry-After` of a negative answer, s.
const RETRY_S: u32 = 5;

/// Check that the process answers, and nothing else
#[utoipa::path(
    get, path = "/health/live", tag = "operations", operation_id = "get_live",
    responses((status = 200, description = "The process answers", body = HealthDocument)),
)]
pub(in crate::api) async fn live() -> Json<HealthDocument> {
    Json(HealthDocument { status: "ok" })
}

/// Time for which an answer is cached, so that frequent checks do not load the database and the
/// solver.
const FRESH: Duration = Duration::from_secs(1);
/// Time limit of the trial solve, which normally takes milliseconds.
const MAX_SOLVE: Duration = Duration::from_secs(5);

/// The newest answer, with its time: why database or solver cannot be used, if they cannot.
/// Concurrent checks wait for it.
pub(in crate::api) type Readiness = Mutex<Option<(Instant, Result<(), &'static str>)>>;

/// Check that the service can take work: the database is writable, a small leg can be solved, and
/// the queue has room
#[utoipa::path(
    get, path = "/health/ready", tag = "operations", operation_id = "get_ready",
    responses(
        (status = 200, description = "The service can take work", body = HealthDocument),
        (status = 503, description = "The service cannot take work", body = ProblemDetails<'static>,
            content_type = "application/problem+json"),
    ),
)]
pub(in crate::api) async fn ready(
    State(app): State<App>,
) -> Result<Json<HealthDocument>, ApiError> {
    let not_ready = |why: &str| ApiError::new(ErrorCode::NotReady, why).retry_after(RETRY_S);
    if app.shutdown().has_begun() {
        return Err(not_ready("the service is shutting down"));
    }
    let mut newest = app.0.readiness.lock().await;
    let known = newest.filter(|(since, _)| since.elapsed() < FRESH);
    let (_, answer) = match known {
        Some(known) => known,
        None => *newest.insert((Instant::now(), examine(&app).await)),
    };
    drop(newest);
    answer.map_err(not_ready)?;
    Ok(Json(HealthDocument { status: "ok" }))
}

/// Why a failure of the database is in the way.
fn failed(error: &StoreError) -> &'static str {
    tracing::warn!(%error, "not ready");
    if error.is_away() {
        "the server of the database does not answer"
    } else if error.is_read_only() {
        "the database can only be read at present"
    } else {
        "the database cannot be used"
    }
}

/// The same of a process that only solves: whether it can write what it has solved.
pub(in crate::api) async fn worker_ready(
    State(jobs): State<Jobs>,
) -> Result<Json<HealthDocument>, ApiError> {
    let written = jobs.store().check_writable(now_us()).await;
    written
        .map_err(|error| ApiError::new(ErrorCode::NotReady, failed(&error)).retry_after(RETRY_S))?;
    Ok(Json(HealthDocument { status: "ok" }))
}

async fn examine(app: &App) -> Result<(), &'static str> {
    let written = app.store().check_writable(now_us()).await;
    written.map_err(|error| failed(&error))?;
    let waiting = app
        .store()
        .waiting()
        .await
        .map_err(|error| failed(&error))?;
    if waiting >= app.jobs().queue_limits().all {
        return Err("the queue is full");
    }
    let pool = Arc::clone(&app.0.lookups);
    match tokio::task::spawn_blocking(move || solves(&pool)).await {
        Ok(true) => Ok(()),
        Ok(false) => Err("the solver does not solve"),
        Err(error) => {
            tracing::error!(%error, "the solver failed");
            Err("the solver fails")
        }
    }
}

/// Whether a small leg can be solved; it is not cached.
fn solves(pool: &SolverPool) -> bool {
    let scenario = describe::two_targets().to_string();
    let Ok(valid) = documents::scenario::read(scenario.as_bytes(), None) else {
        return false;
    };
    let stop = StopSignal::new().with_time_limit(MAX_SOLVE);
    let run = Run {
        pool,
        stop: &stop,
        observer: &ContradictionObserver,
        legs: &NoStore,
        segments: &NoStore,
    };
    let first = Shard {
        index: 0,
        // With more shards than legs, a shard has one leg.
        of: usize::MAX,
    };
    let (rows, _) = planner::leg_table(&valid.scenario, LegKind::RestToRest, first, run);
    rows.iter().any(|row| row.duration_s.is_some())
}
