//! Planning jobs.

pub(super) mod cancel;
pub(super) mod create;
pub(super) mod delete;
pub(super) mod events;
pub(super) mod get;
pub(super) mod list;
pub(super) mod result;
pub(super) mod stop;

use super::App;
use super::error::ApiError;
use crate::store::JobRow;
use std::time::Duration;

/// How long a request that ends a job waits for its end.
const PATIENCE: Duration = Duration::from_secs(2);

/// The job of an identifier.
async fn find(app: &App, id: &str) -> Result<JobRow, ApiError> {
    app.store()
        .job(id)
        .await?
        .ok_or_else(|| ApiError::not_found("plan", id))
}
