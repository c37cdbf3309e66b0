//! `POST /v1/plans/{id}/stop`: finishes a job with its best plan so far.

use super::super::App;
use super::super::describe::{Conflict, NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::documents::jobs::JobDocument;
use crate::store::Work;
use axum::extract::State;
use axum::response::Response;

/// Finish a running job with the best plan so far
///
/// Answers when the job has ended, or after two seconds with 202 when it has not.
#[utoipa::path(
    post, path = "/v1/plans/{id}/stop", tag = "plans", operation_id = "stop_plan",
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
    jobs::stop(&app, Work::Plan, &id).await
}
