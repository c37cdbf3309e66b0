//! Jobs that make tables of leg times.

pub(super) mod cancel;
pub(super) mod create;
pub(super) mod delete;
pub(super) mod events;
pub(super) mod get;
pub(super) mod list;
pub(super) mod result;
pub(super) mod stop;
