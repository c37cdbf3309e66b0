//! Studies that use the solver and that it does not know.
//!
//! | module | question | source |
//! |---|---|---|
//! | [`eigenaxis`] | how fast is a slew about a fixed axis, for each way to share out demands | RW/CMG thesis, chapter IV |
//! | [`envelope_study`], [`envelope_path`] | what can the wheels do together, and where does a slew go in it | RW/CMG thesis, chapters IV and V |
//! | [`comparison`], [`cmg`], [`catalogue`] | wheels or gyroscopes | RW/CMG thesis, chapter VII |
//! | [`flight`] | how a plan flies once in closed loop | |
//! | [`authority`] | how much of the wheels should a plan leave to feedback | |

pub mod authority;
pub mod catalogue;
pub mod cmg;
pub mod comparison;
pub mod eigenaxis;
pub mod envelope_path;
pub mod envelope_study;
pub mod flight;
