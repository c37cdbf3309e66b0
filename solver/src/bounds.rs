//! Durations that no slew undercuts, proved, and the same proved a second time.

pub(crate) mod certified;
pub mod certify;
pub mod kinematic;
