//! Leg times.

pub(super) mod get;
pub(super) mod import;
pub(super) mod list;
pub(super) mod query;
