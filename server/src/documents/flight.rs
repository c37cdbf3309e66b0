//! Reading a plan made by anyone, as far as it can be flown: passages and torques.
//!
//! Here only its shape is tested. Whether the times fit together is for the verification to say.

use super::document::{self, Node};
use super::reader::{Cursor, Sink};
use slewplan_solver::model::plan::{Control, Flight, Passage};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use std::collections::HashSet;

/// Reads the flight of a plan for a scenario. Fields that do not matter for it are not looked at.
///
/// # Errors
///
/// Everything that keeps it from being flown, with pointers into the plan.
pub(crate) fn read(bytes: &[u8], scenario: &Scenario) -> Result<Flight, Vec<Problem>> {
    read_node(
        &document::parse(bytes).map_err(|problem| vec![problem])?,
        scenario,
    )
}

/// Reads the flight of a document that this program wrote; `None` when it tells why there is none.
///
/// # Errors
///
/// Everything that keeps it from being flown, with pointers into the plan.
pub(crate) fn read_written(
    bytes: &[u8],
    scenario: &Scenario,
) -> Result<Option<Flight>, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    let sink = Sink::default();
    let fields = Cursor::root(&node, &sink).open_object();
    // `null` counts as missing.
    if fields.is_some_and(|fields| fields.optional("total_time_s").is_none()) {
        return Ok(None);
    }
    read_node(&node, scenario).map(Some)
}

/// Reads the flight of a plan that has been parsed.
///
/// # Errors
///
/// Everything that keeps it from being flown, with pointers into the plan.
pub(crate) fn read_node(node: &Node, scenario: &Scenario) -> Result<Flight, Vec<Problem>> {
    let sink = Sink::default();
    let flight = decode(node, scenario, &sink);
    let problems = sink.into_problems();
    match flight {
        Some(flight) if problems.is_empty() => Ok(flight),
        _ => Err(problems),
    }
}

fn decode(node: &Node, scenario: &Scenario, sink: &Sink) -> Option<Flight> {
    let fields = Cursor::root(node, sink).open_object()?;
    let total_time_s = fields
        .required("total_time_s")
        .and_then(|time| time.number());
    let sequence = fields.required("sequence").and_then(|list| sequence(&list));
    let passages = fields.required("passages").and_then(|list| {
        let passages = passages(&list)?;
        check_targets(&list, &passages, scenario);
        Some((list, passages))
    });
    if let (Some(sequence), Some((list, passages))) = (sequence, &passages) {
        check_sequence(list, &sequence, passages);
    }
    let controls = fields
        .required("trajectory")
        .and_then(|trajectory| trajectory.open_object())
        .and_then(|trajectory| trajectory.required("controls"))
        .and_then(|list| controls(&list, scenario));
    Some(Flight {
        total_time_s: total_time_s?,
        passages: passages?.1,
        controls: controls?,
    })
}

fn sequence<'a>(cursor: &Cursor<'a>) -> Option<Vec<&'a str>> {
    cursor.all(Cursor::text)
}

fn passages(cursor: &Cursor<'_>) -> Option<Vec<Passage>> {
    cursor.all(passage)
}

fn passage(cursor: &Cursor<'_>) -> Option<Passage> {
    let fields = cursor.open_object()?;
    let target = fields.required("target").and_then(|id| id.text());
    let time = fields.required("time_s").and_then(|time| time.number());
    // A plan without settle and dwell may leave the departure out.
    let departure = match fields.optional("departure_s") {
        Some(departure) => departure.number(),
        None => time,
    };
    Some(Passage {
        target: target?.to_owned(),
        time_s: time?,
        departure_s: departure?,
    })
}

/// Every target of the scenario is visited exactly once, and nothing else.
fn check_targets(cursor: &Cursor<'_>, passages: &[Passage], scenario: &Scenario) {
    let known: HashSet<&str> = scenario.targets().iter().map(|t| t.id.as_str()).collect();
    let mut visited = HashSet::new();
    let report_at = |index: usize, code, message: &str| {
        if let Some(entry) = cursor.entry(index) {
            entry.report(
                code,
                message,
                "list exactly one passage for every target of the scenario",
            );
        }
    };
    for (index, passage) in passages.iter().enumerate() {
        let target = passage.target.as_str();
        if !known.contains(target) {
            report_at(
                index,
                Code::UnknownReference,
                &format!("{target:?} is no target of the scenario"),
            );
        } else if !visited.insert(target) {
            report_at(
                index,
                Code::DuplicateId,
                &format!("{target:?} is visited again"),
            );
        }
    }
    let missing: Vec<&str> = scenario
        .targets()
        .iter()
        .map(|target| target.id.as_str())
        .filter(|id| !visited.contains(id))
        .collect();
    if !missing.is_empty() {
        cursor.report(
            Code::WrongLength,
            format!("not visited: {}", missing.join(", ")),
            "list one passage for every target of the scenario",
        );
    }
}

fn check_sequence(cursor: &Cursor<'_>, sequence: &[&str], passages: &[Passage]) {
    let visited: Vec<&str> = passages
        .iter()
        .map(|passage| passage.target.as_str())
        .collect();
    if visited != sequence {
        cursor.report(
            Code::ConflictingFields,
            format!(
                "passages visit {}, sequence says {}",
                visited.join(" "),
                sequence.join(" ")
            ),
            "list the passages in the order of the sequence",
        );
    }
}

fn controls(cursor: &Cursor<'_>, scenario: &Scenario) -> Option<Vec<Control>> {
    let wheels = scenario.spacecraft().wheels().len();
    cursor.all(|item| control(item, wheels))
}

fn control(cursor: &Cursor<'_>, wheels: usize) -> Option<Control> {
    let fields = cursor.open_object()?;
    let start = fields.required("start_s").and_then(|time| time.number());
    let duration = fields.required("duration_s").and_then(|time| time.number());
    let torque = fields.required("wheel_torque_nm").and_then(|torque| {
        let values = torque.any_numbers()?;
        if values.len() != wheels {
            torque.report(
                Code::WrongLength,
                format!("{} torques for {wheels} wheels", values.len()),
                "write one torque per wheel in the order of the scenario, 0 for disabled ones",
            );
            return None;
        }
        Some(values)
    });
    Some(Control {
        start_s: start?,
        duration_s: duration?,
        wheel_torque_nm: torque?,
    })
}
