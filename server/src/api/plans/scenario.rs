//! `GET /v1/plans/{id}/scenario`: the scenario of a job.

use super::super::App;
use super::super::describe::{NotFound, Scenario, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::{Named, header_text};
use super::super::{jobs, respond};
use crate::base::digest;
use crate::store::Work;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;

/// Read the scenario of a job
///
/// The scenario as submitted, with a stored spacecraft written out.
#[utoipa::path(
    get, path = "/v1/plans/{id}/scenario", tag = "plans", operation_id = "get_scenario",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        ("If-None-Match" = Option<String>, Header,
            description = "Entity tags that are known already"),
    ),
    responses(
        (status = 200, description = "The scenario", body = Scenario,
            headers(("ETag" = String, description = "Hash of the content"))),
        (status = 304, description = "Not changed"),
        NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    jobs::find(&app, Work::Plan, &id).await?;
    let found = app.store().scenario(&id).await?;
    let (scenario, _) = found.ok_or_else(|| ApiError::not_found("plan", &id))?;
    let known = header_text(&headers, "if-none-match")?.unwrap_or("");
    let tag = digest::hex(&scenario);
    let response = respond::tagged("application/json", &tag, scenario.into());
    Ok(respond::unless_known(known, response))
}
