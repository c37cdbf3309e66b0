//! Reading a table of leg times that this program, or anyone, wrote.
//!
//! Here only its shape is tested: whether parts fit together is for [`crate::documents::shards`] to say,
//! whether motions can be flown for [`crate::jobs::leg_import`].

use super::super::document::Node;
use super::super::reader::{Cursor, Sink};
use super::{KeyedLeg, LegTable};
use slewplan_solver::model::input::{
    InputForm, InputPlace, NamedSchema, Schema, Unread, input_object, optional, required,
    required_elsewhere,
};
use slewplan_solver::model::motion::Motion;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{LegRow, Shard};

const KEY_DIGITS: usize = 64;
const KEY_PATTERN: &str = "^[0-9a-f]{64}$";

input_object! {
    /// A table of leg times with the motions behind it, as `slewplan legs --trajectories` writes it.
    pub(crate) struct LegFileSpec as "LegFile" {
        /// Version that solved the legs: that of this service.
        version: String = required(),
        /// Kind of all its legs.
        kind: LegKind as FlownKind = required(),
        /// SHA-256 of the scenario: of its JSON with sorted members, all numbers as floating point (below
        /// 2^53), without spaces.
        scenario_key: String as KeyText = required().pattern(KEY_PATTERN),
        /// Which part of the table it is.
        shard: Shard as CountedShard = required(),
        /// Whether everything was solved.
        complete: bool = required(),
        /// With its spacecraft written out.
        scenario: () as Unread<ScenarioSpec> = required_elsewhere(()),
        /// The times; not looked at in an import, since they follow from the trajectories.
        legs: Vec<LegRowSpec> = required(),
        /// The motions; without them there is nothing to import.
        trajectories: Option<Vec<LegMotionSpec>> as Motions = required_elsewhere(None),
    }
}

input_object! {
    /// Which part of the table, counted from 1.
    struct ShardSpec as "Shard" {
        /// The part.
        index: u64 = required().at_least(1.0),
        /// Number of parts.
        of: u64 = required().at_least(1.0),
    }
}

input_object! {
    /// The time of a leg.
    struct LegRowSpec as "LegRow" {
        /// `start` or the identifier of a target.
        from: String = required(),
        /// The identifier of a target, or `end`.
        to: String = required(),
        /// How the solve ended.
        status: String = required(),
        /// Minimum time; `null` where it is not known.
        duration_s: Option<f64> as Option<Seconds> = optional().at_least(0.0),
        /// No slew takes less, proved; `null` where nothing is.
        certified_lower_bound_s: Option<f64> as Option<Seconds> = optional().at_least(0.0),
        /// Wall-clock time of the solve.
        solve_time_s: f64 as Seconds = required().at_least(0.0),
        /// The conditions at the two ends.
        kind: LegKind = required(),
    }
}

input_object! {
    /// The motion of a leg, in the frame in which it begins at the identity attitude.
    struct LegMotionSpec as "LegMotion" {
        /// The key under which it is cached: SHA-256 of the canonical text of the leg's problem.
        key: String as KeyText = required().pattern(KEY_PATTERN),
        /// Wall-clock time of the solve, s.
        solve_time_s: f64 as Seconds = required().at_least(0.0),
        /// Time between nodes, s.
        lengths_s: Vec<f64> = required(),
        /// Attitude at every node, unit quaternions.
        attitudes_xyzw: Vec<[f64; 4]> = required(),
        /// Momentum of every enabled wheel about its axis at every node, N m s.
        wheel_momenta_nms: Vec<Vec<f64>> = required(),
    }
}

/// Reads a table.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read(node: &Node) -> Result<LegTable, Vec<Problem>> {
    let sink = Sink::default();
    let spec = LegFileSpec::read(&Cursor::root(node, &sink));
    let table = spec.map(|spec| table(spec, scenario_of(node)));
    if let Some(problem) = table.as_ref().and_then(foreign_scenario) {
        sink.push(problem);
    }
    let problems = sink.into_problems();
    table.filter(|_| problems.is_empty()).ok_or(problems)
}

/// The scenario as it stands in a table; `null` is none.
fn scenario_of(node: &Node) -> Option<Node> {
    let scenario = node.member("scenario");
    scenario.filter(|node| **node != Node::Null).cloned()
}

