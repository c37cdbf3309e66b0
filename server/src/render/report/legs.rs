//! A table of legs, as text.

use super::blocks::count;
use super::table::aligned;
use crate::documents::legs::LegTable;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::LegRow;

/// What the table is of, and its rows.
pub(crate) fn table(table: &LegTable) -> String {
    let certified = table.kind == LegKind::Certified;
    let is_open = |row: &&LegRow| time(row, certified).is_none();
    let open = table.rows.iter().filter(is_open).count();
    let kind = <&str>::from(table.kind);
    let mut head = vec![format!("{} of kind {kind}", count(table.rows.len(), "leg"))];
    if table.shard.of > 1 {
        let number = table.shard.index + 1;
        head.push(format!("part {number} of {}", table.shard.of));
    }
    if open > 0 {
        let what = if certified { "bound" } else { "solution" };
        head.push(format!("{open} without a {what}"));
    }
    if !table.complete {
        head.push("stopped before all were solved".to_owned());
    }
    let bound = if certified {
        "bound [s]"
    } else {
        "duration [s]"
    };
    let names = ["from", "to", "status", bound, "solved in [s]"];
    let mut rows = vec![names.map(str::to_owned).to_vec()];
    rows.extend(table.rows.iter().map(|row| {
        vec![
            row.from.clone(),
            row.to.clone(),
            row.status.replace('_', " "),
            time(row, certified).map_or_else(|| "-".into(), |time| format!("{time:.3}")),
            format!("{:.3}", row.solve_time_s),
        ]
    }));
    format!("{}\n\n{}", head.join(", "), aligned(3, &rows))
}

/// Duration of a leg, or its bound in a table of bounds, s.
fn time(row: &LegRow, certified: bool) -> Option<f64> {
    if certified {
        row.certified_lower_bound_s
    } else {
        row.duration_s
    }
}
