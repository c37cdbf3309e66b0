//! Reading a scenario: first its shape, then its meaning, all problems at once.

use super::document::{self, Node};
use super::reader::{Cursor, Fields, Sink};
use super::{attitude, spacecraft};
use slewplan_solver::model::problem::{Code, Faults, MAX_KEPT, Problem};
use slewplan_solver::model::scenario::{MAX_CONES, MAX_TARGETS, Scenario, Validated};
use slewplan_solver::model::spec::{
    Accuracy, AttitudeEquivalence, KeepOutSpec, OptionsSpec, ScenarioSpec, StateSpec, TargetSpec,
};

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
        Code::UnknownReference if found.pointer.starts_with("/targets/") => {
            any_related(&found.pointer) || replaced.iter().any(|p| loses_name_of_target(p))
        }
        Code::UnknownReference => {
            any_related(&found.pointer) || any_related("/spacecraft/boresights")
        }
        Code::EndMomentumInconsistent => !replaced.is_empty(),
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
    let spec = spec(&Cursor::root(node, &sink));
    (spec, sink.into_problems())
}

/// The scenario at a place, with substitutes for what cannot be read.
pub(super) fn spec(cursor: &Cursor<'_>) -> ScenarioSpec {
    let known = &[
        "name",
        "epoch",
        "time_system",
        "reference_frame",
        "spacecraft",
        "start",
        "end",
        "targets",
        "keep_out",
        "options",
    ];
    cursor
        .object(known)
        .map_or_else(substitute, |fields| scenario(&fields))
}

fn substitute() -> ScenarioSpec {
    ScenarioSpec {
        spacecraft: spacecraft::substitute(),
        ..ScenarioSpec::default()
    }
}

fn scenario(fields: &Fields<'_>) -> ScenarioSpec {
    ScenarioSpec {
        name: label(fields, "name"),
        epoch: label(fields, "epoch"),
        time_system: label(fields, "time_system"),
        reference_frame: label(fields, "reference_frame"),
        spacecraft: fields
            .required("spacecraft")
            .map_or_else(spacecraft::substitute, |cursor| spacecraft::read(&cursor)),
        start: fields
            .required("start")
            .map(|cursor| state(&cursor))
            .unwrap_or_default(),
        end: fields.optional("end").map(|cursor| state(&cursor)),
        targets: fields
            .required("targets")
            .and_then(|targets| targets.each_of_at_most(MAX_TARGETS, target))
            .unwrap_or_default(),
        keep_out: fields
            .optional("keep_out")
            .and_then(|cones| cones.each_of_at_most(MAX_CONES, keep_out))
            .unwrap_or_default(),
        options: fields
            .optional("options")
            .map(|cursor| options(&cursor))
            .unwrap_or_default(),
    }
}

fn label(fields: &Fields<'_>, name: &str) -> Option<String> {
    fields
        .optional(name)
        .and_then(|text| text.text().map(str::to_owned))
}

pub(super) fn state(cursor: &Cursor<'_>) -> StateSpec {
    let Some(fields) = cursor.object(&["attitude", "body_rate_rad_s", "wheel_speed_rad_s"]) else {
        return StateSpec::default();
    };
    StateSpec {
        attitude: fields
            .required("attitude")
            .map(|cursor| attitude::read(&cursor))
            .unwrap_or_default(),
        body_rate_rad_s: fields
            .optional("body_rate_rad_s")
            .and_then(|rate| rate.numbers()),
        wheel_speed_rad_s: fields
            .optional("wheel_speed_rad_s")
            .and_then(|speeds| speeds.any_numbers()),
    }
}

