//! The minimum-time slew between two waypoints, and through several of them in a given order.

pub(crate) mod kinematics;
pub(crate) mod multiphase;
pub(crate) mod profile;
pub(crate) mod solve;
pub(crate) mod transcription;
