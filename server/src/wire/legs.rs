//! The table of leg times as JSON.

use super::number::Number;
use serde::Serialize;
use slewplan_solver::legs::LegKind;
use slewplan_solver::planner::{LegRow, Shard};

/// The answer of `legs`.
#[derive(Debug, Serialize)]
pub(crate) struct LegTableDocument<'a> {
    kind: &'static str,
    shard: ShardDocument,
    /// False when the work was stopped early: the table holds what was finished.
    complete: bool,
    legs: Vec<LegDocument<'a>>,
}

/// Which part of the table this is, counted from one.
#[derive(Debug, Serialize)]
struct ShardDocument {
    index: usize,
    of: usize,
}

#[derive(Debug, Serialize)]
struct LegDocument<'a> {
    from: &'a str,
    to: &'a str,
    kind: &'static str,
    duration_s: Option<Number>,
    certified_lower_bound_s: Option<Number>,
    solve_time_s: Number,
    status: &'a str,
}

impl<'a> LegTableDocument<'a> {
    /// The table with what it is a table of.
    pub(crate) fn new(kind: LegKind, shard: Shard, rows: &'a [LegRow], complete: bool) -> Self {
        Self {
            kind: kind.as_str(),
            shard: ShardDocument {
                index: shard.index + 1,
                of: shard.of,
            },
            complete,
            legs: rows.iter().map(LegDocument::from).collect(),
        }
    }
}

impl<'a> From<&'a LegRow> for LegDocument<'a> {
    fn from(row: &'a LegRow) -> Self {
        Self {
            from: &row.from,
            to: &row.to,
            kind: row.kind.as_str(),
            duration_s: row.duration_s.map(Number),
            certified_lower_bound_s: row.certified_lower_bound_s.map(Number),
            solve_time_s: Number(row.solve_time_s),
            status: &row.status,
        }
    }
}
