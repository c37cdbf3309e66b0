//! Reading a slew: a slew, perhaps along a sweep.
//!
//! First its shape, and only of a document of the right shape the meaning, each with all of its
//! problems at once.

mod answer;

pub(crate) use answer::SlewAnswerDocument;

use super::document::{self, Node};
use super::reader::{Cursor, Fields, Sink};
use super::{drives, scenario, spacecraft};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::spec::{AttitudeEquivalence, SpacecraftSpec};
use slewplan_solver::slew::{
    EnergyMeasure, FinalWheels, Objective, SampleHold, Slew, SlewSpec, Sweep, TorqueCommand,
    WheelAllocation,
};

/// Most points of a sweep.
pub(crate) const MAX_POINTS: usize = 200;
/// Wall-clock limit without another one, s.
const DEFAULT_LIMIT_S: f64 = 60.0;
/// Intervals of a command without their number.
const DEFAULT_INTERVALS: usize = 24;

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

/// What a document says beside the slew.
struct Read {
    name: Option<String>,
    spec: SlewSpec,
    sweep: Option<Sweep>,
    evidence: bool,
    time_limit_s: Option<f64>,
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
    let sink = Sink::default();
    let read = decode(&Cursor::root(node, &sink));
    let problems = sink.into_problems();
    let Some(read) = read.filter(|_| problems.is_empty()) else {
        return Err(problems);
    };
    let valid = Slew::try_new(&read.spec)?;
    Ok(SlewRequest {
        name: read.name,
        slew: valid.slew,
        warnings: valid.warnings,
        sweep: read.sweep,
        evidence: read.evidence,
        time_limit_s: read.time_limit_s,
    })
}

fn decode(cursor: &Cursor<'_>) -> Option<Read> {
    let fields = cursor.object(&[
        "name",
        "spacecraft",
        "drives",
        "start",
        "end",
        "final_wheels",
        "objective",
        "command",
        "allocation",
        "sweep",
        "evidence",
        "options",
    ])?;
    let name = fields.optional("name");
    let name = name.and_then(|name| name.text()).map(str::to_owned);
    let sweep = fields.optional("sweep");
    let sweep = sweep.map(|cursor| read_sweep(&cursor));
    let swept = sweep.as_ref().and_then(Option::as_ref);
    let mut spec = SlewSpec {
        spacecraft: fields
            .required("spacecraft")
            .map_or_else(SpacecraftSpec::default, |it| spacecraft::read(&it)),
        drives: fields
            .optional("drives")
            .map(|it| drives::read(&it))
            .unwrap_or_default(),
        start: fields
            .required("start")
            .map(|it| scenario::state(&it))
            .unwrap_or_default(),
        end: fields
            .required("end")
            .map(|it| scenario::state(&it))
            .unwrap_or_default(),
        final_wheels: final_wheels(&fields),
        objective: fields
            .optional("objective")
            .and_then(|it| objective(&it, swept))
            .unwrap_or(Objective::MinimumTime),
        command: fields
            .optional("command")
            .and_then(|it| command(&it))
            .unwrap_or(TorqueCommand::Free {
                intervals: DEFAULT_INTERVALS,
            }),
        allocation: allocation(&fields),
        ..SlewSpec::default()
    };
    let options = fields.optional("options");
    let time_limit_s = options.map_or(Some(DEFAULT_LIMIT_S), |it| read_options(&it, &mut spec));
    let asked = fields.optional("evidence");
    let evidence = asked.as_ref().and_then(Cursor::boolean).unwrap_or(false);
    if let Some(asked) = asked.filter(|_| evidence && sweep.is_some()) {
        asked.report(
            Code::ConflictingFields,
            "evidence is given for a single slew only",
            "ask for the evidence of the slew that is of interest, without the sweep",
        );
    }
    Some(Read {
        name,
        spec,
        sweep: sweep.flatten(),
        evidence,
        time_limit_s,
    })
}

fn final_wheels(fields: &Fields<'_>) -> FinalWheels {
    let choices = [
        ("free", FinalWheels::Free),
        ("given", FinalWheels::Given),
        ("null_space_of_start", FinalWheels::NullSpaceOfStart),
    ];
    let asked = fields.optional("final_wheels");
    asked.and_then(|it| it.choice(&choices)).unwrap_or_default()
}

fn allocation(fields: &Fields<'_>) -> WheelAllocation {
    let choices = WheelAllocation::ALL.map(|allocation| (allocation.into(), allocation));
    let asked = fields.optional("allocation");
    asked.and_then(|it| it.choice(&choices)).unwrap_or_default()
}

/// Reads the options into a description; returns the time limit.
fn read_options(cursor: &Cursor<'_>, spec: &mut SlewSpec) -> Option<f64> {
    let known = &[
        "attitude_equivalence",
        "torque_authority",
        "momentum_authority",
        "time_limit_s",
    ];
    let fields = cursor.object(known)?;
    let meanings = [
        ("rotation", AttitudeEquivalence::Rotation),
        ("quaternion", AttitudeEquivalence::Quaternion),
    ];
    let meaning = fields.optional("attitude_equivalence");
    spec.attitude_equivalence = meaning
        .and_then(|it| it.choice(&meanings))
        .unwrap_or_default();
    let share = |name| {
        fields
            .optional(name)
            .and_then(|it| it.number())
            .unwrap_or(1.0)
    };
    spec.torque_authority = share("torque_authority");
    spec.momentum_authority = share("momentum_authority");
    // Here null is not the same as nothing: it lifts the limit.
    if fields.raw("time_limit_s").is_none() {
        return Some(DEFAULT_LIMIT_S);
    }
    let limit = fields.optional("time_limit_s")?;
    let seconds = limit.number()?;
    if !(seconds > 0.0 && seconds <= 1e9) {
        limit.report(
            Code::OutOfRange,
            format!("the time limit is {seconds} s"),
            "give a number of seconds above 0 and at most 1e9, or null for none",
        );
    }
    Some(seconds)
}

