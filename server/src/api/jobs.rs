//! What plans and tables of leg times have in common as jobs.

pub(super) mod events;
pub(super) mod list;
pub(super) mod submission;

use super::App;
use super::error::{ApiError, ErrorCode};
use crate::documents::jobs::JobDocument;
use crate::documents::leg_table_jobs::LegTableJobDocument;
use crate::store::{JobRow, JobState, Work};
use axum::Json;
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use std::time::Duration;
use tokio::time::Instant;

/// The state of the job, in the head of a result.
pub(super) const JOB_STATE: HeaderName = HeaderName::from_static("job-state");
/// Longest wait of requests that stop or cancel a job for its end.
const END_WAIT: Duration = Duration::from_secs(2);

/// The job with an identifier, if it makes this.
pub(super) async fn find(app: &App, work: Work, id: &str) -> Result<JobRow, ApiError> {
    present(app.store().job(id).await?, work, id)
}

fn present(job: Option<JobRow>, work: Work, id: &str) -> Result<JobRow, ApiError> {
    let job = job.filter(|job| job.work().is_ok_and(|found| found == work));
    job.ok_or_else(|| ApiError::not_found(name(work), id))
}

/// What errors call a job.
fn name(work: Work) -> &'static str {
    match work {
        Work::Plan => "plan",
        Work::LegTable => "leg table",
    }
}

/// The address of a job.
fn address(work: Work, id: &str) -> String {
    match work {
        Work::Plan => format!("/v1/plans/{id}"),
        Work::LegTable => format!("/v1/leg-tables/{id}"),
    }
}

/// An answer with a job and its address.
pub(super) fn answer(status: StatusCode, job: &JobRow) -> Result<Response, ApiError> {
    let work = job.work()?;
    let mut response = match work {
        Work::Plan => (status, Json(JobDocument::new(job)?)).into_response(),
        Work::LegTable => (status, Json(LegTableJobDocument::new(job)?)).into_response(),
    };
    if let Ok(location) = HeaderValue::from_str(&address(work, &job.id)) {
        response
            .headers_mut()
            .insert(header::CONTENT_LOCATION, location);
    }
    Ok(response)
}

/// The answer with a job: 200 if it has ended, else 202.
pub(super) fn ended_or_accepted(job: &JobRow) -> Result<Response, ApiError> {
    let status = if job.state()?.is_final() {
        StatusCode::OK
    } else {
        StatusCode::ACCEPTED
    };
    answer(status, job)
}

/// Waits for the end of a job, at most for `longest`. Returns the job as it is then.
pub(super) async fn await_end(
    app: &App,
    work: Work,
    id: &str,
    longest: Duration,
) -> Result<JobRow, ApiError> {
    let until = Instant::now() + longest;
    let mut changes = app.jobs().changes();
    let mut shutdown = app.shutdown().clone();
    loop {
        changes.borrow_and_update();
        let job = find(app, work, id).await?;
        if job.state()?.is_final() {
            return Ok(job);
        }
        tokio::select! {
            _ = changes.changed() => {}
            () = tokio::time::sleep_until(until) => return Ok(job),
            () = shutdown.begun() => return Ok(job),
        }
    }
}

/// Finishes a running job with what it has so far.
pub(super) async fn stop(app: &App, work: Work, id: &str) -> Result<Response, ApiError> {
    find(app, work, id).await?;
    let job = present(app.jobs().stop(id).await?, work, id)?;
    match job.state()? {
        JobState::Running => {}
        JobState::Queued => {
            let detail = "there is nothing to stop with; cancel or delete the job instead";
            return Err(ApiError::new(ErrorCode::NotRunning, detail));
        }
        // Stopped before, or finished: the caller has the result that it asked for.
        JobState::Stopped | JobState::Succeeded => return answer(StatusCode::OK, &job),
        ended => return Err(has_ended(ended)),
    }
    ended_or_accepted(&await_end(app, work, id, END_WAIT).await?)
}

/// Cancels a queued or running job.
pub(super) async fn cancel(app: &App, work: Work, id: &str) -> Result<Response, ApiError> {
    find(app, work, id).await?;
    let job = present(app.jobs().cancel(id).await?, work, id)?;
    match job.state()? {
        JobState::Queued | JobState::Running => {}
        JobState::Cancelled => return answer(StatusCode::OK, &job),
        ended => return Err(has_ended(ended)),
    }
    ended_or_accepted(&await_end(app, work, id, END_WAIT).await?)
}

/// Deletes a job with its result and events.
pub(super) async fn delete(app: &App, work: Work, id: &str) -> Result<StatusCode, ApiError> {
    find(app, work, id).await?;
    if app.jobs().delete(id).await? {
        Ok(StatusCode::NO_CONTENT)
    } else {
        Err(ApiError::not_found(name(work), id))
    }
}

/// The error of a request to stop or cancel a job that has ended.
fn has_ended(state: JobState) -> ApiError {
    let detail = format!("the job has ended {}", state.into_str());
    ApiError::new(ErrorCode::JobHasEnded, detail)
}

/// The error of a request for a result that there is not.
pub(super) fn no_result(state: JobState, not_ready: &'static str) -> ApiError {
    if state.is_final() {
        let detail = format!("the job ended {}", state.into_str());
        return ApiError::new(ErrorCode::NoResult, detail);
    }
    ApiError::new(ErrorCode::ResultNotReady, not_ready).retry_after(RETRY_S)
}

/// `Retry-After` of a job without a result, s.
const RETRY_S: u32 = 1;
