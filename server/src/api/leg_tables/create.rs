//! `POST /v1/leg-tables`: submits a query for leg times as a job.

use super::super::access::Caller;
use super::super::describe::{self, BodyErrors, LegQueryBody, QuotaErrors, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::{JsonBody, Parameters};
use super::super::jobs::{self, submission};
use super::super::legs::query;
use super::super::{App, stored};
use crate::base::digest;
use crate::documents::leg_table_jobs::LegTableJobDocument;
use crate::store::{Submission, Work};
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use serde::Deserialize;
use utoipa::IntoParams;
use uuid::Uuid;

/// Memory that the largest table needs, bytes: its places, times, and the part that is made.
const TABLE_BYTES: i64 = 192 << 20;

/// Parameters of a submission.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct TableQuery {
    /// Jobs of greater priority are solved first.
    #[serde(default)]
    #[param(minimum = -10, maximum = 10, default = 0)]
    priority: i64,
}

/// Submit a table of leg times
///
/// The body is that of `POST /v1/legs/query`; all legs are computed that are not cached, whatever
/// `mode` says. Answers with a job, or, with `Prefer: wait=N`, with the job when it has ended within N
/// seconds (at most 60).
#[utoipa::path(
    post, path = "/v1/leg-tables", tag = "legs", operation_id = "create_leg_table",
    params(
        TableQuery,
        ("Idempotency-Key" = Option<String>, Header, min_length = 1, max_length = 255,
            pattern = "^[!-~]+$",
            description = "The same request under the same key makes one job"),
        ("Prefer" = Option<String>, Header,
            description = "`wait=N`: answer when the job has ended, or after N seconds"),
    ),
    request_body(content = LegQueryBody, examples(
        ("matrix" = (summary = "The full matrix of three attitudes",
            value = json!(describe::leg_matrix()))),
    )),
    responses(
        (status = 200, description = "The job, which has ended", body = LegTableJobDocument),
        (status = 202, description = "The job, queued or already running",
            body = LegTableJobDocument,
            headers(("Location" = String, description = "Address of the job")),
            links(
                ("get_leg_table" = (operation_id = "get_leg_table",
                    parameters(("id" = "$response.body#/id")))),
                ("get_leg_table_result" = (operation_id = "get_leg_table_result",
                    parameters(("id" = "$response.body#/id")))),
                ("follow_leg_table" = (operation_id = "follow_leg_table",
                    parameters(("id" = "$response.body#/id")))),
                ("stop_leg_table" = (operation_id = "stop_leg_table",
                    parameters(("id" = "$response.body#/id")))),
                ("cancel_leg_table" = (operation_id = "cancel_leg_table",
                    parameters(("id" = "$response.body#/id")))),
                ("delete_leg_table" = (operation_id = "delete_leg_table",
                    parameters(("id" = "$response.body#/id")))),
            )),
        BodyErrors, QuotaErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Parameters(query): Parameters<TableQuery>,
    headers: HeaderMap,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let key = submission::idempotency_key(&headers)?;
    let priority = submission::priority(query.priority)?;
    let fingerprint = digest::hex(&body.bytes);
    if key.is_none() {
        submission::check_room(&app).await?;
    }
    let (node, written_out) = stored::write_out(&app, &caller, body.node, "").await?;
    let legs = query::read(&node)?.pairs.len();
    let submission = Submission {
        id: Uuid::now_v7().to_string(),
        work: Work::LegTable,
        name: None,
        scenario: if written_out {
            node.to_json().into()
        } else {
            body.bytes.into()
        },
        targets: i64::try_from(legs).unwrap_or(i64::MAX),
        memory_bytes: TABLE_BYTES,
        client: caller.client().map(str::to_owned),
        priority,
        key: key.map(|key| (caller.own(&key), fingerprint)),
    };
    let (job, replayed) = submission::submit(&app, &submission).await?;
    let response = match submission::wait(&headers) {
        None => jobs::answer(StatusCode::ACCEPTED, &job)?,
        Some(patience) => {
            let job = jobs::await_end(&app, Work::LegTable, &job.id, patience).await?;
            jobs::ended_or_accepted(&job)?
        }
    };
    submission::located(response, &job, replayed)
}