/// Reads an objective; along a sweep its own value may be left out.
fn objective(cursor: &Cursor<'_>, sweep: Option<&Sweep>) -> Option<Objective> {
    const KINDS: [(&str, &[&str]); 4] = [
        ("minimum_time", &["kind"]),
        ("time_and_effort", &["kind", "weight"]),
        ("energy", &["kind", "duration_s", "measure"]),
        ("minimum_time_at_energy", &["kind", "energy_j", "measure"]),
    ];
    let numbered: Vec<_> = KINDS
        .iter()
        .enumerate()
        .map(|(i, (name, _))| (*name, i))
        .collect();
    let kind = cursor.kind(&numbered)?;
    let fields = cursor.object(KINDS[kind].1)?;
    let value = |name, swept: Option<f64>| match swept {
        Some(first) if fields.raw(name).is_none() => Some(first),
        _ => fields.required(name)?.number(),
    };
    Some(match kind {
        0 => Objective::MinimumTime,
        1 => Objective::TimeAndEffort {
            weight: value("weight", sweep.and_then(first_weight))?,
        },
        2 => Objective::Energy {
            measure: measure(&fields),
            duration_s: value("duration_s", sweep.and_then(first_duration))?,
        },
        _ => Objective::MinimumTimeAtEnergy {
            measure: measure(&fields),
            energy_j: value("energy_j", sweep.and_then(first_energy))?,
        },
    })
}

fn first_weight(sweep: &Sweep) -> Option<f64> {
    match sweep {
        Sweep::Weights(values) => values.first().copied(),
        _ => None,
    }
}

fn first_duration(sweep: &Sweep) -> Option<f64> {
    match sweep {
        Sweep::Durations(values) => values.first().copied(),
        _ => None,
    }
}

fn first_energy(sweep: &Sweep) -> Option<f64> {
    match sweep {
        Sweep::Energies(values) => values.first().copied(),
        _ => None,
    }
}

fn measure(fields: &Fields<'_>) -> EnergyMeasure {
    let choices = [
        ("bill", EnergyMeasure::Bill),
        ("proxy", EnergyMeasure::Proxy),
    ];
    let asked = fields.optional("measure");
    asked
        .and_then(|it| it.choice(&choices))
        .unwrap_or(EnergyMeasure::Bill)
}

fn command(cursor: &Cursor<'_>) -> Option<TorqueCommand> {
    const KINDS: [(&str, &[&str]); 4] = [
        ("free", &["kind", "intervals"]),
        ("uniform", &["kind", "intervals"]),
        ("smooth", &["kind", "intervals"]),
        ("sampled", &["kind", "period_s", "hold"]),
    ];
    let numbered: Vec<_> = KINDS
        .iter()
        .enumerate()
        .map(|(i, (name, _))| (*name, i))
        .collect();
    let kind = cursor.kind(&numbered)?;
    let fields = cursor.object(KINDS[kind].1)?;
    if kind == 3 {
        let holds = [
            ("constant", SampleHold::Constant),
            ("linear", SampleHold::Linear),
        ];
        let hold = fields.optional("hold").and_then(|it| it.choice(&holds));
        return Some(TorqueCommand::Sampled {
            period_s: fields.required("period_s")?.number()?,
            hold: hold.unwrap_or(SampleHold::Constant),
        });
    }
    let asked = fields.optional("intervals");
    let intervals = asked.map_or(Some(DEFAULT_INTERVALS), |it| {
        it.integer()
            .map(|count| usize::try_from(count).unwrap_or(usize::MAX))
    })?;
    Some(match kind {
        0 => TorqueCommand::Free { intervals },
        1 => TorqueCommand::Uniform { intervals },
        _ => TorqueCommand::Smooth { intervals },
    })
}

/// Reads the values of a sweep: one list, and not too long a one.
fn read_sweep(cursor: &Cursor<'_>) -> Option<Sweep> {
    let fields = cursor.object(&["durations_s", "weights", "energies_j"])?;
    let list = |name| Some(fields.optional(name)?.any_numbers());
    let lists = [list("durations_s"), list("weights"), list("energies_j")];
    let given = lists.iter().flatten().count();
    if given != 1 {
        cursor.report(
            Code::ConflictingFields,
            format!("{given} lists are given"),
            "give exactly one of durations_s, weights and energies_j",
        );
        return None;
    }
    let [durations, weights, energies] = lists.map(Option::flatten);
    let sweep = durations
        .map(Sweep::Durations)
        .or_else(|| weights.map(Sweep::Weights))
        .or_else(|| energies.map(Sweep::Energies))?;
    let (Sweep::Durations(values) | Sweep::Weights(values) | Sweep::Energies(values)) = &sweep;
    if values.is_empty() || values.len() > MAX_POINTS {
        cursor.report(
            Code::WrongLength,
            format!("the sweep has {} values", values.len()),
            format!("give 1 to {MAX_POINTS} values"),
        );
        return None;
    }
    Some(sweep)
}

#[cfg(test)]
mod tests;
