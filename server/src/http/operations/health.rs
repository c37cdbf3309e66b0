//! `GET /health/live` and `GET /health/ready`.

use super::super::App;
use super::super::error::{ApiError, ErrorCode, ErrorDocument};
use crate::clock::now_us;
use crate::store::JobState;
use axum::Json;
use axum::extract::State;
use serde::Serialize;
use utoipa::ToSchema;

/// The service is well.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Health)]
pub(in crate::http) struct Document {
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
pub(in crate::http) async fn live() -> Json<Document> {
    Json(Document { status: "ok" })
}

/// Whether the service can take work: the database can be written and the queue has room
#[utoipa::path(
    get, path = "/health/ready", tag = "operations", operation_id = "get_ready",
    responses(
        (status = 200, description = "It can", body = Document),
        (status = 503, description = "It cannot", body = ErrorDocument<'static>,
            content_type = "application/problem+json"),
    ),
)]
pub(in crate::http) async fn ready(State(app): State<App>) -> Result<Json<Document>, ApiError> {
    let not_ready = |why: &str| ApiError::new(ErrorCode::NotReady, why).retry_after(RETRY_S);
    if app.shutdown().has_begun() {
        return Err(not_ready("the service is about to end"));
    }
    let failed = |error| {
        tracing::warn!(%error, "not ready");
        not_ready("the database cannot be used")
    };
    app.store().check_writable(now_us()).await.map_err(failed)?;
    let counts = app.store().counts().await.map_err(failed)?;
    let waiting = counts.iter().find(|count| count.state == JobState::Queued);
    if waiting.is_some_and(|count| count.jobs >= app.limits().queue) {
        return Err(not_ready("the queue is full"));
    }
    Ok(Json(Document { status: "ok" }))
}
