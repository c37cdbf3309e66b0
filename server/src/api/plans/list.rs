//! `GET /v1/plans`: the jobs, page by page.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{ParameterErrors, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Parameters;
use super::super::jobs::list::{self, NameFilter, PageQuery};
use crate::documents::jobs::{JobDocument, JobListDocument};
use crate::store::{JobState, Work};
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use utoipa::IntoParams;

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
    /// Only jobs with this in the name of their scenario or in their identifier, in letters of
    /// either case.
    search: Option<String>,
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
    let page = PageQuery {
        state: query.state,
        cursor: query.cursor,
        limit: query.limit,
    };
    let named = NameFilter {
        name: query.name,
        search: query.search,
    };
    let (rows, next_cursor) = list::page(&app, &caller, Work::Plan, page, named).await?;
    let plans = rows.iter().map(JobDocument::new);
    Ok(Json(JobListDocument {
        plans: plans.collect::<Result<_, _>>()?,
        next_cursor,
    }))
}
