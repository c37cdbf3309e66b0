//! `GET /v1/plans/{id}/events`: what happens to a job, as it happens.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use crate::store::{EventRow, StoreError};
use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::sse::{Event, KeepAlive, Sse};
use futures_util::stream::{Stream, unfold};
use std::collections::VecDeque;
use std::convert::Infallible;
use tokio::sync::watch;

/// Follow a job
///
/// Server-sent events with ids that count from 1. Every event carries state, incumbent and bound.
/// A stream ends after the last event of a job; one that broke is resumed with `Last-Event-ID`.
#[utoipa::path(
    get, path = "/v1/plans/{id}/events", tag = "plans", operation_id = "follow_plan",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        ("Last-Event-ID" = Option<String>, Header,
            description = "The last event that is known"),
    ),
    responses(
        (status = 200, description = "The events", body = Frame, content_type = "text/event-stream"),
        NotFound, ServerErrors,
    ),
)]
pub(in crate::http) async fn handler(
    State(app): State<App>,
    Path(id): Path<String>,
    headers: HeaderMap,
) -> Result<Sse<impl Stream<Item = Result<Event, Infallible>>>, ApiError> {
    // An id that is none of ours is taken for none: the caller then sees everything.
    let known = headers
        .get("last-event-id")
        .and_then(|id| id.to_str().ok()?.trim().parse::<u32>().ok())
        .map_or(0, i64::from);
    let job = super::find(&app, &id).await?;
    let tail = Tail {
        changes: app.jobs().changes(),
        known,
        sequence: job.sequence,
        id,
        app,
        read: VecDeque::new(),
    };
    Ok(Sse::new(unfold(tail, Tail::next)).keep_alive(KeepAlive::default()))
}

/// One server-sent event.
#[derive(serde::Serialize, utoipa::ToSchema)]
#[schema(as = EventFrame)]
struct Frame {
    /// Counts from 1 within the job.
    id: String,
    /// `state` when the state has changed, `progress` otherwise.
    event: String,
    /// An `Event` as JSON.
    data: String,
}

/// Reads the events of a job as they come.
struct Tail {
    app: App,
    id: String,
    sequence: i64,
    changes: watch::Receiver<u64>,
    known: i64,
    read: VecDeque<EventRow>,
}

impl Tail {
    async fn next(mut self) -> Option<(Result<Event, Infallible>, Self)> {
        let mut shutdown = self.app.shutdown().clone();
        while self.read.is_empty() {
            self.changes.borrow_and_update();
            match self.fetch().await {
                Ok(true) => {}
                Ok(false) => return None,
                Err(error) => {
                    tracing::error!(job_id = self.id, %error, "events cannot be read");
                    return None;
                }
            }
            if self.read.is_empty() {
                tokio::select! {
                    changed = self.changes.changed() => changed.ok()?,
                    () = shutdown.begun() => return None,
                }
            }
        }
        let row = self.read.pop_front()?;
        self.known = row.id;
        let event = Event::default()
            .id(row.id.to_string())
            .event(row.kind)
            .data(row.data);
        Some((Ok(event), self))
    }

    /// Reads what is new; `false` when nothing will ever be.
    async fn fetch(&mut self) -> Result<bool, StoreError> {
        // The state first: the last event is there before anybody can see the last state.
        let Some(job) = self.app.store().job(&self.id).await? else {
            return Ok(false);
        };
        self.read = self
            .app
            .store()
            .events_after(self.sequence, self.known)
            .await?
            .into();
        Ok(!self.read.is_empty() || !job.state()?.is_final())
    }
}