fn target(cursor: &Cursor<'_>) -> TargetSpec {
    // The place is unique, so that a substitute is no duplicate.
    let nameless = || cursor.pointer().to_owned();
    let known = &[
        "id",
        "attitude",
        "zero_rate_axes",
        "rate_min_rad_s",
        "rate_max_rad_s",
        "dwell_s",
        "settle_s",
        "position",
        "after",
    ];
    let Some(fields) = cursor.object(known) else {
        return TargetSpec {
            id: nameless(),
            ..TargetSpec::default()
        };
    };
    let bounds = |name| {
        fields
            .optional(name)
            .and_then(|bound| bound.nullable_numbers())
    };
    let time = |name| {
        fields
            .optional(name)
            .and_then(|time| time.number())
            .unwrap_or(0.0)
    };
    TargetSpec {
        id: fields
            .required("id")
            .and_then(|id| id.text().map(str::to_owned))
            .unwrap_or_else(nameless),
        attitude: fields
            .required("attitude")
            .map(|cursor| attitude::read(&cursor))
            .unwrap_or_default(),
        zero_rate_axes: fields
            .optional("zero_rate_axes")
            .and_then(|axes| zero_rate_axes(&axes)),
        rate_min_rad_s: bounds("rate_min_rad_s"),
        rate_max_rad_s: bounds("rate_max_rad_s"),
        dwell_s: time("dwell_s"),
        settle_s: time("settle_s"),
        position: fields
            .optional("position")
            .and_then(|place| place.integer())
            .map(|place| usize::try_from(place).unwrap_or(usize::MAX)),
        after: fields
            .optional("after")
            .and_then(|names| names.texts())
            .unwrap_or_default(),
    }
}

pub(super) fn zero_rate_axes(cursor: &Cursor<'_>) -> Option<[bool; 3]> {
    let named = cursor.each(|name| name.choice(&[("x", 0), ("y", 1), ("z", 2)]))?;
    Some([0, 1, 2].map(|axis| named.contains(&Some(axis))))
}

fn keep_out(cursor: &Cursor<'_>) -> KeepOutSpec {
    let fields = cursor.object(&["boresight", "direction", "half_angle_deg"]);
    let member = |name| fields.as_ref().and_then(|fields| fields.required(name));
    KeepOutSpec {
        boresight: member("boresight")
            .and_then(|name| name.text().map(str::to_owned))
            .unwrap_or_default(),
        direction: member("direction")
            .and_then(|direction| direction.numbers())
            .unwrap_or([1.0, 0.0, 0.0]),
        half_angle_deg: member("half_angle_deg")
            .and_then(|angle| angle.number())
            .unwrap_or(1.0),
    }
}

pub(super) fn options(cursor: &Cursor<'_>) -> OptionsSpec {
    let default = OptionsSpec::default();
    let known = &[
        "accuracy",
        "attitude_equivalence",
        "time_limit_s",
        "node_limit",
        "relative_gap",
        "alternatives",
        "torque_authority",
        "momentum_authority",
        "seed",
    ];
    let Some(fields) = cursor.object(known) else {
        return default;
    };
    let number = |name, default| {
        fields
            .optional(name)
            .and_then(|value| value.number())
            .unwrap_or(default)
    };
    let meanings = [
        ("rotation", AttitudeEquivalence::Rotation),
        ("quaternion", AttitudeEquivalence::Quaternion),
    ];
    let accuracies = [("standard", Accuracy::Standard), ("tight", Accuracy::Tight)];
    OptionsSpec {
        accuracy: fields
            .optional("accuracy")
            .and_then(|text| text.choice(&accuracies))
            .unwrap_or_default(),
        attitude_equivalence: fields
            .optional("attitude_equivalence")
            .and_then(|text| text.choice(&meanings))
            .unwrap_or_default(),
        // Here null is not the same as nothing: it lifts the default limit.
        time_limit_s: match fields.raw("time_limit_s") {
            None => default.time_limit_s,
            Some(_) => fields
                .optional("time_limit_s")
                .and_then(|limit| limit.number()),
        },
        node_limit: fields
            .optional("node_limit")
            .and_then(|limit| limit.integer()),
        relative_gap: number("relative_gap", default.relative_gap),
        alternatives: fields
            .optional("alternatives")
            .and_then(|count| count.integer())
            .map_or(default.alternatives, |count| {
                usize::try_from(count).unwrap_or(usize::MAX)
            }),
        torque_authority: number("torque_authority", default.torque_authority),
        momentum_authority: number("momentum_authority", default.momentum_authority),
        seed: fields
            .optional("seed")
            .and_then(|seed| seed.integer())
            .unwrap_or(default.seed),
    }
}

#[cfg(test)]
mod tests;
