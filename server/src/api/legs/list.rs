//! `GET /v1/legs`: the cached legs, page by page.

use super::super::App;
use super::super::describe::{ParameterErrors, ServerErrors};
use super::super::error::{ApiError, ErrorCode, ProblemDetails};
use super::super::extract::{self, Parameters};
use super::super::paging::PageLimit;
use crate::documents::stored_legs::{StoredLegDocument, StoredLegListDocument};
use crate::store::LegFilter;
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::problem::{Code, Problem};
use utoipa::IntoParams;

/// Default tolerance: the rounding of attitudes written with six digits, degrees.
const DEFAULT_TOLERANCE_DEG: f64 = 1e-3;

/// Filter and page of the list.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct LegListQuery {
    /// Only legs of the spacecraft with this key.
    #[param(pattern = "^[0-9a-f]{64}$")]
    spacecraft_key: Option<String>,
    /// Only legs that lead to this attitude, a quaternion `x,y,z,w`. Legs are stored without
    /// absolute attitudes, so that only the relative attitude counts: the rotation from `from` to
    /// this one. A `reversible` leg is found from either side.
    #[param(
        example = "0.130526,0,0,0.991445",
        pattern = "^-?[0-9]+([.][0-9]+)?(,-?[0-9]+([.][0-9]+)?){3}$"
    )]
    attitude: Option<String>,
    /// Only legs that lead from this attitude, a quaternion `x,y,z,w`. If one of `from` and
    /// `attitude` is left out, it is the identity.
    #[param(
        example = "0,0,0,1",
        pattern = "^-?[0-9]+([.][0-9]+)?(,-?[0-9]+([.][0-9]+)?){3}$"
    )]
    from: Option<String>,
    /// Maximum angle, degrees, between the requested relative attitude and the `turn` of a leg.
    #[param(minimum = 0, maximum = 180, default = 0.001)]
    tolerance_deg: Option<f64>,
    /// Where the page begins: `next_cursor` of the page before.
    #[param(pattern = "^[0-9]{1,9}$")]
    cursor: Option<String>,
    /// Maximum number of legs of the page.
    #[param(minimum = 1, maximum = 200, default = 50)]
    limit: Option<u16>,
}

/// List cached legs in the order in which they were stored
#[utoipa::path(
    get, path = "/v1/legs", tag = "legs", operation_id = "list_legs",
    params(LegListQuery),
    responses(
        (status = 200, description = "A page of legs", body = StoredLegListDocument),
        (status = 422, description = "The attitude has no direction",
            body = ProblemDetails<'static>, content_type = "application/problem+json"),
        ParameterErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    Parameters(query): Parameters<LegListQuery>,
) -> Result<Json<StoredLegListDocument>, ApiError> {
    let limit = PageLimit::of(query.limit)?;
    let tolerance = query.tolerance_deg.unwrap_or(DEFAULT_TOLERANCE_DEG);
    if !(0.0..=180.0).contains(&tolerance) {
        return Err(wrong("tolerance_deg is from 0 to 180"));
    }
    let is_key = |text: &String| {
        text.len() == 64 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
    };
    if query
        .spacecraft_key
        .as_ref()
        .is_some_and(|key| !is_key(key))
    {
        return Err(wrong(
            "spacecraft_key has 64 hexadecimal digits in lower case",
        ));
    }
    let turn = turn(query.from.as_deref(), query.attitude.as_deref())?;
    let filter = LegFilter {
        spacecraft: query.spacecraft_key,
        turn: turn.map(|turn| (turn, tolerance.to_radians())),
        after: extract::cursor(query.cursor.as_deref())?,
        limit: limit.read(),
    };
    let mut rows = app.store().legs(&filter).await?;
    let next_cursor = limit.cut(&mut rows).map(|leg| leg.sequence.to_string());
    Ok(Json(StoredLegListDocument {
        next_cursor,
        legs: rows.iter().map(StoredLegDocument::from).collect(),
    }))
}

fn wrong(detail: impl Into<String>) -> ApiError {
    ApiError::new(ErrorCode::InvalidParameter, detail)
}

/// The requested relative attitude, if any.
fn turn(from: Option<&str>, to: Option<&str>) -> Result<Option<[f64; 4]>, ApiError> {
    if from.is_none() && to.is_none() {
        return Ok(None);
    }
    let attitude = |name, text: Option<&str>| {
        text.map_or(Ok(Attitude::identity()), |text| quaternion(name, text))
    };
    let (from, to) = (attitude("from", from)?, attitude("attitude", to)?);
    Ok(Some(from.turn_to(&to).xyzw()))
}

/// Reads a quaternion of any norm but zero.
fn quaternion(name: &str, text: &str) -> Result<Attitude, ApiError> {
    let parts: Option<Vec<f64>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    let xyzw: Option<[f64; 4]> = parts.and_then(|parts| parts.try_into().ok());
    let xyzw =
        xyzw.ok_or_else(|| wrong(format!("{name} is a quaternion x,y,z,w of four numbers")))?;
    Attitude::from_xyzw(xyzw).ok_or_else(|| {
        ApiError::input(vec![Problem::new(
            // The name of the parameter takes the place of a pointer.
            format!("/{name}"),
            Code::ZeroDirection,
            format!("{text} has no direction: its length is zero or not finite"),
            "write a quaternion x,y,z,w of any finite length but zero",
        )])
    })
}
