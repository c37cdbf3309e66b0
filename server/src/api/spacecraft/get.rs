//! `GET /v1/spacecraft/{name}`: a stored spacecraft.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{NotFound, ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::{Named, Parameters};
use super::StoredSpacecraft;
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use utoipa::IntoParams;

/// Which version to read.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct SpacecraftQuery {
    /// The version; the newest without it.
    #[param(minimum = 1)]
    version: Option<u32>,
}

/// Read a stored spacecraft
#[utoipa::path(
    get, path = "/v1/spacecraft/{name}", tag = "spacecraft", operation_id = "get_spacecraft",
    params(
        ("name" = String, Path, pattern = "^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$",
            description = "Name under which it was stored"),
        SpacecraftQuery,
    ),
    responses(
        (status = 200, description = "The spacecraft", body = StoredSpacecraft),
        ParameterErrors, NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Named(name): Named,
    Parameters(query): Parameters<SpacecraftQuery>,
) -> Result<Json<StoredSpacecraft>, ApiError> {
    if query.version == Some(0) {
        return Err(ApiError::new(
            ErrorCode::InvalidParameter,
            "versions count from 1",
        ));
    }
    let found = app
        .store()
        .spacecraft(&caller.own(&name), query.version.map(i64::from))
        .await?;
    let row = found.ok_or_else(|| ApiError::not_found("spacecraft", &name))?;
    Ok(Json(StoredSpacecraft::new(name, row)?))
}
