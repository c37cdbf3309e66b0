//! `GET /v1/version`: name and version of the program.

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;

/// Name and version of the program.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Version)]
pub(in crate::api) struct VersionDocument {
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
    responses((status = 200, description = "The version", body = VersionDocument)),
)]
pub(in crate::api) async fn handler() -> Json<VersionDocument> {
    Json(VersionDocument {
        name: "slewplan",
        version: env!("CARGO_PKG_VERSION"),
        api: "v1",
    })
}
