//! `POST /v1/studies/flight`: a plan simulated once in closed loop.

use super::super::access::Caller;
use super::super::describe::{self, BodyErrors, FlightBody, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::JsonBody;
use super::super::{App, admission, computing, respond};
use super::{quiet_run, with_scenario};
use crate::documents::study::flight::{self, FlightAnswerDocument};
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_studies::flight::{FlightStudy, simulate};
use std::sync::Arc;

/// Simulate a plan once in closed loop
///
/// Simulates the given plan, or one made for the scenario within a minute. Errors of inertia,
/// alignment, friction, sensors and disturbances are drawn from the seed and the number of the
/// flight. The answer has errors, commanded torques and active limits over time.
#[utoipa::path(
    post, path = "/v1/studies/flight", tag = "studies", operation_id = "study_flight",
    request_body(content = FlightBody, example = json!(describe::flight_study())),
    responses(
        (status = 200, description = "The flight, or why there is none",
            body = FlightAnswerDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let node = with_scenario(&app, &caller, body.node).await?;
    let study = flight::read_node(&node).map_err(ApiError::input)?;
    if study.plan.is_none() {
        admission::check_memory(&app, &study.scenario)?;
    }
    let pool = Arc::clone(&app.0.pool);
    let work = move |stop: &StopSignal| answer(&study, &pool, stop);
    let json = computing::in_turn(&app, computing::LONGEST, work).await??;
    Ok(respond::json(json))
}

fn answer(study: &FlightStudy, pool: &SolverPool, stop: &StopSignal) -> Result<Vec<u8>, ApiError> {
    let outcome = simulate(study, quiet_run(pool, stop)).map_err(ApiError::input)?;
    respond::written(&FlightAnswerDocument::new(study, &outcome), "flight")
}
