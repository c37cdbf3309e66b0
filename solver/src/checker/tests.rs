//! Tests of the verification: the motion against closed forms, then whole flights.

mod build;
mod clock;
mod cones;
mod dense;
mod enforced_cones;
mod flights;
mod limits;
mod motion;
mod pointing;
mod ramped;
mod refusals;
