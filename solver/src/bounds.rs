//! Certified lower bounds on the durations of slews, and their verification in interval arithmetic.

pub(crate) mod certified;
pub mod certify;
mod interval;
pub mod kinematic;
pub mod polytope;
pub(crate) mod reach;

pub use certified::VERSION;
