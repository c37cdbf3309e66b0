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

/// How long a request that ends a job waits for its end.
const PATIENCE: Duration = Duration::from_secs(2);

/// The job of an identifier.
async fn find(app: &App, id: &str) -> Result<JobRow, ApiError> {
    present(app.store().job(id).await?, id)
}

fn present(job: Option<JobRow>, id: &str) -> Result<JobRow, ApiError> {
    job.ok_or_else(|| ApiError::not_found("plan", id))
}

/// The answer for a job that has been asked to end: when it has ended, or after a while.
async fn ending(app: &App, id: &str) -> Result<Response, ApiError> {
    standing(&present(respond::await_end(app, id, PATIENCE).await?, id)?)
}

/// A job that was waited for: accepted as long as it has not ended.
fn standing(job: &JobRow) -> Result<Response, ApiError> {
    let status = if job.state()?.is_final() {
        StatusCode::OK
    } else {
        StatusCode::ACCEPTED
    };
    respond::job(status, job)
}

/// A request to end that came too late.
fn has_ended(state: JobState) -> ApiError {
    let detail = format!("the job has ended {}", state.into_str());
    ApiError::new(ErrorCode::JobHasEnded, detail)
}
