//! `GET /health/live` and `GET /health/ready`.

use super::super::error::{ApiError, ErrorCode, ErrorDocument};
use super::super::{App, describe};
use crate::base::clock::now_us;
use crate::base::contradictions::ContradictionObserver;
use crate::documents;
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

/// The service is well.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Health)]
pub(in crate::api) struct Document {
    /// Always `ok`.
    status: &'static str,
}

/// Time after which it is worth asking again, s.
const RETRY_S: u32 = 5;

/// Whether the process answers; touches nothing else
#[utoipa::path(
    get, path = "/health/live", tag = "operations", operation_id = "get_live",
    responses((status = 200, description = "It does", body = Document)),
)]
pub(in crate::api) async fn live() -> Json<Document> {
    Json(Document { status: "ok" })
}

/// How long an answer about the database and the solver holds: however often somebody asks, they
/// are not tried more often than that.
const FRESH: Duration = Duration::from_secs(1);
/// Longest time for the trial of the solver, which takes milliseconds.
const MAX_SOLVE: Duration = Duration::from_secs(5);

/// The newest answer of the database and the solver, and since when it holds: why they cannot be
/// used, if they cannot. Who asks meanwhile waits for it.
pub(in crate::api) type Readiness = Mutex<Option<(Instant, Result<(), &'static str>)>>;

/// Whether the service can take work: the database can be written, a small leg is solved, and the
/// queue has room
#[utoipa::path(
    get, path = "/health/ready", tag = "operations", operation_id = "get_ready",
    responses(
        (status = 200, description = "It can", body = Document),
        (status = 503, description = "It cannot", body = ErrorDocument<'static>,
            content_type = "application/problem+json"),
    ),
)]
pub(in crate::api) async fn ready(State(app): State<App>) -> Result<Json<Document>, ApiError> {
    let not_ready = |why: &str| ApiError::new(ErrorCode::NotReady, why).retry_after(RETRY_S);
    if app.shutdown().has_begun() {
        return Err(not_ready("the service is about to end"));
    }
    let mut newest = app.0.readiness.lock().await;
    let known = newest.filter(|(since, _)| since.elapsed() < FRESH);
    let (_, answer) = match known {
        Some(known) => known,
        None => *newest.insert((Instant::now(), examine(&app).await)),
    };
    drop(newest);
    answer.map_err(not_ready)?;
    Ok(Json(Document { status: "ok" }))
}

async fn examine(app: &App) -> Result<(), &'static str> {
    let failed = |error| {
        tracing::warn!(%error, "not ready");
        "the database cannot be used"
    };
    app.store().check_writable(now_us()).await.map_err(failed)?;
    let waiting = app.store().waiting().await.map_err(failed)?;
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

/// Solves a small leg without remembering it.
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
        // Of more parts than there are legs: one leg.
        of: usize::MAX,
    };
    let (rows, _) = planner::leg_table(&valid.scenario, LegKind::RestToRest, first, run);
    rows.iter().any(|row| row.duration_s.is_some())
}
