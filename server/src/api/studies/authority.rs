//! `POST /v1/studies/authority`: shares of torque and wheel speed compared by closed-loop simulation.

use super::super::access::Caller;
use super::super::describe::{self, AuthorityBody, BodyErrors, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::JsonBody;
use super::super::{App, admission, computing, respond};
use super::{quiet_run, with_scenario};
use crate::documents::study::authority::{self, AuthorityAnswerDocument, AuthorityStudy};
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;

/// Compare shares of torque and wheel speed
///
/// For each pair of shares the scenario is planned, and the plan is simulated many times in closed
/// loop with uncertain inertia, alignment, friction, sensors and disturbances. Pairs not finished
/// within a minute are left out, and `complete` is false.
#[utoipa::path(
    post, path = "/v1/studies/authority", tag = "studies", operation_id = "study_authority",
    request_body(content = AuthorityBody, example = json!(describe::authority_study())),
    responses(
        (status = 200, description = "What every pair leads to",
            body = AuthorityAnswerDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let node = with_scenario(&app, &caller, body.node).await?;
    let study = authority::read_node(&node).map_err(ApiError::input)?;
    // Plans are made one at a time, all of the same targets.
    if let Ok(valid) = study.scenario() {
        admission::check_memory(&app, &valid)?;
    }
    let pool = Arc::clone(&app.0.pool);
    let work = move |stop: &StopSignal| answer(&study, &pool, stop);
    let json = computing::in_turn(&app, computing::LONGEST, work).await??;
    Ok(respond::json(json))
}

fn answer(
    study: &AuthorityStudy,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Result<Vec<u8>, ApiError> {
    let rows = study
        .conduct(quiet_run(pool, stop))
        .map_err(ApiError::input)?;
    respond::written(&AuthorityAnswerDocument::new(&rows), "study")
}
