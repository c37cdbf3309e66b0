//! A spacecraft that is stored under a name.

use super::document::Node;
use super::reader::{Cursor, Sink};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    ScenarioSpec, SpacecraftOrReference, SpacecraftSpec, TargetSpec,
};

/// Everything that is wrong with a spacecraft alone, with pointers into it.
pub(crate) fn problems(node: &Node) -> Vec<Problem> {
    let sink = Sink::default();
    let read = SpacecraftOrReference::read(&Cursor::root(node, &sink));
    let spec = ScenarioSpec {
        spacecraft: read.unwrap_or_else(SpacecraftSpec::substitute),
        targets: vec![TargetSpec {
            id: "t".into(),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    };
    let shape = sink.into_problems();
    if !shape.is_empty() {
        return shape;
    }
    // At rest at the identity nothing is wrong but what is wrong with the spacecraft.
    let found = Scenario::try_new(&spec).err().unwrap_or_default();
    let within = |problem: Problem| {
        let pointer = problem.pointer.strip_prefix("/spacecraft")?.to_owned();
        Some(Problem { pointer, ..problem })
    };
    found.into_iter().filter_map(within).collect()
}
