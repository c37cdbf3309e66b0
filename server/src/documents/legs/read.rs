//! Reading a table of leg times that this program, or anyone, wrote.
//!
//! Here only its shape is tested: whether parts fit together is for [`crate::documents::shards`] to say,
//! whether motions can be flown for [`crate::jobs::leg_import`].

use super::super::document::Node;
use super::super::reader::{Cursor, Fields, Sink};
use super::{KeyedLeg, LegTable};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{LegRow, Shard};

const KEY_DIGITS: usize = 64;

/// Reads a table.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read(node: &Node) -> Result<LegTable, Vec<Problem>> {
    let sink = Sink::default();
    let known = &[
        "version",
        "kind",
        "scenario_key",
        "shard",
        "complete",
        "scenario",
        "legs",
        "trajectories",
    ];
    let fields = Cursor::root(node, &sink).object(known);
    let table = fields.and_then(|fields| {
        let table = decode(&fields)?;
        let scenario = scenario_of(node);
        if let Some(scenario) = &scenario
            && super::scenario_key(scenario) != table.scenario_key
        {
            let message = "this is not the key of the scenario that stands beside it";
            let hint = "take the file as slewplan legs wrote it";
            let problem = Problem::new("/scenario_key", Code::ConflictingFields, message, hint);
            sink.push(problem);
        }
        Some(LegTable { scenario, ..table })
    });
    let problems = sink.into_problems();
    table.filter(|_| problems.is_empty()).ok_or(problems)
}

/// The scenario as it stands in a table; `null` is none.
fn scenario_of(node: &Node) -> Option<Node> {
    let scenario = node.member("scenario");
    scenario.filter(|node| **node != Node::Null).cloned()
}

/// All fields but the scenario, which is looked into only where it matters.
fn decode(fields: &Fields<'_>) -> Option<LegTable> {
    let version = fields.required("version").and_then(|text| text.text());
    let kind = fields.required("kind").and_then(|kind| self::kind(&kind));
    let scenario_key = fields
        .required("scenario_key")
        .and_then(|key| self::key(&key));
    let shard = fields
        .required("shard")
        .and_then(|shard| self::shard(&shard));
    let complete = fields.required("complete").and_then(|flag| flag.boolean());
    let rows = fields.required("legs").and_then(|list| list.all(row));
    let motions = match fields.optional("trajectories") {
        Some(list) => Some(list.all(motion)?),
        None => None,
    };
    Some(LegTable {
        version: version?.to_owned(),
        kind: kind?,
        scenario_key: scenario_key?,
        shard: shard?,
        complete: complete?,
        scenario: None,
        rows: rows?,
        motions,
    })
}

fn kind(cursor: &Cursor<'_>) -> Option<LegKind> {
    let kinds = [LegKind::RestToRest, LegKind::LowerBound, LegKind::Certified];
    cursor.choice(&kinds.map(|kind| (kind.into(), kind)))
}

fn key(cursor: &Cursor<'_>) -> Option<String> {
    let text = cursor.text()?;
    let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    if text.len() != KEY_DIGITS || !text.bytes().all(is_digit) {
        let message = format!("a key has {KEY_DIGITS} hexadecimal digits in lower case");
        let hint = "copy it from a file of slewplan legs";
        cursor.report(Code::OutOfRange, message, hint);
        return None;
    }
    Some(text.to_owned())
}

fn shard(cursor: &Cursor<'_>) -> Option<Shard> {
    let fields = cursor.object(&["index", "of"])?;
    let number = |name| fields.required(name).and_then(|number| number.integer());
    let (index, of) = (number("index"), number("of"));
    let (index, of) = (index?, of?);
    if !(1..=of).contains(&index) {
        let message = format!("there is no part {index} of {of}");
        cursor.report(Code::OutOfRange, message, "parts count from 1");
        return None;
    }
    Some(Shard {
        index: usize::try_from(index - 1).ok()?,
        of: usize::try_from(of).ok()?,
    })
}

fn row(cursor: &Cursor<'_>) -> Option<LegRow> {
    let known = &[
        "from",
        "to",
        "kind",
        "duration_s",
        "certified_lower_bound_s",
        "solve_time_s",
        "status",
    ];
    let fields = cursor.object(known)?;
    let text = |name| fields.required(name).and_then(|text| text.text());
    let time = |name| match fields.optional(name) {
        Some(time) => Some(Some(self::time(&time)?)),
        None => Some(None),
    };
    let (from, to, status) = (text("from"), text("to"), text("status"));
    let (duration_s, bound) = (time("duration_s"), time("certified_lower_bound_s"));
    let solve_time_s = fields.required("solve_time_s").and_then(|t| self::time(&t));
    let kind = fields.required("kind").and_then(|kind| self::kind(&kind));
    Some(LegRow {
        from: from?.to_owned(),
        to: to?.to_owned(),
        kind: kind?,
        duration_s: duration_s?,
        certified_lower_bound_s: bound?,
        solve_time_s: solve_time_s?,
        status: status?.to_owned(),
    })
}

fn motion(cursor: &Cursor<'_>) -> Option<KeyedLeg> {
    let known = &[
        "key",
        "solve_time_s",
        "lengths_s",
        "attitudes_xyzw",
        "wheel_momenta_nms",
    ];
    let fields = cursor.object(known)?;
    let key = fields.required("key").and_then(|key| self::key(&key));
    let solve_time_s = fields.required("solve_time_s").and_then(|t| time(&t));
    let lengths_s = fields.required("lengths_s").and_then(|l| l.any_numbers());
    let attitudes = fields.required("attitudes_xyzw");
    let attitudes_xyzw = attitudes.and_then(|list| list.all(Cursor::numbers));
    let momenta = fields.required("wheel_momenta_nms");
    let wheel_momenta_nms = momenta.and_then(|list| list.all(Cursor::any_numbers));
    Some(KeyedLeg {
        key: key?,
        motion: Motion {
            attitudes_xyzw: attitudes_xyzw?,
            wheel_momenta_nms: wheel_momenta_nms?,
            lengths_s: lengths_s?,
        },
        solve_time_s: solve_time_s?,
    })
}

/// A time, s.
fn time(cursor: &Cursor<'_>) -> Option<f64> {
    let time = cursor.number()?;
    if time < 0.0 {
        let message = format!("a time of {time} s is negative");
        cursor.report(Code::OutOfRange, message, "times are at least 0");
        return None;
    }
    Some(time)
}
