//! Problems of a table, by line and column.

use slewplan_solver::model::problem::{Code, Problem};

/// A problem of a line, or of the cell in the column of an index and a name.
pub(super) fn cell_problem(
    line: u64,
    column: Option<(usize, &str)>,
    code: Code,
    message: impl Into<String>,
    hint: impl Into<String>,
) -> Problem {
    let place = match column {
        Some((index, name)) => format!("line {line}, column {} ({name})", index + 1),
        None => format!("line {line}"),
    };
    Problem::new(place, code, message, hint)
}
