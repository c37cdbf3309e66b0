//! Studies: what the choice of an option leads to, and what wheels can do together.

pub(crate) mod authority;
pub(crate) mod comparison;
pub(crate) mod envelopes;
pub(crate) mod flight;
mod spread;
