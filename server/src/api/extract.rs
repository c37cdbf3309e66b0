//! Extraction of bodies, parameters and headers from requests.

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

/// A JSON body: its bytes and its parsed tree.
pub(super) struct JsonBody {
    /// The bytes as received.
    pub(super) bytes: Bytes,
    /// The parsed document.
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
        let detail = format!("send the body without Content-Encoding: {coding}");
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
    // One buffer of the full size: joining pieces or growing a buffer would take twice the memory.
    // Reserved pages take memory only once they are written.
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

/// Whether [`TooSlow`] is among the sources of an error.
fn is_too_slow(error: &(dyn Error + 'static)) -> bool {
    error.is::<TooSlow>() || error.source().is_some_and(is_too_slow)
}

/// The parameters of the path. Parameters that are not valid text are answered as not found.
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

/// A header as text, if present.
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

/// The sequence number of a cursor.
pub(super) fn cursor(text: Option<&str>) -> Result<Option<i64>, ApiError> {
    let wrong = |_| {
        let detail = "the cursor is not a value of next_cursor";
        ApiError::new(ErrorCode::InvalidParameter, detail)
    };
    text.map(|text| text.parse::<u32>().map(i64::from).map_err(wrong))
        .transpose()
}
