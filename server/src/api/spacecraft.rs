//! Spacecraft stored by name.

pub(super) mod get;
pub(super) mod list;
pub(super) mod put;

use crate::base::clock::rfc3339;
use crate::store::{SpacecraftRow, StoreError};
use serde::Serialize;
use serde_json::value::RawValue;
use utoipa::ToSchema;

/// A version of a stored spacecraft.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct StoredSpacecraft {
    /// Name by which scenarios refer to it: `{"ref": name}`.
    name: String,
    /// Counts from 1 for each name.
    version: i64,
    /// When this version was stored.
    #[schema(format = "date-time")]
    created_at: String,
    /// The spacecraft as submitted.
    #[schema(value_type = super::describe::Spacecraft)]
    spacecraft: Box<RawValue>,
}

impl StoredSpacecraft {
    /// The document of a row; an error if it is not valid JSON.
    fn new(name: String, row: SpacecraftRow) -> Result<Self, StoreError> {
        let damaged = |_| StoreError::Damaged { what: "spacecraft" };
        Ok(Self {
            name,
            version: row.version,
            created_at: rfc3339(row.created_us),
            spacecraft: RawValue::from_string(row.document).map_err(damaged)?,
        })
    }
}
