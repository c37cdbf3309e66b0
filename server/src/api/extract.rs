//! What requests bring: bodies, parameters, headers.

use super::App;
use super::error::{ApiError, ErrorCode};
use crate::api::connections::TooSlow;
use crate::documents::document::{self, Node};
use axum::body::Bytes;
use axum::extract::{FromRequest, FromRequestParts, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use http_body_util::BodyExt;
use serde::de::DeserializeOwned;
use std::error::Error;

/// A JSON body: as it came, and as a tree.
pub(super) struct JsonBody {
    /// The bytes as they came.
    pub(super) bytes: Bytes,
    /// What they say.
    pub(super) node: Node,
}

impl FromRequest<App> for JsonBody {
    type Rejection = ApiError;

    async fn from_request(request: Request, app: &App) -> Result<Self, ApiError> {
        check_form(request.headers())?;
        let bytes = read(request, app.limits().body_bytes).await?;
        let (count, most) = (
            document::values_and_names(&bytes),
            app.limits().body_values(),
        );
        if count > most {
            let detail = format!("{count} values and names; the limit is {most} (max_body_values)");
            return Err(ApiError::new(ErrorCode::BodyTooLarge, detail));
        }
        let node = document::parse(&bytes).map_err(|problem| ApiError::input(vec![problem]))?;
        Ok(Self { bytes, node })
    }
}

fn check_form(headers: &HeaderMap) -> Result<(), ApiError> {
    let text = |name| {
        headers
            .get(name)
            .and_then(|value| value.to_str().ok())
            .unwrap_or("")
    };
    let form = text(header::CONTENT_TYPE)
        .split(';')
        .next()
        .unwrap_or("")
        .trim();
    if !form.eq_ignore_ascii_case("application/json") {
        let detail = format!("expected Content-Type: application/json, found {form:?}");
        return Err(ApiError::new(ErrorCode::UnsupportedMediaType, detail));
    }
    let coding = text(header::CONTENT_ENCODING).trim();
    if !coding.is_empty() && !coding.eq_ignore_ascii_case("identity") {
        let detail = format!("send the body as it is, without Content-Encoding: {coding}");
        return Err(ApiError::new(ErrorCode::UnsupportedMediaType, detail));
    }
    Ok(())
}

async fn read(request: Request, limit: usize) -> Result<Bytes, ApiError> {
    let too_large = || {
        let detail = format!("the limit is {limit} bytes (max_body_bytes)");
        ApiError::new(ErrorCode::BodyTooLarge, detail)
    };
    let announced: Option<usize> = request
        .headers()
        .get(header::CONTENT_LENGTH)
        .and_then(|length| length.to_str().ok()?.parse().ok());
    if announced.is_some_and(|length| length > limit) {
        return Err(too_large());
    }
    // One buffer from the beginning: pieces that are joined, or a buffer that grows, would take twice
    // as much. Of what is reserved, only what is written to takes memory.
    let mut bytes = Vec::with_capacity(announced.unwrap_or(limit));
    let mut body = request.into_body();
    while let Some(frame) = body.frame().await {
        let frame = frame.map_err(|error| broken(&error))?;
        let Ok(data) = frame.into_data() else {
            continue;
        };
        if data.len() > limit - bytes.len() {
            return Err(too_large());
        }
        bytes.extend_from_slice(&data);
    }
    bytes.shrink_to_fit();
    Ok(bytes.into())
}

fn broken(error: &axum::Error) -> ApiError {
    if is_too_slow(error) {
        ApiError::new(ErrorCode::BodyTooSlow, TooSlow.to_string())
    } else {
        let detail = format!("the body did not arrive: {error}");
        ApiError::new(ErrorCode::BadRequest, detail)
    }
}

/// Whether the body was given up, somewhere below what the framework makes of it.
fn is_too_slow(error: &(dyn Error + 'static)) -> bool {
    error.is::<TooSlow>() || error.source().is_some_and(is_too_slow)
}

/// The name in the path, or the names. What cannot be a name, because it is no text, names nothing.
pub(super) struct Named<T = String>(pub(super) T);

impl<T: DeserializeOwned + Send> FromRequestParts<App> for Named<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, ApiError> {
        axum::extract::Path::from_request_parts(parts, app)
            .await
            .map(|axum::extract::Path(name)| Self(name))
            .map_err(|error| ApiError::new(ErrorCode::NotFound, error.body_text()))
    }
}

/// Parameters of the query; unknown ones are refused.
pub(super) struct Parameters<T>(pub(super) T);

impl<T: DeserializeOwned> FromRequestParts<App> for Parameters<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, _: &App) -> Result<Self, ApiError> {
        axum::extract::Query::try_from_uri(&parts.uri)
            .map(|axum::extract::Query(parameters)| Self(parameters))
            .map_err(|error| ApiError::new(ErrorCode::InvalidParameter, error.body_text()))
    }
}

/// A header as text, when it is there.
pub(super) fn header_text<'a>(
    headers: &'a HeaderMap,
    name: &'static str,
) -> Result<Option<&'a str>, ApiError> {
    let not_text = |_| {
        let detail = format!("the header {name} has characters that are not ASCII");
        ApiError::new(ErrorCode::InvalidParameter, detail)
    };
    headers
        .get(name)
        .map(|value| value.to_str().map_err(not_text))
        .transpose()
}

/// The place that a cursor stands for.
pub(super) fn cursor(text: Option<&str>) -> Result<Option<i64>, ApiError> {
    let wrong = |_| {
        let detail = "the cursor is not one that was given as next_cursor";
        ApiError::new(ErrorCode::InvalidParameter, detail)
    };
    text.map(|text| text.parse::<u32>().map(i64::from).map_err(wrong))
        .transpose()
}
