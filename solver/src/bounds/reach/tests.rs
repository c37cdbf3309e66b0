//! Motions that exist are not excluded, and what is far from them is.

mod enclosures;
mod motions;
