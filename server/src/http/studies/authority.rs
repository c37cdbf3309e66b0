//! `POST /v1/studies/authority`: how much of the wheels a plan should leave to feedback.

use super::super::access::Caller;
use super::super::describe::{self, AuthorityBody, BodyErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::JsonBody;
use super::super::{App, computing, stored};
use crate::wire::document::Node;
use crate::wire::study::{self, AuthorityAnswerDocument, AuthorityStudy};
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use slewplan_solver::legs::NoStore;
use slewplan_solver::planner::Run;
use slewplan_solver::pool::SolverPool;
use slewplan_solver::progress::Silent;
use slewplan_solver::stop::StopSignal;
use std::sync::Arc;

/// Compare shares of torque and wheel speed
///
/// For each pair of shares the scenario is planned with them, and the plan flown many times in closed
/// loop, with inertia, alignment, friction, sensors and disturbances as uncertain as given. What is
/// not done within a minute is left out, and `complete` is false.
#[utoipa::path(
    post, path = "/v1/studies/authority", tag = "studies", operation_id = "study_authority",
    request_body(content = AuthorityBody, example = json!(describe::authority_study())),
    responses(
        (status = 200, description = "What every pair leads to",
            body = AuthorityAnswerDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::http) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let node = with_spacecraft(&app, &caller, body.node).await?;
    let study = study::read_node(&node).map_err(ApiError::input)?;
    let targets = study.targets();
    let limit = app.limits().targets;
    if targets > limit {
        let detail = format!("{targets} targets; the limit is {limit} (max_targets)");
        return Err(ApiError::new(ErrorCode::TooManyTargets, detail));
    }
    let pool = Arc::clone(&app.0.pool);
    let work = move |stop: &StopSignal| answer(&study, &pool, stop);
    let json = computing::in_turn(&app, computing::LONGEST, work).await??;
    Ok(([(header::CONTENT_TYPE, "application/json")], json).into_response())
}

/// The study with the spacecraft of its scenario written out.
async fn with_spacecraft(app: &App, caller: &Caller, node: Node) -> Result<Node, ApiError> {
    let Node::Object(mut members) = node else {
        return Ok(node);
    };
    if let Some((_, scenario)) = members.iter_mut().find(|(name, _)| name == "scenario") {
        let given = std::mem::replace(scenario, Node::Null);
        (*scenario, _) = stored::write_out(app, caller, given, "/scenario").await?;
    }
    Ok(Node::Object(members))
}

fn answer(
    study: &AuthorityStudy,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Result<Vec<u8>, ApiError> {
    let run = Run {
        pool,
        stop,
        observer: &Silent,
        legs: &NoStore,
        segments: &NoStore,
    };
    let rows = study.conduct(run).map_err(ApiError::input)?;
    serde_json::to_vec(&AuthorityAnswerDocument::new(&rows)).map_err(|error| {
        tracing::error!(%error, "a study cannot be written");
        ApiError::new(ErrorCode::Internal, "the study cannot be written")
    })
}
