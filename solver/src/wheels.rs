//! Arrays of wheels: envelopes of torque and momentum, allocation of demands, momentum checks.

pub mod allocation;
pub mod array;
pub mod envelope;
