//! Studies that use the library.

pub mod cmg;
pub mod comparison;
pub mod eigenaxis;
pub mod envelope_path;
pub mod envelope_study;
pub mod market;
