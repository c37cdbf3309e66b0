//! `POST /v1/leg-tables/{id}/cancel`: cancels a job.

use super::super::App;
use super::super::describe::{Conflict, NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::documents::leg_table_jobs::LegTableJobDocument;
use crate::store::Work;
use axum::extract::State;
use axum::response::Response;

/// Cancel a queued or running job
///
/// Answers when the job has ended, or after two seconds with 202 when it has not. Legs that it has solved
/// stay in the cache.
#[utoipa::path(
    post, path = "/v1/leg-tables/{id}/cancel", tag = "legs", operation_id = "cancel_leg_table",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses(
        (status = 200, description = "The job has ended", body = LegTableJobDocument),
        (status = 202, description = "The job is about to end", body = LegTableJobDocument),
        Conflict, NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<Response, ApiError> {
    jobs::cancel(&app, Work::LegTable, &id).await
}
