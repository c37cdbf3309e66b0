//! Planning jobs.

pub(super) mod cancel;
pub(super) mod create;
pub(super) mod delete;
pub(super) mod events;
mod forms;
pub(super) mod get;
pub(super) mod list;
pub(super) mod result;
pub(super) mod scenario;
pub(super) mod stop;

use super::error::{ApiError, ErrorCode};
use super::{App, respond};
use crate::store::{JobRow, JobState};
use axum::http::StatusCode;
use axum::response::Response;
use std::time::Duration;

/// Longest wait of requests that stop or cancel a job for its end.
const END_WAIT: Duration = Duration::from_secs(2);

/// The job with an identifier.
async fn find(app: &App, id: &str) -> Result<JobRow, ApiError> {
    present(app.store().job(id).await?, id)
}

fn present(job: Option<JobRow>, id: &str) -> Result<JobRow, ApiError> {
    job.ok_or_else(|| ApiError::not_found("plan", id))
}

/// Waits for the end of a job that was stopped or cancelled, and answers with the job.
async fn ending(app: &App, id: &str) -> Result<Response, ApiError> {
    ended_or_accepted(&present(respond::await_end(app, id, END_WAIT).await?, id)?)
}

/// The answer with a job: 200 if it has ended, else 202.
fn ended_or_accepted(job: &JobRow) -> Result<Response, ApiError> {
    let status = if job.state()?.is_final() {
        StatusCode::OK
    } else {
        StatusCode::ACCEPTED
    };
    respond::job(status, job)
}

/// The error of a request to stop or cancel a job that has ended.
fn has_ended(state: JobState) -> ApiError {
    let detail = format!("the job has ended {}", state.into_str());
    ApiError::new(ErrorCode::JobHasEnded, detail)
}
