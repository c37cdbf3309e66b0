//! `POST /v1/plans/{id}/cancel`: cancels a job.

use super::super::App;
use super::super::describe::{Conflict, NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::documents::jobs::JobDocument;
use crate::store::Work;
use axum::extract::State;
use axum::response::Response;

/// Cancel a queued or running job
///
/// Answers when the job has ended, or after two seconds with 202 when it has not.
#[utoipa::path(
    post, path = "/v1/plans/{id}/cancel", tag = "plans", operation_id = "cancel_plan",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses(
        (status = 200, description = "The job has ended", body = JobDocument),
        (status = 202, description = "The job is about to end", body = JobDocument),
        Conflict, NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<Response, ApiError> {
    jobs::cancel(&app, Work::Plan, &id).await
}
