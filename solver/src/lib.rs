//! Minimum-time attitude scheduling for spacecraft with reaction wheels.

pub mod attitude;
pub mod checker;
pub mod plan;
pub mod planner;
pub mod pool;
pub mod problem;
pub mod progress;
pub mod scenario;
pub mod sequence;
pub mod spacecraft;
pub mod spec;
pub mod stop;
