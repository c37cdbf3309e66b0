//! `GET /v1/leg-tables/{id}/events`: the events of a job as server-sent events.

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
/// Server-sent events as those of plans, each with the counts of the legs.
#[utoipa::path(
    get, path = "/v1/leg-tables/{id}/events", tag = "legs", operation_id = "follow_leg_table",
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
    events::follow(app, Work::LegTable, id, &headers).await
}
