//! From a scenario to a verified plan: legs, their order, the whole flight.

pub mod legs;
pub mod order;
pub mod planner;
