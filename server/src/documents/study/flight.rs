//! One flight of a plan in closed loop: the request.

mod answer;

pub(crate) use answer::FlightAnswerDocument;

use crate::documents::document::{self, Node};
use crate::documents::flight::{self, ForeignPlan};
use crate::documents::reader::{Cursor, Sink};
use crate::documents::scenario;
use slewplan_solver::model::input::{
    InputForm, InputPlace, Schema, Unread, input_object, optional, or, required_or,
};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::simulation::{self, SimulationSpec};
use slewplan_studies::flight::FlightStudy;

input_object! {
    /// One simulated flight of a plan in closed loop.
    pub(crate) struct FlightStudySpec as "FlightStudy" {
        /// What the plan is for.
        scenario: () as Unread<ScenarioSpec> = required_or(()),
        /// Which of the flights of the seed; each draws other errors.
        flight: u64 = or(0),
        /// How it is simulated. The number of flights does not matter here.
        simulation: SimulationSpec = or(SimulationSpec::default()),
        /// One out of so many samples of the on-board computer is reported; so many that there are no more
        /// than 2,000 without it.
        keep_every: Option<usize> as Option<KeepEvery> = optional().at_least(1.0).format("uint64"),
        /// A plan of the scenario; made for the flight without it.
        plan: () as Unread<ForeignPlan> = or(()),
    }
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
    let spec = FlightStudySpec::read(&Cursor::root(node, &sink));
    let mut problems = sink.into_problems();
    let Some(spec) = spec else {
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
        let found = simulation::check(&spec.simulation, valid.scenario.spacecraft(), "/simulation");
        noted("", found);
    }
    let Some(valid) = valid.filter(|_| problems.is_empty()) else {
        return Err(problems);
    };
    Ok(FlightStudy {
        scenario: valid.scenario,
        plan,
        simulation: spec.simulation,
        number: spec.flight,
        keep_every: spec.keep_every,
        warnings: valid.warnings,
    })
}

/// Number of samples, at least one.
struct KeepEvery;

impl InputForm for KeepEvery {
    type Value = usize;

    fn read<P: InputPlace>(place: &P) -> Option<usize> {
        let every = usize::read(place)?;
        if every == 0 {
            place.report(
                Code::OutOfRange,
                "every 0th sample is none",
                "give a whole number of at least 1, or leave it out",
            );
            return None;
        }
        Some(every)
    }

    fn schema() -> Schema {
        usize::schema()
    }
}
