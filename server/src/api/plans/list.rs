//! `GET /v1/plans`: the jobs, page by page.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::Parameters;
use crate::documents::jobs::{JobDocument, JobListDocument};
use crate::store::{JobState, Listing};
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use utoipa::IntoParams;

const DEFAULT_LIMIT: u16 = 50;
const MAX_LIMIT: u16 = 200;

/// Filter and page of the list.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct JobListQuery {
    /// Only jobs in this state.
    #[param(inline, value_type = Option<JobState>)]
    state: Option<String>,
    /// Only jobs of scenarios with exactly this name.
    name: Option<String>,
    /// Where the page begins: `next_cursor` of the page before.
    #[param(pattern = "^[0-9]{1,9}$")]
    cursor: Option<String>,
    /// Maximum number of jobs of the page.
    #[param(minimum = 1, maximum = 200, default = 50)]
    limit: Option<u16>,
}

/// List jobs, the newest first
#[utoipa::path(
    get, path = "/v1/plans", tag = "plans", operation_id = "list_plans",
    params(JobListQuery),
    responses(
        (status = 200, description = "A page of jobs", body = JobListDocument),
        ParameterErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Parameters(query): Parameters<JobListQuery>,
) -> Result<Json<JobListDocument>, ApiError> {
    let wrong = |detail: String| ApiError::new(ErrorCode::InvalidParameter, detail);
    let limit = query.limit.unwrap_or(DEFAULT_LIMIT);
    if !(1..=MAX_LIMIT).contains(&limit) {
        return Err(wrong(format!("limit is from 1 to {MAX_LIMIT}")));
    }
    let state = query
        .state
        .map(|text| text.parse::<JobState>())
        .transpose()
        .map_err(wrong)?;
    let before = super::super::extract::cursor(query.cursor.as_deref())?;
    let listing = Listing {
        client: caller.client().map(str::to_owned),
        before,
        state,
        name: query.name,
        limit: i64::from(limit) + 1,
    };
    let mut rows = app.store().jobs(&listing).await?;
    let more = rows.len() > usize::from(limit);
    rows.truncate(limit.into());
    Ok(Json(JobListDocument {
        next_cursor: rows
            .last()
            .filter(|_| more)
            .map(|job| job.sequence.to_string()),
        plans: rows
            .iter()
            .map(JobDocument::new)
            .collect::<Result<_, _>>()?,
    }))
}
