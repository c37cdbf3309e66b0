//! The parts of a table of leg times, joined to the whole.
//!
//! Part `i` of `n` has the rows `i`, `i + n`, ... of the whole table, counted from zero. The whole
//! table goes through all pairs of different places, by the first and then by the second, so that it
//! can be told from its rows alone whether any is missing.

use crate::documents::legs::{KeyedLeg, LegTable};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::tour::planner::{LegRow, Shard};
use std::collections::BTreeMap;

const SAME_RUN: &str = "join only files of slewplan legs that differ in --shard alone";
const AGAIN: &str = "run slewplan legs for this part again";

/// What is wrong with parts: with which of them, by its position; all of them together without one.
pub(crate) type Misfit = (Option<usize>, Problem);

/// The whole table of its parts, in any order.
///
/// # Errors
///
/// Everything that keeps them from being one table.
pub(crate) fn join(parts: Vec<LegTable>) -> Result<LegTable, Vec<Misfit>> {
    let mut misfits = strangers(&parts);
    misfits.extend(gaps(&parts));
    if !misfits.is_empty() {
        misfits.sort_by_key(|(part, _)| part.unwrap_or(usize::MAX));
        return Err(misfits);
    }
    let mut sorted = parts;
    sorted.sort_by_key(|part| part.shard.index);
    let rows = interleaved(&sorted);
    if let Some(problem) = not_whole(&rows) {
        return Err(vec![(None, problem)]);
    }
    let motions = sorted.iter().map(|part| part.motions.clone()).collect();
    let first = sorted.into_iter().next();
    let first = first.ok_or_else(|| vec![(None, nothing())])?;
    Ok(LegTable {
        shard: Shard { index: 0, of: 1 },
        rows,
        motions: joined_motions(motions),
        ..first
    })
}

fn nothing() -> Problem {
    Problem::new("", Code::ShardMissing, "there is no part", SAME_RUN)
}

/// Where parts are of another table than the first.
fn strangers(parts: &[LegTable]) -> Vec<Misfit> {
    let Some(first) = parts.first() else {
        return vec![(None, nothing())];
    };
    let differs = |(index, part): (usize, &LegTable)| {
        let has = |has: bool| if has { "with" } else { "without" };
        let pairs = [
            ("/version", &*first.version, &*part.version),
            ("/kind", first.kind.into(), part.kind.into()),
            ("/scenario_key", &first.scenario_key, &part.scenario_key),
            (
                "/trajectories",
                has(first.motions.is_some()),
                has(part.motions.is_some()),
            ),
        ];
        let mut found: Vec<_> = pairs
            .iter()
            .filter(|(_, expected, found)| expected != found)
            .map(|(pointer, expected, found)| mismatch(pointer, expected, found))
            .collect();
        if part.shard.of != first.shard.of {
            let [expected, found_of] = [first, part].map(|part| part.shard.of.to_string());
            found.push(mismatch("/shard/of", &expected, &found_of));
        }
        found.into_iter().map(move |problem| (Some(index), problem))
    };
    parts.iter().enumerate().skip(1).flat_map(differs).collect()
}

fn mismatch(pointer: &str, expected: &str, found: &str) -> Problem {
    let message = format!("this is {found:?}, in the first file it is {expected:?}");
    Problem::new(pointer, Code::ShardMismatch, message, SAME_RUN)
}

/// Parts that are not finished, there twice, or not there.
fn gaps(parts: &[LegTable]) -> Vec<Misfit> {
    let mut misfits = Vec::new();
    let mut seen = BTreeMap::new();
    for (index, part) in parts.iter().enumerate() {
        if !part.complete {
            let message = "the run was stopped before all legs of this part were solved";
            let problem = Problem::new("/complete", Code::TableIncomplete, message, AGAIN);
            misfits.push((Some(index), problem));
        }
        if let Some(row) = part.rows.iter().position(|row| row.kind != part.kind) {
            let place = format!("/legs/{row}/kind");
            let problem = mismatch(&place, part.kind.into(), part.rows[row].kind.into());
            misfits.push((Some(index), problem));
        }
        let Shard { index: number, of } = part.shard;
        if seen.insert((of, number), index).is_some() {
            let message = format!("part {} of {of} is there before", number + 1);
            let hint = "name every part once";
            let problem = Problem::new("/shard/index", Code::ShardRepeated, message, hint);
            misfits.push((Some(index), problem));
        }
    }
    let Some(of) = parts.first().map(|part| part.shard.of) else {
        return misfits;
    };
    // No more than are worth reading: the number comes from a file.
    let missing: Vec<String> = (0..of)
        .filter(|number| !seen.contains_key(&(of, *number)))
        .take(MAX_LISTED)
        .map(|number| format!("{}/{of}", number + 1))
        .collect();
    if !missing.is_empty() {
        let message = format!("there is no part {}", missing.join(", "));
        let problem = Problem::new("", Code::ShardMissing, message, AGAIN);
        misfits.push((None, problem));
    }
    misfits
}

/// Most missing parts that are listed.
const MAX_LISTED: usize = 20;

/// The rows of parts in their order in the whole table.
fn interleaved(parts: &[LegTable]) -> Vec<LegRow> {
    let longest = parts.iter().map(|part| part.rows.len()).max().unwrap_or(0);
    (0..longest)
        .flat_map(|row| parts.iter().filter_map(move |part| part.rows.get(row)))
        .cloned()
        .collect()
}

/// Where rows are not those of a whole table.
fn not_whole(rows: &[LegRow]) -> Option<Problem> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if names.last() != Some(&&*row.from) {
            names.push(&row.from);
        }
    }
    let pairs = names
        .iter()
        .flat_map(|from| names.iter().map(move |to| (*from, *to)))
        .filter(|(from, to)| from != to);
    let listed = rows.iter().map(|row| (&*row.from, &*row.to));
    if listed.eq(pairs) {
        return None;
    }
    let message = "together the parts have not every pair of places once, in the order of a table";
    Some(Problem::new("/legs", Code::TableIncomplete, message, AGAIN))
}

/// The motions of all parts, each of them once; those of equal legs are equal.
fn joined_motions(parts: Vec<Option<Vec<KeyedLeg>>>) -> Option<Vec<KeyedLeg>> {
    let parts: Option<Vec<_>> = parts.into_iter().collect();
    let mut by_key = BTreeMap::new();
    for motion in parts?.into_iter().flatten() {
        by_key.entry(motion.key.clone()).or_insert(motion);
    }
    Some(by_key.into_values().collect())
}
