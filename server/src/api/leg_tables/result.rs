//! `GET /v1/leg-tables/{id}/result`: the rows of a table.

use super::super::App;
use super::super::describe::{NotFound, ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode, ProblemDetails};
use super::super::extract::{Named, Parameters};
use super::super::jobs::{self, JOB_STATE};
use super::super::legs::query;
use super::super::streaming;
use crate::documents::document;
use crate::documents::leg_query::{self, LegQuery};
use crate::documents::leg_rows::{LegAnswerDocument, LegAnswersDocument, LegRow};
use crate::render::leg_table::{TableForm, TableHead, TableWriter};
use crate::store::{JobState, Store, StoreError, Work, leg_key};
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue};
use axum::response::Response;
use serde::Deserialize;
use slewplan_solver::tour::planner;
use std::io::{self, Write};
use tokio::runtime::Handle;
use utoipa::IntoParams;

/// Parameters of a table.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct TableQuery {
    /// Form of the table; without it `Accept` decides.
    #[param(inline, value_type = Option<FormName>)]
    format: Option<String>,
}

/// Names of the forms, for the description.
#[derive(utoipa::ToSchema)]
#[schema(rename_all = "lowercase")]
#[expect(dead_code, reason = "only describes the parameter")]
enum FormName {
    Ndjson,
    Csv,
    Parquet,
    Json,
}

/// The forms of a table, the preferred one first.
const FORMS: [TableForm; 4] = [
    TableForm::Ndjson,
    TableForm::Csv,
    TableForm::Parquet,
    TableForm::Json,
];

/// Read the rows of a table: all of them, or those so far
///
/// In the order of the query. `Job-State` is the state of the job: while it is `queued` or `running`,
/// and after a job that was `stopped`, rows are missing that it has not reached. The connection breaks
/// off when the table cannot be sent to its end.
#[utoipa::path(
    get, path = "/v1/leg-tables/{id}/result", tag = "legs", operation_id = "get_leg_table_result",
    params(
        ("id" = String, Path, format = "uuid", description = "Identifier of the job"),
        TableQuery,
    ),
    responses(
        (status = 200, description = "The rows",
            content(
                (LegAnswerDocument = "application/x-ndjson"),
                (String = "text/csv"),
                (String = "application/vnd.apache.parquet"),
                (LegAnswersDocument = "application/json"),
            ),
            headers(("Job-State" = inline(JobState),
                description = "`queued` or `running`: more rows may follow"))),
        (status = 406, description = "No accepted form", body = ProblemDetails<'static>,
            content_type = "application/problem+json"),
        (status = 409, description = "No rows yet (`result_not_ready`), or none at all (`no_result`)",
            body = ProblemDetails<'static>, content_type = "application/problem+json",
            headers(("Retry-After" = u32, description = "When to come again, s, if no rows yet"))),
        ParameterErrors, NotFound, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Named(id): Named,
    Parameters(parameters): Parameters<TableQuery>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    // The state is read before the parts: a job that has ended has all of its parts.
    let job = jobs::find(&app, Work::LegTable, &id).await?;
    let state = job.state()?;
    let form = match &parameters.format {
        Some(name) => named(name)?,
        None => query::accepted(&headers, &FORMS)?,
    };
    let parts = app.store().table_parts(job.sequence).await?;
    if parts.is_empty() {
        let not_ready = "no leg is done so far; follow the events";
        return Err(jobs::no_result(state, not_ready));
    }
    let found = app.store().scenario(&id).await?;
    let (asked, _) = found.ok_or_else(|| ApiError::not_found("leg table", &id))?;
    let turn = app.0.tabulating.take().await?;
    let table = StoredTable {
        store: app.store().clone(),
        runtime: Handle::current(),
        job: job.sequence,
        parts,
    };
    let work = move |output| table.write(&asked, form, output);
    let mut response = streaming::streamed(&app, turn, form.media_type(), work);
    let state = HeaderValue::from_static(state.into_str());
    response.headers_mut().insert(JOB_STATE, state);
    Ok(response)
}

fn named(name: &str) -> Result<TableForm, ApiError> {
    name.parse().map_err(|_| {
        let detail = "format is one of ndjson, csv, parquet, json";
        ApiError::new(ErrorCode::InvalidParameter, detail)
    })
}

/// The parts of a table in the database.
struct StoredTable {
    store: Store,
    runtime: Handle,
    job: i64,
    /// Positions at which they begin.
    parts: Vec<i64>,
}

impl StoredTable {
    fn write<W: Write + Send>(&self, asked: &[u8], form: TableForm, output: W) -> io::Result<W> {
        let query = read(asked)?;
        let head = TableHead {
            kind: query.kind.into(),
            spacecraft_key: Some(&leg_key(&planner::described_spacecraft(&query.scenario))),
            named: false,
        };
        let mut writer = TableWriter::begin(form, head, output)?;
        for first in &self.parts {
            let part = self.store.table_part(self.job, *first);
            let part = self.runtime.block_on(part).map_err(io::Error::other)?;
            let part = part.ok_or_else(|| io::Error::other("the job was deleted"))?;
            let rows: Vec<Option<LegRow>> = serde_json::from_slice(&part)?;
            let first = usize::try_from(*first).map_err(io::Error::other)?;
            let pairs = query.pairs.part(first, rows.len());
            let rows = rows.into_iter().zip(pairs);
            let rows = rows.filter_map(|(row, pair)| Some(row?.between(pair)));
            writer.rows(&rows.collect::<Vec<_>>())?;
        }
        writer.finish()
    }
}

/// The query of a table, which was valid when it was accepted.
fn read(asked: &[u8]) -> io::Result<LegQuery> {
    let damaged = || io::Error::other(StoreError::Damaged { what: "leg table" });
    let node = document::parse(asked).map_err(|_| damaged())?;
    leg_query::read(&node).map_err(|_| damaged())
}
