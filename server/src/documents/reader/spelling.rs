//! Hints for unknown names: the known names, the most similar one first.

use slewplan_solver::model::spelling::likely;

/// A hint that lists the known names, the likely one first.
pub(crate) fn hint(written: &str, known: &[&str]) -> String {
    let list = known.join(", ");
    match likely(written, known) {
        Some(name) => format!("did you mean {name:?}? Known here: {list}"),
        None => format!("known here: {list}"),
    }
}
