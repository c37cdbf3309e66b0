//! `GET /v1/leg-tables/{id}`: a job.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use super::super::jobs;
use crate::documents::leg_table_jobs::LegTableJobDocument;
use crate::store::Work;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;

/// Read a job: state, counts of legs and times
#[utoipa::path(
    get, path = "/v1/leg-tables/{id}", tag = "legs", operation_id = "get_leg_table",
    params(("id" = String, Path, format = "uuid", description = "Identifier of the job")),
    responses(
        (status = 200, description = "The job", body = LegTableJobDocument),
        NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
) -> Result<Response, ApiError> {
    let job = jobs::find(&app, Work::LegTable, &id).await?;
    jobs::answer(StatusCode::OK, &job)
}
