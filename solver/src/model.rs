//! What is given and what is answered: spacecraft, scenario, dynamics, plan, and what can be wrong with them.

pub mod attitude;
pub mod drive;
pub(crate) mod dynamics;
pub mod findings;
pub mod input;
pub mod order_rules;
pub mod plan;
pub mod problem;
#[cfg(test)]
pub(crate) mod random;
pub mod scenario;
pub mod spacecraft;
pub mod spec;
pub(crate) mod waypoint;
pub(crate) mod wheel_axes;
