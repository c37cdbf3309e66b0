//! What the choice of an option leads to.

pub(super) mod authority;
