//! `GET /v1/plans/{id}`: a job.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::documents::jobs::JobDocument;
use crate::store::Work;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;

/// Read a job: state, stage, incumbent, bound, gap and times
#[utoipa::path(
    get, path = "/v1/plans/{id}", tag = "plans", operation_id = "get_plan",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses((status = 200, description = "The job", body = JobDocument), NotFound, ServerErrors),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<Response, ApiError> {
    jobs::answer(StatusCode::OK, &jobs::find(&app, Work::Plan, &id).await?)
}
