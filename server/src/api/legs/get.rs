//! `GET /v1/legs/{key}`: a cached leg with its trajectory.

use super::super::App;
use super::super::describe::{NotFound, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Named;
use crate::documents::stored_legs::FlownLegDocument;
use axum::Json;
use axum::extract::State;

/// Read a cached leg with its trajectory
#[utoipa::path(
    get, path = "/v1/legs/{key}", tag = "legs", operation_id = "get_leg",
    params(("key" = String, Path, pattern = "^[0-9a-f]{64}$", description = "Key of the leg")),
    responses(
        (status = 200, description = "The leg", body = FlownLegDocument),
        NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(key): Named,
) -> Result<Json<FlownLegDocument>, ApiError> {
    let found = app.store().leg(&key).await?;
    let (row, trajectory) = found.ok_or_else(|| ApiError::not_found("leg", &key))?;
    Ok(Json(FlownLegDocument::new(&row, &trajectory)))
}
