//! Minimum-time attitude scheduling for spacecraft with reaction wheels.

pub mod attitude;
pub mod checker;
mod dynamics;
pub mod envelope;
mod findings;
mod kinematics;
pub mod legs;
mod linear_program;
mod multiphase;
mod nlp;
pub mod plan;
pub mod planner;
pub mod pool;
pub mod problem;
mod profile;
pub mod progress;
pub mod scenario;
pub mod sequence;
mod slew;
pub mod spacecraft;
pub mod spec;
pub mod stop;
mod transcription;
