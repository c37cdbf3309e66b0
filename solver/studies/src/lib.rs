//! Studies that use the solver; the solver does not depend on them.
//!
//! | module | question | source |
//! |---|---|---|
//! | [`eigenaxis`] | how long does a slew about a fixed axis take, for each allocation of demands | RW/CMG thesis, chapter IV |
//! | [`envelope_study`], [`envelope_path`] | what are the envelopes of the wheels, and where in them is a slew | RW/CMG thesis, chapters IV and V |
//! | [`comparison`], [`cmg`], [`catalogue`] | when are wheels faster than gyroscopes | RW/CMG thesis, chapter VII |
//! | [`flight`] | how does a plan perform in one closed-loop simulation | |
//! | [`authority`] | what share of the wheels should a plan leave to feedback | |

pub mod authority;
pub mod catalogue;
pub mod cmg;
pub mod comparison;
pub mod eigenaxis;
pub mod envelope_path;
pub mod envelope_study;
pub mod flight;
