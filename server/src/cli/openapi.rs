//! `slewplan openapi`: the description of the service.

use super::failure::Failure;
use super::{Exit, output};
use crate::api;

/// Prints the description on standard output.
pub(super) fn run() -> Result<Exit, Failure> {
    output::print(&api::openapi())?;
    Ok(Exit::Complete)
}
