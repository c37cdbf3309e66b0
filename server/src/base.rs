//! Small tools for all other rooms: clock, digests, metrics, scopes of keys, shutdown.

pub(crate) mod access;
pub(crate) mod clock;
pub(crate) mod contradictions;
pub(crate) mod digest;
#[cfg(feature = "faults")]
pub(crate) mod faults;
pub(crate) mod lifecycle;
pub(crate) mod metrics;
