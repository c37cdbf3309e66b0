//! `POST /v1/legs/query`: leg times between attitudes.

use super::super::access::Caller;
use super::super::computing::{self, WorkTurn};
use super::super::describe::{self, BodyErrors, LegQueryBody, ServerErrors};
use super::super::error::{ApiError, ErrorCode, ProblemDetails};
use super::super::extract::JsonBody;
use super::super::{App, negotiation, stored, streaming};
use crate::base::contradictions::ContradictionObserver;
use crate::documents::document::Node;
use crate::documents::leg_query::{self, LegQuery, MAX_LEGS, Refusal};
use crate::documents::leg_rows::{LegAnswerDocument, LegAnswersDocument, LegRow};
use crate::render::leg_table::{TableForm, TableHead, TableWriter};
use crate::store::leg_key;
use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::{LegKind, LegStore, NoStore};
use slewplan_solver::tour::planner::{LegTimeTable, Run};
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::thread;
use tokio::runtime::Handle;

/// Maximum number of legs that a query solves: the full matrix of 32 attitudes.
pub(in crate::api) const MAX_PAIRS: usize = 1000;
/// Number of legs that are worked out and written together.
const PART: usize = 2048;

/// Query leg times
///
/// For pairs of attitudes, or the full matrix of a list. `cached_only` answers with the cached legs,
/// all of one moment; `compute` also solves the missing ones, at most 1,000 legs and for at most a
/// minute: larger tables are jobs, `POST /v1/leg-tables`. Legs of the kind `certified` are only
/// computed, without solving any slew, and not stored. Tables that solve nothing have up to 1,000,000
/// legs and are sent while they are made; the connection breaks off when one cannot be finished.
/// Times of cached legs are those of their solve, when their motions were verified.
#[utoipa::path(
    post, path = "/v1/legs/query", tag = "legs", operation_id = "query_legs",
    request_body(content = LegQueryBody, examples(
        ("matrix" = (summary = "The full matrix of three attitudes",
            value = json!(describe::leg_matrix()))),
        ("pair" = (summary = "One leg, only if it is known",
            value = json!(describe::leg_pair()))),
    )),
    responses(
        (status = 200, description = "One answer for every leg; `application/x-ndjson`: a `LegAnswer` a \
            line; `text/csv` and Apache Parquet: the same as columns",
            content(
                (LegAnswersDocument = "application/json"),
                (LegAnswerDocument = "application/x-ndjson"),
                (String = "text/csv"),
                (String = "application/vnd.apache.parquet"),
            )),
        (status = 406, description = "No accepted form", body = ProblemDetails<'static>,
            content_type = "application/problem+json"),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    headers: HeaderMap,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let form = accepted(&headers, &FORMS)?;
    let (node, _) = stored::write_out(&app, &caller, body.node, "").await?;
    let query = read(&node)?;
    let certifies = query.kind == LegKind::Certified;
    if query.compute && !certifies {
        if query.pairs.len() > MAX_PAIRS {
            return Err(too_many(query.pairs.len(), MAX_PAIRS, "max_leg_pairs"));
        }
        let legs = app.jobs().legs(Handle::current());
        let pool = Arc::clone(&app.0.pool);
        let work = move |stop: &StopSignal| {
            let run = Run {
                pool: &pool,
                stop,
                observer: &ContradictionObserver,
                legs: &legs,
                segments: &NoStore,
            };
            write(&query, run, form, Vec::new())
        };
        let body = computing::in_turn(&app, computing::LONGEST, work).await?;
        let body = body.map_err(|error| {
            tracing::error!(%error, "leg times cannot be written");
            ApiError::new(ErrorCode::Internal, "the leg times cannot be written")
        })?;
        return Ok(([(header::CONTENT_TYPE, form.media_type())], body).into_response());
    }
    let turn = app.0.tabulating.take().await?;
    streamed(&app, turn, query, form).await
}

/// All forms, the preferred one first.
const FORMS: [TableForm; 4] = [
    TableForm::Json,
    TableForm::Ndjson,
    TableForm::Csv,
    TableForm::Parquet,
];

/// The form that a request accepts.
pub(in crate::api) fn accepted(
    headers: &HeaderMap,
    forms: &[TableForm],
) -> Result<TableForm, ApiError> {
    negotiation::accepted(headers, forms, TableForm::media_type).ok_or_else(|| {
        let types: Vec<_> = forms.iter().map(|form| form.media_type()).collect();
        let detail = format!("there is {}", types.join(", "));
        ApiError::new(ErrorCode::NotAcceptable, detail)
    })
}

/// Reads a query for legs.
pub(in crate::api) fn read(node: &Node) -> Result<LegQuery, ApiError> {
    leg_query::read(node).map_err(|refusal| match refusal {
        Refusal::Invalid(problems) => ApiError::input(problems),
        Refusal::TooMany(count) => too_many(count, MAX_LEGS, "max_table_legs"),
    })
}

fn too_many(count: usize, limit: usize, name: &str) -> ApiError {
    let detail = format!("{count} legs; the limit is {limit} ({name})");
    ApiError::new(ErrorCode::TooManyPairs, detail)
}

/// A table for which nothing is solved, written while the client reads it.
async fn streamed(
    app: &App,
    turn: WorkTurn,
    query: LegQuery,
    form: TableForm,
) -> Result<Response, ApiError> {
    // Certified legs are not stored, and need no reader of the database.
    let (pool, legs): (_, Box<dyn LegStore + Send>) = if query.compute {
        (&app.0.pool, Box::new(NoStore))
    } else {
        let legs = app.jobs().legs_at_once(Handle::current()).await?;
        (&app.0.lookups, Box::new(legs))
    };
    let pool = Arc::clone(pool);
    Ok(streaming::streamed(
        app,
        turn,
        form.media_type(),
        move |output| {
            let run = Run {
                pool: &pool,
                stop: &StopSignal::new(),
                observer: &ContradictionObserver,
                legs: &*legs,
                segments: &NoStore,
            };
            write(&query, run, form, output)
        },
    ))
}

/// Works out the legs of a query part by part, and writes each while the next one is worked out.
fn write<W: Write + Send>(
    query: &LegQuery,
    run: Run<'_>,
    form: TableForm,
    output: W,
) -> io::Result<W> {
    let table = LegTimeTable::of(&query.scenario, query.kind, run);
    let head = TableHead {
        kind: query.kind.into(),
        spacecraft_key: Some(&leg_key(table.spacecraft())),
        named: false,
    };
    let mut writer = TableWriter::begin(form, head, output)?;
    let parts = (0..query.pairs.len()).step_by(PART);
    let parts = parts.map(|first| query.pairs.part(first, PART));
    thread::scope(|scope| {
        let (worked_out, received) = sync_channel(0);
        let table = &table;
        scope.spawn(move || {
            for pairs in parts {
                let places: Vec<_> = pairs.iter().map(leg_query::Pair::places).collect();
                let times = if query.compute {
                    table.solved(&places)
                } else {
                    table.known(&places)
                };
                // Not received any more when it cannot be written.
                if worked_out.send((times, pairs)).is_err() {
                    return;
                }
            }
        });
        for (times, pairs) in received {
            let rows = times.into_iter().zip(pairs);
            let rows =
                rows.map(|(time, pair)| time.map_or(LegRow::MISSING, LegRow::from).between(pair));
            writer.rows(&rows.collect::<Vec<_>>())?;
        }
        writer.finish()
    })
}
