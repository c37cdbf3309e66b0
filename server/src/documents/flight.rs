//! Reading a plan made by anyone, as far as it can be flown: passages and torques.
//!
//! Here only its shape is tested. Whether the times fit together is for the verification to say.

use super::document::{self, Node};
use super::kind::Kind;
use super::reader::{Cursor, Sink};
use slewplan_solver::model::input::{
    InputForm, InputPlace, MemberSchema, NamedSchema, Schema, input_object, optional, required,
};
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
    if let Some(other) = Kind::Plan.mismatch(node) {
        return Err(vec![other]);
    }
    let sink = Sink::default();
    let flight = decode(node, scenario, &sink);
    let problems = sink.into_problems();
    match flight {
        Some(flight) if problems.is_empty() => Ok(flight),
        _ => Err(problems),
    }
}

/// A plan made by anyone, for descriptions.
pub(crate) struct ForeignPlan;

impl InputForm for ForeignPlan {
    type Value = ();

    fn read<P: InputPlace>(_: &P) -> Option<()> {
        Some(())
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "ForeignPlan",
            doc: "What is read of a plan; anything else in it is not looked at.",
            schema: || {
                Schema::OpenObject(vec![
                    MemberSchema::of::<f64>("total_time_s", "", &required()),
                    MemberSchema::of::<Vec<String>>(
                        "sequence",
                        "Identifiers in visiting order.",
                        &required(),
                    ),
                    MemberSchema::of::<Vec<ForeignPassage>>(
                        "passages",
                        "One for every target that is visited, in the same order.",
                        &required(),
                    ),
                    MemberSchema::of::<ForeignTrajectory>("trajectory", "", &required()),
                ])
            },
        })
    }
}

/// The torques of a plan, for descriptions.
struct ForeignTrajectory;

impl InputForm for ForeignTrajectory {
    type Value = ();

    fn read<P: InputPlace>(_: &P) -> Option<()> {
        Some(())
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "ForeignTrajectory",
            doc: "",
            schema: || {
                let controls = MemberSchema::of::<Vec<ForeignControl>>;
                Schema::OpenObject(vec![controls("controls", "", &required())])
            },
        })
    }
}

input_object! {
    /// When a target is visited.
    struct ForeignPassage as "ForeignPassage" open {
        /// Identifier of the target.
        target: String = required(),
        /// The arrival.
        time_s: f64 = required(),
        /// The arrival without it, in a plan without settle and dwell.
        departure_s: Option<f64> = optional(),
    }
}

input_object! {
    /// Constant torques.
    struct ForeignControl as "ForeignControl" open {
        /// When they begin.
        start_s: f64 = required(),
        /// How long they are held.
        duration_s: f64 = required(),
        /// One per wheel.
        wheel_torque_nm: Vec<f64> = required(),
    }
}

fn decode(node: &Node, scenario: &Scenario, sink: &Sink) -> Option<Flight> {
    let fields = Cursor::root(node, sink).open_object()?;
    let total_time_s = fields
        .required("total_time_s")
        .and_then(|time| time.number());
    let sequence = fields
        .required("sequence")
        .and_then(|list| Vec::<String>::read(&list));
    let passages = fields.required("passages").and_then(|list| {
        let read = Vec::<ForeignPassage>::read(&list)?;
        let passages: Vec<_> = read.into_iter().map(Passage::from).collect();
        check_targets(&list, &passages, scenario);
        Some((list, passages))
    });
    if let (Some(sequence), Some((list, passages))) = (sequence, &passages) {
        check_sequence(list, &sequence, passages);
    }
    let wheels = scenario.spacecraft().wheels().len();
    let controls = fields
        .required("trajectory")
        .and_then(|trajectory| trajectory.open_object())
        .and_then(|trajectory| trajectory.required("controls"))
        .and_then(|list| list.all(|item| control(item, wheels)));
    Some(Flight {
        total_time_s: total_time_s?,
        passages: passages?.1,
        controls: controls?,
    })
}

fn control(cursor: &Cursor<'_>, wheels: usize) -> Option<Control> {
    let ForeignControl {
        start_s,
        duration_s,
        wheel_torque_nm,
    } = ForeignControl::read(cursor)?;
    if wheel_torque_nm.len() != wheels {
        let torque = cursor.member("wheel_torque_nm")?;
        torque.report(
            Code::WrongLength,
            format!("{} torques for {wheels} wheels", wheel_torque_nm.len()),
            "write one torque per wheel in the order of the scenario, 0 for disabled ones",
        );
        return None;
    }
    Some(Control {
        start_s,
        duration_s,
        wheel_torque_nm,
    })
}

impl From<ForeignPassage> for Passage {
    fn from(passage: ForeignPassage) -> Self {
        Self {
            target: passage.target,
            time_s: passage.time_s,
            departure_s: passage.departure_s.unwrap_or(passage.time_s),
        }
    }
}

/// Every target of the scenario that may not be left out is visited exactly once, and nothing else twice.
fn check_targets(cursor: &Cursor<'_>, passages: &[Passage], scenario: &Scenario) {
    let known: HashSet<&str> = scenario.targets().iter().map(|t| t.id.as_str()).collect();
    let mut visited = HashSet::new();
    let report_at = |index: usize, code, message: &str| {
        if let Some(entry) = cursor.entry(index) {
            entry.report(
                code,
                message,
                "list exactly one passage for every target that is visited",
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
        .filter(|target| target.value.is_none())
        .map(|target| target.id.as_str())
        .filter(|id| !visited.contains(id))
        .collect();
    if !missing.is_empty() {
        cursor.report(
            Code::WrongLength,
            format!("not visited: {}", missing.join(", ")),
            "list one passage for every target of the scenario without a value",
        );
    }
}

fn check_sequence(cursor: &Cursor<'_>, sequence: &[String], passages: &[Passage]) {
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
