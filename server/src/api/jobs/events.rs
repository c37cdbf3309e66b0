//! The events of jobs as server-sent events.

use super::super::App;
use super::super::error::{ApiError, ErrorCode};
use crate::base::lifecycle::Shutdown;
use crate::store::{EventRow, JobState, StoreError, Work};
use axum::http::{HeaderMap, StatusCode};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use futures_util::stream::unfold;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::{OwnedSemaphorePermit, watch};
use tokio::time::Instant;

/// Maximum duration of a stream.
const MAX_DURATION: Duration = Duration::from_hours(1);
/// Longest wait at a shutdown until the running job is back in the queue.
const SHUTDOWN_WAIT: Duration = Duration::from_secs(2);
/// Time after which clients reconnect.
const RECONNECT: Duration = Duration::from_secs(2);

/// The events of a job after the last one that the caller has received.
pub(in crate::api) async fn follow(
    app: App,
    work: Work,
    id: String,
    headers: &HeaderMap,
) -> Result<Response, ApiError> {
    // An invalid id counts as none: the caller then receives all events.
    let known = headers
        .get("last-event-id")
        .and_then(|id| id.to_str().ok()?.trim().parse::<u32>().ok())
        .map_or(0, i64::from);
    let job = super::find(&app, work, &id).await?;
    let Ok(place) = Arc::clone(&app.0.streams).try_acquire_owned() else {
        let detail = "too many streams are open";
        return Err(ApiError::new(ErrorCode::Busy, detail));
    };
    let mut tail = Tail {
        changes: app.jobs().changes(),
        known,
        sequence: job.sequence,
        id,
        shutdown: app.shutdown().clone(),
        app,
        read: VecDeque::new(),
        until: Instant::now() + MAX_DURATION,
        closed: false,
        _place: place,
    };
    // The job may have been deleted in the meantime.
    let state = tail.fetch().await?;
    let state = state.ok_or_else(|| ApiError::not_found(super::name(work), &tail.id))?;
    if state.is_final() && tail.read.is_empty() {
        return Ok(StatusCode::NO_CONTENT.into_response());
    }
    let stream = Sse::new(unfold(tail, Tail::next));
    Ok(stream.keep_alive(KeepAlive::default()).into_response())
}

/// One server-sent event.
#[derive(serde::Serialize, utoipa::ToSchema)]
#[schema(as = EventFrame)]
pub(in crate::api) struct EventFrame {
    /// Counts from 1 within the job; absent for `closing`.
    id: Option<String>,
    /// `state` when the state has changed, `progress` otherwise, or `closing`.
    event: String,
    /// An `Event` as JSON; empty for `closing`.
    data: String,
}

/// The stream of the events of a job.
struct Tail {
    app: App,
    id: String,
    sequence: i64,
    changes: watch::Receiver<u64>,
    shutdown: Shutdown,
    known: i64,
    read: VecDeque<EventRow>,
    /// When the stream ends unless the job ends before.
    until: Instant,
    closed: bool,
    _place: OwnedSemaphorePermit,
}

impl Tail {
    async fn next(mut self) -> Option<(Result<Event, Infallible>, Self)> {
        if self.closed {
            return None;
        }
        loop {
            if let Some(row) = self.read.pop_front() {
                self.known = row.id;
                let event = Event::default().id(row.id.to_string());
                return Some((Ok(event.event(row.kind).data(row.data)), self));
            }
            self.changes.borrow_and_update();
            let state = self.fetch().await.unwrap_or_else(|error| {
                tracing::error!(job_id = self.id, %error, "events cannot be read");
                None
            })?;
            if !self.read.is_empty() {
                continue;
            }
            if state.is_final() {
                return None;
            }
            // During a shutdown the stream goes on until a running job is back in the queue, to
            // report that.
            let given_back = self.shutdown.has_begun() && state == JobState::Queued;
            if given_back || self.until <= Instant::now() {
                self.closed = true;
                let event = Event::default().event("closing").retry(RECONNECT).data("");
                return Some((Ok(event), self));
            }
            self.wait().await;
        }
    }

    /// Waits for a change of a job, the shutdown or the end of the stream.
    async fn wait(&mut self) {
        let ending = self.shutdown.has_begun();
        if ending {
            self.until = self.until.min(Instant::now() + SHUTDOWN_WAIT);
        }
        tokio::select! {
            _ = self.changes.changed() => {}
            () = self.shutdown.begun(), if !ending => {}
            () = tokio::time::sleep_until(self.until) => {}
        }
    }

    /// Reads new events, and the state of the job before them; `None` when the job is gone.
    async fn fetch(&mut self) -> Result<Option<JobState>, StoreError> {
        // The state is read first: the last event is stored together with the final state.
        let Some(job) = self.app.store().job(&self.id).await? else {
            return Ok(None);
        };
        self.read = self
            .app
            .store()
            .events_after(self.sequence, self.known)
            .await?
            .into();
        Ok(Some(job.state()?))
    }
}
