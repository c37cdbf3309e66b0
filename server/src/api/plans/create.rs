//! `POST /v1/plans`: submits a scenario as a job.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{BodyErrors, QuotaErrors, Scenario, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::{JsonBody, Parameters};
use super::super::jobs::{self, submission};
use super::super::{admission, stored};
use crate::base::digest;
use crate::documents;
use crate::documents::jobs::JobDocument;
use crate::documents::plan::PlanDocument;
use crate::documents::problems::ValidationDocument;
use crate::store::{JobRow, Submission, Work};
use axum::Json;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use slewplan_solver::model::scenario::Validated;
use slewplan_solver::tour::planner;
use std::time::Duration;
use utoipa::IntoParams;
use uuid::Uuid;

/// Parameters of a submission.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct SubmissionQuery {
    /// Validate the scenario only; nothing is queued.
    #[serde(default)]
    validate_only: bool,
    /// Jobs of greater priority are solved first.
    #[serde(default)]
    #[param(minimum = -10, maximum = 10, default = 0)]
    priority: i64,
}

/// Submit a scenario
///
/// Answers with a job, or, with `Prefer: wait=N`, with the finished plan when it is ready within
/// N seconds (at most 60). A job that ends within that time without a plan, because it is cancelled
/// or dies, is answered with 200 too; its `state` is final then.
#[utoipa::path(
    post, path = "/v1/plans", tag = "plans", operation_id = "create_plan",
    params(
        SubmissionQuery,
        ("Idempotency-Key" = Option<String>, Header, min_length = 1, max_length = 255,
            pattern = "^[!-~]+$",
            description = "The same request under the same key makes one job"),
        ("Prefer" = Option<String>, Header,
            description = "`wait=N`: answer with the plan when it is ready within N seconds"),
    ),
    request_body(content = Scenario, examples(
        ("two-targets" = (summary = "Two targets, one with settle and dwell",
            value = json!(super::super::describe::two_targets()))),
        ("experiment-a" = (summary = "The published experiment A",
            value = json!(super::super::describe::experiment_a()))),
    )),
    responses(
        (status = 200, description = "The finished plan, the job that ended without one, or the findings of the validation", body = inline(Finished)),
        (status = 202, description = "The job, queued or already running",
            body = JobDocument,
            headers(("Location" = String, description = "Address of the job")),
            links(
                ("get_plan" = (operation_id = "get_plan",
                    parameters(("id" = "$response.body#/id")))),
                ("get_scenario" = (operation_id = "get_scenario",
                    parameters(("id" = "$response.body#/id")))),
                ("get_result" = (operation_id = "get_result",
                    parameters(("id" = "$response.body#/id")))),
                ("follow_plan" = (operation_id = "follow_plan",
                    parameters(("id" = "$response.body#/id")))),
                ("stop_plan" = (operation_id = "stop_plan",
                    parameters(("id" = "$response.body#/id")))),
                ("cancel_plan" = (operation_id = "cancel_plan",
                    parameters(("id" = "$response.body#/id")))),
                ("delete_plan" = (operation_id = "delete_plan",
                    parameters(("id" = "$response.body#/id")))),
            )),
        BodyErrors, QuotaErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Parameters(query): Parameters<SubmissionQuery>,
    headers: HeaderMap,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let key = submission::idempotency_key(&headers)?;
    let priority = submission::priority(query.priority)?;
    let fingerprint = digest::hex(&body.bytes);
    admission::check_size(&app, &body.node)?;
    if key.is_none() && !query.validate_only {
        submission::check_room(&app).await?;
    }
    let (node, written_out) = stored::write_out(&app, &caller, body.node, "").await?;
    let valid = documents::scenario::examine(&node, None)
        .map_err(|faults| ApiError::input(faults.problems).with_warnings(faults.warnings))?;
    let targets = valid.scenario.targets().len();
    if query.validate_only {
        return validation(&valid);
    }
    let memory = admission::check_memory(&app, &valid.scenario)?;
    let submission = Submission {
        id: Uuid::now_v7().to_string(),
        work: Work::Plan,
        name: valid.scenario.name().map(str::to_owned),
        scenario: if written_out {
            node.to_json().into()
        } else {
            body.bytes.into()
        },
        targets: i64::try_from(targets).unwrap_or(i64::MAX),
        memory_bytes: memory.try_into().unwrap_or(i64::MAX),
        client: caller.client().map(str::to_owned),
        priority,
        key: key.map(|key| (caller.own(&key), fingerprint)),
    };
    let (job, replayed) = submission::submit(&app, &submission).await?;
    let response = answer(&app, &job, submission::wait(&headers)).await?;
    submission::located(response, &job, replayed)
}

/// The answer of a finished request.
#[derive(serde::Serialize, utoipa::ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only describes the answer")]
enum Finished {
    /// With `Prefer: wait`.
    Plan(Box<PlanDocument<'static>>),
    /// With `Prefer: wait`, of a job that ended without a plan.
    Job(Box<JobDocument>),
    /// With `validate_only`.
    Validation(ValidationDocument<'static>),
}

fn validation(valid: &Validated) -> Result<Response, ApiError> {
    let obstacles = planner::feasibility_problems(&valid.scenario);
    if !obstacles.is_empty() {
        return Err(ApiError::input(obstacles).with_warnings(valid.warnings.clone()));
    }
    Ok(Json(ValidationDocument::new(&[], &valid.warnings)).into_response())
}

/// The plan if it is ready in time, else the job.
async fn answer(app: &App, job: &JobRow, wait: Option<Duration>) -> Result<Response, ApiError> {
    let Some(patience) = wait else {
        return jobs::answer(StatusCode::ACCEPTED, job);
    };
    let job = jobs::await_end(app, Work::Plan, &job.id, patience).await?;
    let found = app.store().result(&job.id).await?;
    let result = found.and_then(|(_, plan)| plan);
    match result.filter(|result| result.is_final) {
        Some(result) => Ok(super::result::json(&result)),
        // A final job without a plan, such as a cancelled one, gets none later.
        None => jobs::ended_or_accepted(&job),
    }
}
