//! `POST /v1/slews`: one slew, with a choice of objective and command model.

use super::access::Caller;
use super::describe::{self, BodyErrors, ServerErrors, SlewBody};
use super::error::{ApiError, ErrorCode};
use super::extract::JsonBody;
use super::{App, computing, respond, stored};
use crate::documents::slew::{self, SlewAnswerDocument, SlewRequest};
use crate::jobs::slews;
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;

/// Solve one slew
///
/// From a state to a state, in minimum time or for another objective, with torques that are free,
/// sampled or continuous. With `sweep` it is solved for every value, each starting from the
/// solution before. The answer is verified by an integrator that shares no code with the optimiser.
/// Slews not solved within a minute are left out, and `complete` is false.
#[utoipa::path(
    post, path = "/v1/slews", tag = "slews", operation_id = "solve_slew",
    request_body(content = SlewBody, examples(
        ("quarter" = (summary = "A quarter turn in minimum time",
            value = json!(describe::quarter_slew()))),
        ("effort" = (summary = "The same for time and effort, at three weights",
            value = json!(describe::effort_sweep()))),
    )),
    responses(
        (status = 200, description = "The slews", body = SlewAnswerDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(super) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let (node, _) = stored::write_out(&app, &caller, body.node, "").await?;
    let request = slew::read_node(&node).map_err(ApiError::input)?;
    let pool = Arc::clone(&app.0.pool);
    // On the solver's threads, which have a lower priority than those for requests.
    let work = move |stop: &StopSignal| pool.map(&[request], |request| answer(request, stop)).pop();
    let answered = computing::in_turn(&app, computing::LONGEST, work).await?;
    let json =
        answered.ok_or_else(|| ApiError::new(ErrorCode::Internal, "no answer was made"))??;
    Ok(respond::json(json))
}

fn answer(request: &SlewRequest, stop: &StopSignal) -> Result<Vec<u8>, ApiError> {
    let solved = slews::solve(request, stop).map_err(ApiError::input)?;
    let document = SlewAnswerDocument::new(request, &solved.outcomes, solved.complete);
    respond::written(&document, "slew")
}
