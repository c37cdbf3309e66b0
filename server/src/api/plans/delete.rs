//! `DELETE /v1/plans/{id}`: deletes a job with its result and events.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::store::Work;
use axum::extract::State;
use axum::http::StatusCode;

/// Delete a job with its result and events; a running one is cancelled
#[utoipa::path(
    delete, path = "/v1/plans/{id}", tag = "plans", operation_id = "delete_plan",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses((status = 204, description = "Deleted"), NotFound, ServerErrors),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<StatusCode, ApiError> {
    jobs::delete(&app, Work::Plan, &id).await
}
