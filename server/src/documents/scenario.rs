//! Reading a scenario: first its shape, then its meaning, all problems at once.

use super::document::{self, Node};
use super::kind::Kind;
use super::reader::{Cursor, Sink};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::{Code, Faults, MAX_KEPT, Problem};
use slewplan_solver::model::scenario::{Scenario, Validated};
use slewplan_solver::model::spec::ScenarioSpec;

/// Reads and validates a scenario; a time limit of the caller, s, replaces its own.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read(bytes: &[u8], time_limit_s: Option<f64>) -> Result<Validated, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node, time_limit_s)
}

/// Reads and validates a scenario that has been parsed.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read_node(node: &Node, time_limit_s: Option<f64>) -> Result<Validated, Vec<Problem>> {
    examine(node, time_limit_s).map_err(|faults| faults.problems)
}

/// Reads and validates a scenario that has been parsed, and has the warnings also of one that is
/// refused.
///
/// # Errors
///
/// Everything that is wrong or doubtful with it.
pub(crate) fn examine(node: &Node, time_limit_s: Option<f64>) -> Result<Validated, Faults> {
    if let Some(other) = Kind::Scenario.mismatch(node) {
        return Err(Faults {
            problems: vec![other],
            ..Faults::default()
        });
    }
    let (mut spec, mut problems) = decode(node);
    if time_limit_s.is_some() {
        spec.options.time_limit_s = time_limit_s;
    }
    let found = match Scenario::examine(&spec) {
        Ok(validated) if problems.is_empty() => return Ok(validated),
        Ok(validated) => Faults {
            problems: Vec::new(),
            warnings: validated.warnings,
        },
        // What was replaced is not known in full.
        Err(_) if problems.len() >= MAX_KEPT => Faults::default(),
        Err(faults) => faults,
    };
    let replaced = replaced(&problems);
    let independent = |found: Vec<Problem>| {
        let kept = found.into_iter();
        kept.filter(|problem| !follows_from_a_substitute(problem, &replaced))
            .collect::<Vec<_>>()
    };
    let (further, warnings) = (independent(found.problems), independent(found.warnings));
    problems.extend(further);
    Err(Faults { problems, warnings })
}

/// The places where a substitute stands for something that could not be read.
fn replaced(shape: &[Problem]) -> Vec<String> {
    // Unknown and repeated fields are reported, but nothing stands in for them.
    shape
        .iter()
        .filter(|p| !matches!(p.code, Code::UnknownField | Code::DuplicateField))
        .map(|p| match p.pointer.as_str() {
            "/spacecraft/ref" => "/spacecraft".to_owned(),
            pointer => pointer.to_owned(),
        })
        .collect()
}

/// Whether a problem may only be there because something unreadable was replaced.
fn follows_from_a_substitute(found: &Problem, replaced: &[String]) -> bool {
    let any_related = |place| {
        replaced
            .iter()
            .any(|p| contains(p, place) || contains(place, p))
    };
    let loses_of_wheels = |member| {
        replaced
            .iter()
            .any(|p| contains("/spacecraft/wheels", p) && loses(p, member))
    };
    match found.code {
        // The substitute for a list of wheels has enough of them.
        Code::TooFewWheels => false,
        Code::WheelAxesCoplanar => loses_of_wheels("axis"),
        // The substitute for a wheel that may be disabled is enabled.
        Code::TooManyWheels => loses_of_wheels("enabled"),
        // One entry per wheel, and nobody knows how many wheels were meant.
        Code::WrongLength => {
            any_related(&found.pointer)
                || replaced.iter().any(|p| contains(p, "/spacecraft/wheels"))
        }
        Code::UnknownReference
            if found.pointer.ends_with("/attitude/boresight")
                || found.pointer.ends_with("/pointing/boresight") =>
        {
            any_related(&found.pointer) || any_related("/spacecraft/boresights")
        }
        // Where a boresight points may be said in the member that could not be read.
        Code::MissingField if found.pointer.ends_with("/pointing/direction") => {
            let pointing = found.pointer.trim_end_matches("/direction");
            any_related(&found.pointer) || any_related(&format!("{pointing}/ra_dec_deg"))
        }
        Code::UnknownReference if found.pointer.starts_with("/targets/") => {
            any_related(&found.pointer) || replaced.iter().any(|p| loses_name_of_target(p))
        }
        Code::UnknownReference => {
            any_related(&found.pointer) || any_related("/spacecraft/boresights")
        }
        Code::EndMomentumInconsistent => !replaced.is_empty(),
        // Wheels, limits and inertia are compared with each other.
        Code::RateLimitUnreachable
        | Code::WheelSpeedImplausible
        | Code::AccelerationImplausible => any_related("/spacecraft") || any_related("/start"),
        Code::EpochRequired => any_related(&found.pointer) || any_related("/epoch"),
        // A locked wheel must end as it starts.
        Code::ConflictingFields => any_related(&found.pointer) || any_related("/start"),
        _ => any_related(&found.pointer),
    }
}

/// Whether a place in the list of wheels is this member of one, in it, or a whole wheel.
fn loses(pointer: &str, member: &str) -> bool {
    let mut parts = pointer.split('/').skip(4);
    parts.next().is_none_or(|part| part == member)
}

/// Whether a place is the name of a target, or one around it.
fn loses_name_of_target(pointer: &str) -> bool {
    let mut parts = pointer.split('/').skip(1);
    parts.next() == Some("targets") && parts.nth(1).is_none_or(|part| part == "id")
}

/// Whether one place is the other or lies around it.
fn contains(outer: &str, inner: &str) -> bool {
    inner
        .strip_prefix(outer)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// The scenario with substitutes for what cannot be read, and what that was.
fn decode(node: &Node) -> (ScenarioSpec, Vec<Problem>) {
    let sink = Sink::default();
    let spec = ScenarioSpec::read(&Cursor::root(node, &sink));
    let spec = spec.expect("every member has a substitute");
    (spec, sink.into_problems())
}

#[cfg(test)]
mod tests;
