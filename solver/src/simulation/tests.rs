//! Flights against closed forms, plans and each other.

mod build;
mod control;
mod flying;
mod random;
mod stopping;
mod validation;
mod winding;
