//! Running the service.

pub(super) mod docs;
pub(super) mod health;
pub(super) mod limits;
pub(super) mod metrics;
pub(super) mod version;
