//! From a scenario to a verified plan: solved legs, the order of the targets, the whole flight.

pub mod legs;
pub mod order;
pub mod planner;
