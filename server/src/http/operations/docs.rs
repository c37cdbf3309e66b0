//! `/openapi.yaml` and the index of errors.

use super::super::error::ErrorCode;
use super::super::router;
use axum::http::{HeaderName, header};
use axum::response::Html;
use slewplan_solver::problem::Code;
use std::fmt::Write;

/// Read this description
#[utoipa::path(
    get, path = "/openapi.yaml", tag = "operations", operation_id = "get_openapi",
    responses((status = 200, description = "OpenAPI 3.1", body = serde_json::Value,
        content_type = "application/yaml")),
)]
pub(in crate::http) async fn openapi() -> ([(HeaderName, &'static str); 1], String) {
    (
        [(header::CONTENT_TYPE, "application/yaml")],
        router::openapi(),
    )
}

/// Read the index of errors
#[utoipa::path(
    get, path = "/docs/errors", tag = "operations", operation_id = "get_error_index",
    responses((status = 200, description = "Every code and what it means", body = String,
        content_type = "text/html")),
)]
pub(in crate::http) async fn errors() -> Html<String> {
    let mut page = String::from(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Errors</title>\
         <h1>Errors of requests</h1><p>The <code>code</code> of a problem document.</p>\
         <table><tr><th>Code<th>Status<th>Meaning",
    );
    for code in ErrorCode::ALL {
        let (name, status, title) = (code.as_str(), code.status().as_u16(), code.title());
        let _ = write!(
            page,
            "<tr id=\"{name}\"><td><code>{name}</code><td>{status}<td>{title}"
        );
    }
    page.push_str(
        "</table><h1>Problems of inputs</h1><p>The <code>code</code> of an entry of \
         <code>errors</code>, <code>warnings</code> or <code>reasons</code>; each comes with a \
         pointer to its place, a message and a hint.</p><ul>",
    );
    for code in Code::ALL {
        let _ = write!(page, "<li id=\"input-{code}\"><code>{code}</code>");
    }
    page.push_str("</ul></html>\n");
    Html(page)
}
