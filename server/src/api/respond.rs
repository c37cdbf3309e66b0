//! Answers that several routes give.

use super::error::{ApiError, ErrorCode};
use axum::body::Bytes;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

/// A document as JSON; `what` names it in errors.
pub(super) fn written(document: &impl Serialize, what: &str) -> Result<Vec<u8>, ApiError> {
    serde_json::to_vec(document).map_err(|error| {
        tracing::error!(%error, "the {what} cannot be written");
        ApiError::new(ErrorCode::Internal, format!("the {what} cannot be written"))
    })
}

/// A document that was [written].
pub(super) fn json(document: Vec<u8>) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], document).into_response()
}

/// An answer with a content, its media type and its entity tag.
pub(super) fn tagged(form: &str, tag: &str, body: Bytes) -> Response {
    let mut response = ([(header::CONTENT_TYPE, form.to_owned())], body).into_response();
    if let Some(tag) = quoted(tag) {
        response.headers_mut().insert(header::ETAG, tag);
    }
    response
}

/// The response, or 304 when `If-None-Match` lists its tag.
pub(super) fn unless_known(known: &str, response: Response) -> Response {
    let tag = response.headers().get(header::ETAG);
    let unchanged = tag.and_then(|tag| not_modified(known, tag));
    unchanged.unwrap_or(response)
}

/// 304 if `If-None-Match` lists a tag, for contents that take long to make.
pub(super) fn unless_made(known: &str, tag: &str) -> Option<Response> {
    not_modified(known, &quoted(tag)?)
}

fn not_modified(known: &str, tag: &HeaderValue) -> Option<Response> {
    let this = bare(tag.to_str().ok()?);
    let listed = known.trim() == "*" || known.split(',').any(|one| bare(one) == this);
    let headers = [(header::ETAG, tag.clone())];
    listed.then(|| (StatusCode::NOT_MODIFIED, headers).into_response())
}

fn quoted(tag: &str) -> Option<HeaderValue> {
    HeaderValue::from_str(&format!("\"{tag}\"")).ok()
}

/// A tag without its weakness mark, because `If-None-Match` compares weakly.
fn bare(tag: &str) -> &str {
    tag.trim().trim_start_matches("W/")
}
