//! Studies: what the choice of an option leads to.

mod authority;
mod simulation;
mod spread;

pub(crate) use authority::{AuthorityAnswerDocument, AuthorityStudy, read, read_node};
