//! Middleware of every request: its id, log line, metrics, and problem details for all errors.

use super::App;
use super::error::{ApiError, ErrorCode, PROBLEM_JSON};
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::any::Any;
use std::time::Instant;
use tracing::Instrument;
use uuid::Uuid;

const REQUEST_ID: HeaderName = HeaderName::from_static("x-request-id");
const MAX_ID: usize = 64;

/// Gives the request an id, logs and counts it.
pub(super) async fn observe(State(app): State<App>, request: Request, next: Next) -> Response {
    let begin = Instant::now();
    let id = request_id(&request);
    let method = request.method().clone();
    let path = request.uri().path().to_owned();
    let route = request
        .extensions()
        .get::<MatchedPath>()
        .map_or_else(|| "none".to_owned(), |path| path.as_str().to_owned());
    let span = tracing::info_span!("request", request_id = id);
    let mut response = next.run(request).instrument(span.clone()).await;
    let took = begin.elapsed();
    app.0
        .metrics
        .count(&method, &route, response.status(), took);
    span.in_scope(|| {
        let (status, took_ms) = (response.status().as_u16(), took.as_secs_f64() * 1e3);
        tracing::info!(%method, path, status, took_ms, "request answered");
    });
    if let Ok(id) = HeaderValue::from_str(&id) {
        response.headers_mut().insert(REQUEST_ID, id);
    }
    response
}

/// The caller's id if it is a valid one, a new one otherwise.
fn request_id(request: &Request) -> String {
    let given = request
        .headers()
        .get(REQUEST_ID)
        .and_then(|id| id.to_str().ok());
    let plain = |id: &&str| {
        !id.is_empty()
            && id.len() <= MAX_ID
            && id
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte))
    };
    given
        .filter(plain)
        .map_or_else(|| Uuid::new_v4().to_string(), str::to_owned)
}

/// Injects failures for tests.
#[cfg(feature = "faults")]
pub(super) async fn fault(request: Request, next: Next) -> Response {
    crate::base::faults::strike_request(request.headers());
    next.run(request).await
}

/// Replaces error answers of the framework by problem details.
pub(super) async fn envelop(request: Request, next: Next) -> Response {
    let (method, path) = (request.method().clone(), request.uri().path().to_owned());
    let response = next.run(request).await;
    let status = response.status();
    let form = response.headers().get(header::CONTENT_TYPE);
    let is_error = status.is_client_error() || status.is_server_error();
    if !is_error || form.is_some_and(|form| form == PROBLEM_JSON) {
        return response;
    }
    let mut problem = described(status, &method, &path).into_response();
    if let Some(allow) = response.headers().get(header::ALLOW) {
        problem.headers_mut().insert(header::ALLOW, allow.clone());
    }
    problem
}

fn described(status: StatusCode, method: &Method, path: &str) -> ApiError {
    match status {
        StatusCode::NOT_FOUND => {
            ApiError::new(ErrorCode::NotFound, format!("there is nothing at {path}"))
        }
        StatusCode::METHOD_NOT_ALLOWED => ApiError::new(
            ErrorCode::MethodNotAllowed,
            format!("{path} does not support {method}"),
        ),
        status => ApiError::of_status(status),
    }
}

/// The answer to a request whose handler panicked.
pub(super) fn panicked(_: Box<dyn Any + Send>) -> Response {
    ApiError::new(
        ErrorCode::Internal,
        "the cause is in the log, under the request's id",
    )
    .into_response()
}
