//! `GET /v1/version`: which program answers.

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;

/// Which program answers.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Version)]
pub(in crate::api) struct Document {
    /// Always `slewplan`.
    name: &'static str,
    /// Version of program and solver.
    version: &'static str,
    /// Version of the interface.
    api: &'static str,
}

/// Read the version
#[utoipa::path(
    get, path = "/v1/version", tag = "operations", operation_id = "get_version",
    responses((status = 200, description = "The version", body = Document)),
)]
pub(in crate::api) async fn handler() -> Json<Document> {
    Json(Document {
        name: "slewplan",
        version: env!("CARGO_PKG_VERSION"),
        api: "v1",
    })
}
