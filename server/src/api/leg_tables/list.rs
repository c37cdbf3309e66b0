//! `GET /v1/leg-tables`: the jobs, page by page.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{ParameterErrors, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Parameters;
use super::super::jobs::list::{self, NameFilter, PageQuery};
use crate::documents::leg_table_jobs::{LegTableJobDocument, LegTableJobListDocument};
use crate::store::Work;
use axum::Json;
use axum::extract::State;

/// List jobs that make tables of leg times, the newest first
#[utoipa::path(
    get, path = "/v1/leg-tables", tag = "legs", operation_id = "list_leg_tables",
    params(PageQuery),
    responses(
        (status = 200, description = "A page of jobs", body = LegTableJobListDocument),
        ParameterErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Parameters(query): Parameters<PageQuery>,
) -> Result<Json<LegTableJobListDocument>, ApiError> {
    let (rows, next_cursor) =
        list::page(&app, &caller, Work::LegTable, query, NameFilter::default()).await?;
    let leg_tables = rows.iter().map(LegTableJobDocument::new);
    Ok(Json(LegTableJobListDocument {
        leg_tables: leg_tables.collect::<Result<_, _>>()?,
        next_cursor,
    }))
}
