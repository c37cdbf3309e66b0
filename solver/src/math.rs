//! Mathematics without spacecraft: quaternions, convex programs, cones, random numbers.

pub mod bang_coast_bang;
pub(crate) mod cone;
pub(crate) mod convex;
pub(crate) mod quaternion;
pub(crate) mod random;
pub(crate) mod rounding;
