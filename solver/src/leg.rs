//! Minimum-time legs: the program between two waypoints, and the one through several of them in a
//! given order.

pub(crate) mod clear_path;
pub(crate) mod detour;
pub(crate) mod kinematics;
pub(crate) mod multiphase;
pub(crate) mod no_way;
pub(crate) mod profile;
pub(crate) mod solve;
pub(crate) mod transcription;
