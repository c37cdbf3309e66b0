//! What everything else uses and what uses nothing of it: clock, digests, metrics, keys' scopes, shutdown.

pub(crate) mod access;
pub(crate) mod clock;
pub(crate) mod contradictions;
pub(crate) mod digest;
#[cfg(feature = "faults")]
pub(crate) mod faults;
pub(crate) mod lifecycle;
pub(crate) mod metrics;
