//! Planning jobs.

pub(super) mod cancel;
pub(super) mod create;
pub(super) mod delete;
pub(super) mod events;
mod forms;
pub(super) mod get;
pub(super) mod list;
pub(super) mod result;
pub(super) mod scenario;
pub(super) mod stop;
