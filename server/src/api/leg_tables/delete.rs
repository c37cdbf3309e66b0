//! `DELETE /v1/leg-tables/{id}`: deletes a job with its table and events.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::store::Work;
use axum::extract::State;
use axum::http::StatusCode;

/// Delete a job with its table and events; a running one is cancelled
#[utoipa::path(
    delete, path = "/v1/leg-tables/{id}", tag = "legs", operation_id = "delete_leg_table",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses((status = 204, description = "Deleted"), NotFound, ServerErrors),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<StatusCode, ApiError> {
    jobs::delete(&app, Work::LegTable, &id).await
}
