//! Certified lower bounds on the durations of slews, and their verification in interval arithmetic.

pub(crate) mod certified;
pub mod certify;
pub mod kinematic;
pub mod polytope;

pub use certified::VERSION;
