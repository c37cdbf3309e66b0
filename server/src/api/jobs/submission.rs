//! Submission of jobs: room in the queue, idempotency, and how long a request waits.

use super::super::App;
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::header_text;
use crate::store::{JobRow, PRIORITIES, Submission, Submitted};
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use std::time::Duration;

/// Longest wait of a request for the end of its job, s.
pub(in crate::api) const MAX_WAIT_S: u64 = 60;
const MAX_KEY: usize = 255;

/// Refuses a submission early while the queue is full; the store checks again. Not for requests
/// with an idempotency key, which may belong to an existing job.
pub(in crate::api) async fn check_room(app: &App) -> Result<(), ApiError> {
    if app.jobs().have_room().await? {
        return Ok(());
    }
    Err(queue_full(app))
}

fn queue_full(app: &App) -> ApiError {
    let limit = app.jobs().queue_limits().all;
    let detail = format!("{limit} jobs are queued already (queue_limit)");
    ApiError::new(ErrorCode::QueueFull, detail)
}

/// Queues a job. The flag says whether it was queued before under the same key.
pub(in crate::api) async fn submit(
    app: &App,
    submission: &Submission,
) -> Result<(JobRow, bool), ApiError> {
    if app.shutdown().has_begun() {
        let detail = "the service is shutting down";
        return Err(ApiError::new(ErrorCode::NotReady, detail));
    }
    match app.jobs().submit(submission).await? {
        Submitted::New(job) => {
            tracing::info!(job_id = job.id, targets = job.targets, "job queued");
            Ok((job, false))
        }
        Submitted::Replayed(job) => Ok((job, true)),
        Submitted::KeyReused => Err(ApiError::new(
            ErrorCode::IdempotencyKeyReused,
            "another body was submitted under this Idempotency-Key",
        )),
        Submitted::QueueFull => Err(queue_full(app)),
        Submitted::QuotaExceeded => {
            let limit = app.jobs().queue_limits().client;
            let detail =
                format!("{limit} jobs of this client are queued already (client_queue_limit)");
            Err(ApiError::new(ErrorCode::QuotaExceeded, detail))
        }
    }
}

/// An answer to a submission with the address of its job.
pub(in crate::api) fn located(
    mut response: Response,
    job: &JobRow,
    replayed: bool,
) -> Result<Response, ApiError> {
    let headers = response.headers_mut();
    if let Ok(location) = HeaderValue::from_str(&super::address(job.work()?, &job.id)) {
        headers.insert(header::LOCATION, location);
    }
    if replayed {
        let name = header::HeaderName::from_static("idempotency-replayed");
        headers.insert(name, HeaderValue::from_static("true"));
    }
    Ok(response)
}

/// The key under which the same request makes one job.
pub(in crate::api) fn idempotency_key(headers: &HeaderMap) -> Result<Option<String>, ApiError> {
    let Some(key) = header_text(headers, "idempotency-key")? else {
        return Ok(None);
    };
    let visible = key.bytes().all(|byte| byte.is_ascii_graphic());
    if key.is_empty() || key.len() > MAX_KEY || !visible {
        let detail =
            format!("an Idempotency-Key has 1 to {MAX_KEY} visible ASCII characters, no space");
        return Err(ApiError::new(ErrorCode::InvalidParameter, detail));
    }
    Ok(Some(key.to_owned()))
}

/// The priority of a submission.
pub(in crate::api) fn priority(asked: i64) -> Result<i64, ApiError> {
    if PRIORITIES.contains(&asked) {
        return Ok(asked);
    }
    let (least, greatest) = (PRIORITIES.start(), PRIORITIES.end());
    let detail = format!("priority: {asked} is not within {least} and {greatest}");
    Err(ApiError::new(ErrorCode::InvalidParameter, detail))
}

/// The wait of `Prefer: wait=N`. Unknown preferences are ignored (RFC 7240).
pub(in crate::api) fn wait(headers: &HeaderMap) -> Option<Duration> {
    let preferences = headers
        .get_all("prefer")
        .iter()
        .filter_map(|value| value.to_str().ok());
    preferences
        .flat_map(|value| value.split([',', ';']))
        .filter_map(|preference| preference.trim().strip_prefix("wait="))
        .find_map(|seconds| seconds.trim().parse::<u64>().ok())
        .map(|seconds| Duration::from_secs(seconds.min(MAX_WAIT_S)))
}
