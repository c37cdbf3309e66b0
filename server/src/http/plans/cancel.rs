//! `POST /v1/plans/{id}/cancel`: abandon a job.

use super::super::App;
use super::super::describe::{Conflict, NotFound, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::respond;
use crate::store::JobState;
use crate::wire::jobs::JobDocument;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::Response;

/// Abandon a queued or running job
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
pub(in crate::http) async fn handler(
    State(app): State<App>,
    Path(id): Path<String>,
) -> Result<Response, ApiError> {
    let absent = || ApiError::not_found("plan", &id);
    let job = app.jobs().cancel(&id).await?.ok_or_else(absent)?;
    match job.state()? {
        JobState::Queued | JobState::Running => {}
        JobState::Cancelled => return respond::job(StatusCode::OK, &job),
        ended => {
            let detail = format!("the job has ended {}", ended.as_str());
            return Err(ApiError::new(ErrorCode::JobHasEnded, detail));
        }
    }
    let job = respond::await_end(&app, &id, super::PATIENCE)
        .await?
        .ok_or_else(absent)?;
    let ended = job.state()?.is_final();
    respond::job(
        if ended {
            StatusCode::OK
        } else {
            StatusCode::ACCEPTED
        },
        &job,
    )
}
