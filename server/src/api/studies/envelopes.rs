//! `POST /v1/studies/envelopes`: torque and momentum envelopes of wheels, and slews within them.

use super::super::access::Caller;
use super::super::describe::{self, BodyErrors, EnvelopeBody, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::JsonBody;
use super::super::{App, computing, respond, stored};
use crate::documents::study::envelopes::{self, EnvelopeAnswerDocument, EnvelopeRequest};
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;

/// Envelopes of the wheels, and slews within them
///
/// The envelopes of torque and momentum, full and limited by the pseudo-inverse; for each turn the
/// slews about the eigenaxis under each limit and, with `time_optimal`, the fastest ones, with
/// their paths in the envelopes; and demands allocated to the wheels. Results not finished within a
/// minute are left out, and `complete` is false.
#[utoipa::path(
    post, path = "/v1/studies/envelopes", tag = "studies", operation_id = "study_envelopes",
    request_body(content = EnvelopeBody, example = json!(describe::envelope_study())),
    responses(
        (status = 200, description = "Envelopes, slews and allocations",
            body = EnvelopeAnswerDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let (node, _) = stored::write_out(&app, &caller, body.node, "").await?;
    let request = envelopes::read_node(&node).map_err(ApiError::input)?;
    let pool = Arc::clone(&app.0.pool);
    let work = move |stop: &StopSignal| answer(&request, &pool, stop);
    let json = computing::in_turn(&app, computing::LONGEST, work).await??;
    Ok(respond::json(json))
}

fn answer(
    request: &EnvelopeRequest,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Result<Vec<u8>, ApiError> {
    let report = request.study.conduct(pool, stop);
    respond::written(&EnvelopeAnswerDocument::new(request, &report), "study")
}
