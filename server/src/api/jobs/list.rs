//! Jobs page by page.

use super::super::App;
use super::super::access::Caller;
use super::super::error::{ApiError, ErrorCode};
use super::super::extract;
use super::super::paging::PageLimit;
use crate::store::{JobRow, JobState, Listing, Work};
use serde::Deserialize;
use utoipa::IntoParams;

/// Filter and page of a list.
#[derive(Debug, Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
#[into_params(parameter_in = Query)]
pub(in crate::api) struct PageQuery {
    /// Only jobs in this state.
    #[param(inline, value_type = Option<JobState>)]
    pub(in crate::api) state: Option<String>,
    /// Where the page begins: `next_cursor` of the page before.
    #[param(pattern = "^[0-9]{1,9}$")]
    pub(in crate::api) cursor: Option<String>,
    /// Maximum number of jobs of the page.
    #[param(minimum = 1, maximum = 200, default = 50)]
    pub(in crate::api) limit: Option<u16>,
}

/// Which names of jobs a list has; all by default.
#[derive(Debug, Default)]
pub(in crate::api) struct NameFilter {
    /// Only jobs of exactly this name.
    pub(in crate::api) name: Option<String>,
    /// Only jobs with this in their name or identifier.
    pub(in crate::api) search: Option<String>,
}

/// The jobs of a page, the newest first, and where the next page begins.
pub(in crate::api) async fn page(
    app: &App,
    caller: &Caller,
    work: Work,
    query: PageQuery,
    named: NameFilter,
) -> Result<(Vec<JobRow>, Option<String>), ApiError> {
    let wrong = |detail: String| ApiError::new(ErrorCode::InvalidParameter, detail);
    let limit = PageLimit::of(query.limit)?;
    let state = query.state.map(|text| text.parse::<JobState>());
    let listing = Listing {
        work,
        client: caller.client().map(str::to_owned),
        before: extract::cursor(query.cursor.as_deref())?,
        state: state.transpose().map_err(wrong)?,
        name: named.name,
        search: named.search,
        limit: limit.read(),
    };
    let mut rows = app.store().jobs(&listing).await?;
    let next = limit.cut(&mut rows).map(|job| job.sequence.to_string());
    Ok((rows, next))
}
