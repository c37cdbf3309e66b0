//! Pages of lists.

use super::error::{ApiError, ErrorCode};

const DEFAULT_LIMIT: u16 = 50;
const MAX_LIMIT: u16 = 200;

/// Maximum number of rows of a page.
#[derive(Debug, Clone, Copy)]
pub(super) struct PageLimit(u16);

impl PageLimit {
    /// The limit of a request; the default without one.
    pub(super) fn of(limit: Option<u16>) -> Result<Self, ApiError> {
        let limit = limit.unwrap_or(DEFAULT_LIMIT);
        if (1..=MAX_LIMIT).contains(&limit) {
            return Ok(Self(limit));
        }
        let detail = format!("limit is from 1 to {MAX_LIMIT}");
        Err(ApiError::new(ErrorCode::InvalidParameter, detail))
    }

    /// How many rows are read: one more tells whether there is a next page.
    pub(super) fn read(self) -> i64 {
        i64::from(self.0) + 1
    }

    /// Keeps the rows of the page, and gives the last one where there is a next page.
    pub(super) fn cut<T>(self, rows: &mut Vec<T>) -> Option<&T> {
        let more = rows.len() > usize::from(self.0);
        rows.truncate(self.0.into());
        rows.last().filter(|_| more)
    }
}
