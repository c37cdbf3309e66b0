//! `GET /v1/plans/{id}/events`: the events of a job as server-sent events.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs::events::{self, EventFrame};
use crate::store::Work;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;

/// Follow a job
///
/// Server-sent events with ids that count from 1. Every event has state, incumbent and bound. A
/// stream ends after the last event of a job; a broken one is resumed with `Last-Event-ID`. If the
/// job has ended and there are no further events, the answer is 204, which keeps an `EventSource`
/// from reconnecting. When the service ends, and after an hour, a stream ends with `closing`, which
/// has no id: connect again.
#[utoipa::path(
    get, path = "/v1/plans/{id}/events", tag = "plans", operation_id = "follow_plan",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        ("Last-Event-ID" = Option<String>, Header,
            description = "Identifier of the last event received"),
    ),
    responses(
        (status = 200, description = "The events", body = EventFrame, content_type = "text/event-stream"),
        (status = 204, description = "The job has ended, and there is no event after the last one received"),
        NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    events::follow(app, Work::Plan, id, &headers).await
}
