//! One flight of a plan in closed loop: the request.

mod answer;

pub(crate) use answer::FlightAnswerDocument;

use super::simulation;
use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Sink};
use crate::documents::{flight, scenario};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::simulation::{self as flying, SimulationSpec};
use slewplan_studies::flight::FlightStudy;

/// What a document says beside scenario and plan, which are read on their own.
struct Shape {
    simulation: SimulationSpec,
    number: u64,
    keep_every: Option<usize>,
}

/// Reads and validates a request.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read(bytes: &[u8]) -> Result<FlightStudy, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node)
}

/// Reads and validates a request that has been parsed.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read_node(node: &Node) -> Result<FlightStudy, Vec<Problem>> {
    let sink = Sink::default();
    let shape = decode(&Cursor::root(node, &sink));
    let mut problems = sink.into_problems();
    let Some(shape) = shape else {
        return Err(problems);
    };
    let mut noted = |place: &str, found: Vec<Problem>| {
        problems.extend(Problem::all_under(place, found));
    };
    let valid = node.member("scenario").and_then(|node| {
        scenario::read_node(node, None)
            .map_err(|found| noted("/scenario", found))
            .ok()
    });
    let plan = node.member("plan").filter(|node| **node != Node::Null);
    let plan = plan.zip(valid.as_ref()).and_then(|(node, valid)| {
        flight::read_node(node, &valid.scenario)
            .map_err(|found| noted("/plan", found))
            .ok()
    });
    if let Some(valid) = &valid {
        let found = flying::check(
            &shape.simulation,
            valid.scenario.spacecraft(),
            "/simulation",
        );
        noted("", found);
    }
    let Some(valid) = valid.filter(|_| problems.is_empty()) else {
        return Err(problems);
    };
    Ok(FlightStudy {
        scenario: valid.scenario,
        plan,
        simulation: shape.simulation,
        number: shape.number,
        keep_every: shape.keep_every,
        warnings: valid.warnings,
    })
}

fn decode(cursor: &Cursor<'_>) -> Option<Shape> {
    let known = &["scenario", "plan", "simulation", "flight", "keep_every"];
    let fields = cursor.object(known)?;
    // Told when it is missing; its meaning is for others.
    fields.required("scenario");
    let number = fields.optional("flight").and_then(|it| it.integer());
    Some(Shape {
        simulation: fields
            .optional("simulation")
            .map(|it| simulation::read(&it))
            .unwrap_or_default(),
        number: number.unwrap_or(0),
        keep_every: fields.optional("keep_every").and_then(|it| keep_every(&it)),
    })
}

fn keep_every(cursor: &Cursor<'_>) -> Option<usize> {
    let every = usize::try_from(cursor.integer()?).unwrap_or(usize::MAX);
    if every == 0 {
        cursor.report(
            Code::OutOfRange,
            "every 0th sample is none",
            "give a whole number of at least 1, or leave it out",
        );
        return None;
    }
    Some(every)
}