fn table(spec: LegFileSpec, scenario: Option<Node>) -> LegTable {
    let motions = spec.trajectories;
    LegTable {
        version: spec.version,
        kind: spec.kind,
        scenario_key: spec.scenario_key,
        shard: spec.shard,
        complete: spec.complete,
        scenario,
        rows: spec.legs.into_iter().map(LegRow::from).collect(),
        motions: motions.map(|list| list.into_iter().map(KeyedLeg::from).collect()),
    }
}

/// The problem of a table whose scenario is not that of its key.
fn foreign_scenario(table: &LegTable) -> Option<Problem> {
    let scenario = table.scenario.as_ref()?;
    let is_other = super::scenario_key(scenario) != table.scenario_key;
    is_other.then(|| {
        let message = "this is not the key of the scenario that stands beside it";
        let hint = "take the file as slewplan legs wrote it";
        Problem::new("/scenario_key", Code::ConflictingFields, message, hint)
    })
}

impl From<LegRowSpec> for LegRow {
    fn from(row: LegRowSpec) -> Self {
        Self {
            from: row.from,
            to: row.to,
            kind: row.kind,
            duration_s: row.duration_s,
            certified_lower_bound_s: row.certified_lower_bound_s,
            solve_time_s: row.solve_time_s,
            status: row.status,
            // A file does not say.
            from_store: false,
        }
    }
}

impl From<LegMotionSpec> for KeyedLeg {
    fn from(motion: LegMotionSpec) -> Self {
        Self {
            key: motion.key,
            motion: Motion {
                attitudes_xyzw: motion.attitudes_xyzw,
                wheel_momenta_nms: motion.wheel_momenta_nms,
                lengths_s: motion.lengths_s,
            },
            solve_time_s: motion.solve_time_s,
        }
    }
}

/// Kinds of legs with motions, as far as descriptions go: a table of the others is read too.
struct FlownKind;

impl InputForm for FlownKind {
    type Value = LegKind;

    fn read<P: InputPlace>(place: &P) -> Option<LegKind> {
        LegKind::read(place)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "FlownKind",
            doc: "Kinds of legs that have a motion.",
            schema: || {
                let Schema::Named(kind) = LegKind::schema() else {
                    unreachable!("it has a name")
                };
                let Schema::Choice(mut kinds) = (kind.schema)() else {
                    unreachable!("it is a choice")
                };
                kinds.retain(|(name, _)| *name != <&str>::from(LegKind::Certified));
                Schema::Choice(kinds)
            },
        })
    }
}

/// The key of a scenario or leg.
struct KeyText;

impl InputForm for KeyText {
    type Value = String;

    fn read<P: InputPlace>(place: &P) -> Option<String> {
        let text = place.text()?;
        let is_digit = |byte: u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
        if text.len() != KEY_DIGITS || !text.bytes().all(is_digit) {
            let message = format!("a key has {KEY_DIGITS} hexadecimal digits in lower case");
            let hint = "copy it from a file of slewplan legs";
            place.report(Code::OutOfRange, message, hint);
            return None;
        }
        Some(text.to_owned())
    }

    fn schema() -> Schema {
        Schema::Text
    }
}

/// A part of a table, which counts from 1 in documents.
struct CountedShard;

impl InputForm for CountedShard {
    type Value = Shard;

    fn read<P: InputPlace>(place: &P) -> Option<Shard> {
        let ShardSpec { index, of } = ShardSpec::read(place)?;
        if !(1..=of).contains(&index) {
            let message = format!("there is no part {index} of {of}");
            place.report(Code::OutOfRange, message, "parts count from 1");
            return None;
        }
        Some(Shard {
            index: usize::try_from(index - 1).ok()?,
            of: usize::try_from(of).ok()?,
        })
    }

    fn schema() -> Schema {
        ShardSpec::schema()
    }
}

/// A list of motions, or `null` in a table without them; an import wants it.
struct Motions;

impl InputForm for Motions {
    type Value = Option<Vec<LegMotionSpec>>;

    fn read<P: InputPlace>(place: &P) -> Option<Self::Value> {
        Option::<Vec<LegMotionSpec>>::read(place)
    }

    fn schema() -> Schema {
        Vec::<LegMotionSpec>::schema()
    }
}

/// A time, s.
struct Seconds;

impl InputForm for Seconds {
    type Value = f64;

    fn read<P: InputPlace>(place: &P) -> Option<f64> {
        let time = place.number()?;
        if time < 0.0 {
            let message = format!("a time of {time} s is negative");
            place.report(Code::OutOfRange, message, "times are at least 0");
            return None;
        }
        Some(time)
    }

    fn schema() -> Schema {
        Schema::Number
    }
}
