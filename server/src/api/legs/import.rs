//! `POST /v1/legs/import`: imports legs that were solved elsewhere into the cache.

use super::super::describe::{self, BodyErrors, LegFileBody, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::JsonBody;
use super::super::{App, admission, computing, respond};
use crate::documents::leg_import::LegImportDocument;
use crate::jobs::leg_import;
use axum::extract::State;
use axum::response::Response;
use slewplan_solver::run::stop::StopSignal;
use std::sync::Arc;

/// Import legs that were solved elsewhere into the cache
///
/// The body is a file of `slewplan legs --trajectories`, whole or a shard. The checker integrates
/// every leg before it is cached, and lower bounds are proved again; legs that fail are listed and
/// left out. The optimality of the legs is taken on trust: import files from trusted sources only.
/// Legs that are cached already stay unchanged.
#[utoipa::path(
    post, path = "/v1/legs/import", tag = "legs", operation_id = "import_legs",
    request_body(content = LegFileBody, example = json!(describe::leg_file())),
    responses(
        (status = 200, description = "Numbers of imported and known legs, and the refused ones",
            body = LegImportDocument<'static>),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    body: JsonBody,
) -> Result<Response, ApiError> {
    let import = leg_import::read(&body.node).map_err(ApiError::input)?;
    admission::check_targets(&app, import.scenario.targets().len())?;
    let pool = Arc::clone(&app.0.pool);
    let work = move |stop: &StopSignal| import.check(&pool, stop);
    let checked = computing::in_turn(&app, computing::UNTIL_DONE, work).await?;
    let checked = checked
        .ok_or_else(|| ApiError::new(ErrorCode::NotReady, "the service is shutting down"))?;
    let counts = checked.store(app.store()).await?;
    let document = LegImportDocument::new(counts, &checked.refused);
    let json = respond::written(&document, "answer")?;
    Ok(respond::json(json))
}
