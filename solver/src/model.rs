//! Inputs and answers: spacecraft, scenario, dynamics, plan, and the problems that an input can
//! have.

pub mod attitude;
pub(crate) mod boresights;
pub mod cone;
pub mod drive;
pub(crate) mod dynamics;
pub mod epoch;
pub mod findings;
pub mod input;
pub mod motion;
pub mod order_rules;
pub mod plan;
pub mod problem;
#[cfg(test)]
pub(crate) mod random;
pub mod roll;
pub mod scenario;
pub mod spacecraft;
pub mod spec;
pub mod spelling;
pub(crate) mod sun;
pub mod tolerances;
pub(crate) mod waypoint;
pub(crate) mod wheel_axes;
