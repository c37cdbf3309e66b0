//! `PUT /v1/spacecraft/{name}`: store a spacecraft.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{self, BodyErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode};
use super::super::extract::{JsonBody, Named};
use super::StoredSpacecraft;
use crate::base::clock::now_us;
use crate::documents;
use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;

const MAX_NAME: usize = 64;

/// Store a spacecraft under a name
///
/// A document that differs from the newest version becomes the next version; the newest 100 are
/// kept. Jobs keep the version that was the newest when they were submitted.
#[utoipa::path(
    put, path = "/v1/spacecraft/{name}", tag = "spacecraft", operation_id = "put_spacecraft",
    params(("name" = String, Path, pattern = "^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$",
        description = "Letters, digits, dot, dash and underscore")),
    request_body(content = describe::Spacecraft, example = json!(describe::spacecraft())),
    responses(
        (status = 200, description = "The newest version", body = StoredSpacecraft),
        (status = 201, description = "The first version", body = StoredSpacecraft),
        BodyErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Named(name): Named,
    body: JsonBody,
) -> Result<(StatusCode, Json<StoredSpacecraft>), ApiError> {
    check_name(&name)?;
    let problems = documents::spacecraft::problems(&body.node);
    if !problems.is_empty() {
        return Err(ApiError::input(problems));
    }
    let now = now_us();
    let row = app
        .store()
        .put_spacecraft(&caller.own(&name), &body.node.to_json(), now)
        .await?;
    let first = row.version == 1 && row.created_us == now;
    let status = if first {
        StatusCode::CREATED
    } else {
        StatusCode::OK
    };
    Ok((status, Json(StoredSpacecraft::new(name, row)?)))
}

fn check_name(name: &str) -> Result<(), ApiError> {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_.-".contains(&byte);
    let begins = name
        .bytes()
        .next()
        .is_some_and(|byte| plain(byte) && !b".-".contains(&byte));
    if begins && name.len() <= MAX_NAME && name.bytes().all(plain) {
        return Ok(());
    }
    let detail = format!(
        "a name has 1 to {MAX_NAME} letters, digits, dots, dashes and underscores and does \
         not begin with a dot or dash"
    );
    Err(ApiError::new(ErrorCode::InvalidParameter, detail))
}
