//! `POST /v1/studies/comparison`: reaction wheels and control moment gyroscopes compared.

use super::super::describe::{self, BodyErrors, ComparisonBody, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::JsonBody;
use super::super::{App, computing, respond};
use crate::documents::study::comparison::{self, ComparisonAnswerDocument};
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::stop::StopSignal;
use slewplan_studies::comparison::{ComparisonStudy, ComparisonStudySpec};

/// Compare reaction wheels with control moment gyroscopes
///
/// Pyramids of four devices of the same momentum turn the same spacecraft: the answer says which is
/// faster, and from which angle on. It has every table that this rests on: envelopes, singular
/// surfaces, devices and the laws fitted to them, momentum and torque over mass. Values left out of
/// the request are those of the published study, so that `{}` repeats it.
#[utoipa::path(
    post, path = "/v1/studies/comparison", tag = "studies", operation_id = "study_comparison",
    request_body(content = ComparisonBody, example = json!(describe::comparison_study())),
    responses(
        (status = 200, description = "The comparison", body = ComparisonAnswerDocument),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let spec = comparison::read_node(&body.node).map_err(ApiError::input)?;
    let work = move |_: &StopSignal| answer(spec);
    let json = computing::in_turn(&app, computing::LONGEST, work).await??;
    Ok(respond::json(json))
}

fn answer(spec: ComparisonStudySpec) -> Result<Vec<u8>, ApiError> {
    let study = ComparisonStudy::of(spec).map_err(ApiError::input)?;
    let missing = || ApiError::new(ErrorCode::Internal, "the comparison cannot be made");
    let study = study.ok_or_else(missing)?;
    respond::written(&ComparisonAnswerDocument::new(&study), "comparison")
}
