//! `POST /v1/verify`: verifies a plan of any origin.

use super::access::Caller;
use super::describe::{self, BodyErrors, ServerErrors, VerifyBody};
use super::error::ApiError;
use super::extract::JsonBody;
use super::{App, admission, computing, respond, stored};
use crate::documents;
use crate::documents::document::Node;
use crate::documents::reader::{Cursor, Sink};
use crate::documents::verification::{ClaimedPlan, ReportDocument, VerifySpec};
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::Problem;

/// Propagate a plan again and test every limit
#[utoipa::path(
    post, path = "/v1/verify", tag = "verify", operation_id = "verify_plan",
    request_body(content = VerifyBody, example = json!(describe::verify_request())),
    responses(
        (status = 200, description = "What the flight showed", body = ReportDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(super) async fn handler(
    State(app): State<App>,
    caller: Caller,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let (scenario, plan) = parts(body.node)?;
    admission::check_size(&app, &scenario)?;
    let (scenario, _) = stored::write_out(&app, &caller, scenario, "/scenario").await?;
    // On other threads, because a long flight takes long to integrate; the answer borrows from it.
    let json =
        computing::integrated(&app.0.integrating, move || verify(&scenario, &plan)).await??;
    Ok(respond::json(json))
}

fn parts(mut node: Node) -> Result<(Node, Node), ApiError> {
    let sink = Sink::default();
    // Both parts are read on their own; here only whether they are there.
    VerifySpec::read(&Cursor::root(&node, &sink));
    let problems = sink.into_problems();
    if !problems.is_empty() {
        return Err(ApiError::input(problems));
    }
    let mut part = |name| node.member_mut(name).map_or(Node::Null, std::mem::take);
    Ok((part("scenario"), part("plan")))
}

fn verify(scenario: &Node, plan: &Node) -> Result<Vec<u8>, ApiError> {
    let valid = documents::scenario::read_node(scenario, None)
        .map_err(|problems| ApiError::input(Problem::all_under("/scenario", problems)))?;
    let plan = ClaimedPlan::read_node(plan, &valid.scenario)
        .map_err(|problems| ApiError::input(Problem::all_under("/plan", problems)))?;
    let found = plan.verify(&valid.scenario);
    let warnings = valid.warnings.into_iter().chain(found.keep_out).collect();
    let mut warnings = Problem::all_under("/scenario", warnings);
    warnings.extend(Problem::all_under("/plan", plan.into_false_claims()));
    let report = ReportDocument::new(&found.verification, &found.margins, &warnings);
    respond::written(&report, "verification")
}
