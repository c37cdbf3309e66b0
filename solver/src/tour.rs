//! From a scenario to a verified plan: solved legs, the order of the targets, which of them are visited
//! when time counts, the whole flight.

pub mod legs;
pub mod order;
pub mod planner;
pub mod schedule;
