//! Reading a slew, perhaps along a sweep.
//!
//! First its shape, and only of a document of the right shape the meaning, each with all of its
//! problems at once.

mod answer;

pub(crate) use answer::SlewAnswerDocument;

use super::document::{self, Node};
use super::reader::{Cursor, Sink};
use slewplan_solver::model::input::{InputForm, InputPlace};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::slew::{Objective, Slew, SlewSpec, Sweep};

/// A valid request for one slew or several.
#[derive(Debug)]
pub(crate) struct SlewRequest {
    /// A label, which nothing depends on.
    pub(crate) name: Option<String>,
    /// What is flown.
    pub(crate) slew: Slew,
    /// Values along which it is solved again and again.
    pub(crate) sweep: Option<Sweep>,
    /// Whether the evidence of optimality is asked for.
    pub(crate) evidence: bool,
    /// Wall-clock limit, s; none without it.
    pub(crate) time_limit_s: Option<f64>,
    /// Doubts that do not stand in the way.
    pub(crate) warnings: Vec<Problem>,
}

/// Reads and validates a request.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read(bytes: &[u8]) -> Result<SlewRequest, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node)
}

/// Reads and validates a request that has been parsed.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read_node(node: &Node) -> Result<SlewRequest, Vec<Problem>> {
    let spec = decode(node)?;
    let valid = Slew::try_new(&spec)?;
    Ok(SlewRequest {
        name: spec.name,
        slew: valid.slew,
        warnings: valid.warnings,
        sweep: spec.sweep,
        evidence: spec.evidence,
        time_limit_s: spec.options.time_limit_s,
    })
}

/// A request of the right shape.
fn decode(node: &Node) -> Result<SlewSpec, Vec<Problem>> {
    let sink = Sink::default();
    let root = Cursor::root(node, &sink);
    let mut spec = SlewSpec::read(&root);
    if let Some(spec) = &mut spec {
        take_value_of_sweep(spec, &root);
        check_time_limit(spec, &root);
        check_evidence(spec, &root);
    }
    let problems = sink.into_problems();
    spec.filter(|_| problems.is_empty()).ok_or(problems)
}

/// An objective without a value of its own has the first one of the sweep, and needs one otherwise.
fn take_value_of_sweep(spec: &mut SlewSpec, root: &Cursor<'_>) {
    let (name, own) = match &mut spec.objective {
        Objective::MinimumTime => return,
        Objective::TimeAndEffort { weight } => ("weight", weight),
        Objective::Energy { duration_s, .. } => ("duration_s", duration_s),
        Objective::MinimumTimeAtEnergy { energy_j, .. } => ("energy_j", energy_j),
    };
    // No number of a document is none.
    if !own.is_nan() {
        return;
    }
    let first = match (name, &spec.sweep) {
        ("weight", Some(Sweep::Weights(values)))
        | ("duration_s", Some(Sweep::Durations(values)))
        | ("energy_j", Some(Sweep::Energies(values))) => values.first(),
        _ => None,
    };
    match first {
        Some(first) => *own = *first,
        None => {
            root.member("objective").and_then(|it| it.required(name));
        }
    }
}

fn check_time_limit(spec: &SlewSpec, root: &Cursor<'_>) {
    let Some(seconds) = spec.options.time_limit_s else {
        return;
    };
    if seconds > 0.0 && seconds <= 1e9 {
        return;
    }
    let options = root.member("options");
    if let Some(limit) = options.and_then(|options| options.member("time_limit_s")) {
        limit.report(
            Code::OutOfRange,
            format!("the time limit is {seconds} s"),
            "give a number of seconds above 0 and at most 1e9, or null for none",
        );
    }
}

fn check_evidence(spec: &SlewSpec, root: &Cursor<'_>) {
    let sweep = root.member("sweep").filter(|sweep| !sweep.is_null());
    if let Some(asked) = root.member("evidence")
        && spec.evidence
        && sweep.is_some()
    {
        asked.report(
            Code::ConflictingFields,
            "evidence is given for a single slew only",
            "ask for the evidence of the slew that is of interest, without the sweep",
        );
    }
}

#[cfg(test)]
mod tests;
