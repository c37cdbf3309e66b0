//! Simulated flights against closed forms, plans and each other.

mod build;
mod cones;
mod control;
mod random;
mod stopping;
mod truth;
mod validation;
mod winding;
