//! `GET /v1/spacecraft`: the stored spacecraft, page by page.

use super::super::App;
use super::super::access::Caller;
use super::super::describe::{ParameterErrors, ServerErrors};
use super::super::error::ApiError;
use super::super::extract::Parameters;
use super::super::paging::PageLimit;
use crate::base::clock::rfc3339;
use crate::store::SpacecraftName;
use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};

/// Page of the list.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct SpacecraftListQuery {
    /// Where the page begins: `next_cursor` of the page before.
    cursor: Option<String>,
    /// Maximum number of spacecraft of the page.
    #[param(minimum = 1, maximum = 200, default = 50)]
    limit: Option<u16>,
}

/// A stored spacecraft in a list.
#[derive(Debug, Serialize, ToSchema)]
struct ListedSpacecraft {
    /// Name by which scenarios refer to it: `{"ref": name}`.
    name: String,
    /// The newest version.
    version: i64,
    /// When that version was stored.
    #[schema(format = "date-time")]
    created_at: String,
}

impl From<&SpacecraftName> for ListedSpacecraft {
    fn from(row: &SpacecraftName) -> Self {
        Self {
            name: own_part(&row.name).to_owned(),
            version: row.version,
            created_at: rfc3339(row.created_us),
        }
    }
}

/// A page of stored spacecraft.
#[derive(Debug, Serialize, ToSchema)]
pub(in crate::api) struct SpacecraftList {
    /// In the order of their names.
    spacecraft: Vec<ListedSpacecraft>,
    /// The `cursor` of the next page; none after the last one.
    next_cursor: Option<String>,
}

/// List the stored spacecraft by name
#[utoipa::path(
    get, path = "/v1/spacecraft", tag = "spacecraft", operation_id = "list_spacecraft",
    params(SpacecraftListQuery),
    responses(
        (status = 200, description = "A page of spacecraft", body = SpacecraftList),
        ParameterErrors, ServerErrors,
    ),
)]
pub(in crate::api) async fn handler(
    State(app): State<App>,
    caller: Caller,
    Parameters(query): Parameters<SpacecraftListQuery>,
) -> Result<Json<SpacecraftList>, ApiError> {
    let limit = PageLimit::of(query.limit)?;
    let prefix = caller.client().map(|_| caller.own(""));
    let after = query.cursor.map(|name| caller.own(&name));
    let mut rows = app
        .store()
        .spacecraft_names(prefix.as_deref(), after.as_deref(), limit.read())
        .await?;
    let next_cursor = limit
        .cut(&mut rows)
        .map(|row| own_part(&row.name).to_owned());
    Ok(Json(SpacecraftList {
        next_cursor,
        spacecraft: rows.iter().map(ListedSpacecraft::from).collect(),
    }))
}

/// The name without the client before it.
fn own_part(stored: &str) -> &str {
    stored.rsplit_once(' ').map_or(stored, |(_, name)| name)
}
