//! The table of leg times as JSON: what it is a table of, its rows and, where they are asked for,
//! the motions behind them.

use super::document::{Member, Node};
use super::number::Number;
use serde::Serialize;
use serde_json::value::{RawValue, to_raw_value};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{LegRow, Shard};

pub(crate) mod read;

/// A table of leg times, whole or in part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LegTable {
    /// Version that solved it.
    pub(crate) version: String,
    /// The conditions at the ends of its legs.
    pub(crate) kind: LegKind,
    /// What [`scenario_key`] makes of the scenario.
    pub(crate) scenario_key: String,
    /// Which part of the whole table it is.
    pub(crate) shard: Shard,
    /// Whether everything was solved.
    pub(crate) complete: bool,
    /// The scenario itself, where the motions are.
    pub(crate) scenario: Option<Node>,
    /// Start, targets and end, from each to each other.
    pub(crate) rows: Vec<LegRow>,
    /// The motions behind the rows, each of them once, in the order of their keys.
    pub(crate) motions: Option<Vec<KeyedLeg>>,
}

/// A motion with the key under which it is cached.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeyedLeg {
    /// SHA-256 of the canonical text of the leg's problem, hex.
    pub(crate) key: String,
    /// The motion.
    pub(crate) motion: Motion,
    /// Wall-clock time that the solve took, s.
    pub(crate) solve_time_s: f64,
}

/// The key of a scenario: SHA-256 of its text with sorted members and all numbers written as
/// floating point, so that neither its layout nor a program that it went through matters.
pub(crate) fn scenario_key(scenario: &Node) -> String {
    crate::base::digest::hex(canonical(scenario).to_json().as_bytes())
}

fn canonical(node: &Node) -> Node {
    match node {
        Node::Integer(value) => {
            let float = *value as f64;
            // Above 2^53 a float would make different numbers one.
            if float < INTEGERS_END {
                Node::Number(float)
            } else {
                Node::Integer(*value)
            }
        }
        // Adding zero turns -0 into 0.
        Node::Number(value) => Node::Number(value + 0.0),
        Node::List(items) => Node::List(items.iter().map(canonical).collect()),
        Node::Object(members) => {
            let member = |(name, value): &Member| (name.clone(), canonical(value));
            let mut members: Vec<_> = members.iter().map(member).collect();
            members.sort_by(|one, other| one.0.cmp(&other.0));
            Node::Object(members.into())
        }
        Node::Null | Node::Bool(_) | Node::Text(_) => node.clone(),
    }
}

/// From here on not every whole number is a 64-bit float: 2^53.
const INTEGERS_END: f64 = 9_007_199_254_740_992.0;

/// The answer of `legs`.
#[derive(Debug, Serialize)]
pub(crate) struct LegTableDocument<'a> {
    version: &'a str,
    kind: &'static str,
    scenario_key: &'a str,
    shard: ShardDocument,
    /// False when the work was stopped early: the table holds what was finished.
    complete: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<&'a Node>,
    legs: Vec<LegDocument<'a>>,
    /// One line each: there are many numbers in them, and nobody reads them.
    #[serde(skip_serializing_if = "Option::is_none")]
    trajectories: Option<Vec<Box<RawValue>>>,
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

#[derive(Debug, Serialize)]
struct MotionDocument<'a> {
    key: &'a str,
    solve_time_s: Number,
    lengths_s: Vec<Number>,
    attitudes_xyzw: Vec<[Number; 4]>,
    wheel_momenta_nms: Vec<Vec<Number>>,
}

impl<'a> LegTableDocument<'a> {
    /// A table as it is written.
    ///
    /// # Errors
    ///
    /// When a number is not finite.
    pub(crate) fn new(table: &'a LegTable) -> Result<Self, serde_json::Error> {
        let line = |motion| to_raw_value(&MotionDocument::from(motion));
        let lines = |motions: &'a Vec<KeyedLeg>| motions.iter().map(line).collect();
        Ok(Self {
            version: &table.version,
            kind: table.kind.into(),
            scenario_key: &table.scenario_key,
            shard: ShardDocument {
                index: table.shard.index + 1,
                of: table.shard.of,
            },
            complete: table.complete,
            scenario: table.scenario.as_ref(),
            legs: table.rows.iter().map(LegDocument::from).collect(),
            trajectories: table.motions.as_ref().map(lines).transpose()?,
        })
    }
}

impl<'a> From<&'a LegRow> for LegDocument<'a> {
    fn from(row: &'a LegRow) -> Self {
        Self {
            from: &row.from,
            to: &row.to,
            kind: row.kind.into(),
            duration_s: row.duration_s.map(Number),
            certified_lower_bound_s: row.certified_lower_bound_s.map(Number),
            solve_time_s: Number(row.solve_time_s),
            status: &row.status,
        }
    }
}

impl<'a> From<&'a KeyedLeg> for MotionDocument<'a> {
    fn from(leg: &'a KeyedLeg) -> Self {
        let attitudes = leg.motion.attitudes_xyzw.iter();
        let momenta = leg.motion.wheel_momenta_nms.iter();
        Self {
            key: &leg.key,
            solve_time_s: Number(leg.solve_time_s),
            lengths_s: Number::all(&leg.motion.lengths_s),
            attitudes_xyzw: attitudes.map(|xyzw| xyzw.map(Number)).collect(),
            wheel_momenta_nms: momenta.map(|node| Number::all(node)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documents::document::parse;

    #[test]
    fn the_key_of_a_scenario_does_not_depend_on_its_layout() {
        let key = |text: &str| scenario_key(&parse(text.as_bytes()).unwrap());
        let written = key(r#"{"a": 710, "b": {"d": [-0.0, 1e-3], "c": null}}"#);
        assert_eq!(written, key(r#"{"b":{"c":null,"d":[0,0.001]},"a":710.0}"#));
        for other in [
            r#"{"a": 711, "b": {"d": [0, 0.001], "c": null}}"#,
            r#"{"a": 710, "b": {"d": [0.001, 0], "c": null}}"#,
            r#"{"a": 710, "b": {"d": [0, 0.001]}}"#,
        ] {
            assert_ne!(written, key(other));
        }
        // Large seeds stay apart.
        assert_ne!(key("18446744073709551615"), key("18446744073709551614"));
    }
}
