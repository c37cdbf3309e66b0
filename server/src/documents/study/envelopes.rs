//! What the wheels can do together: the request of a study and its answer.

mod answer;

pub(crate) use answer::EnvelopeAnswerDocument;

use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Sink};
use crate::documents::{attitude, spacecraft};
use slewplan_solver::model::problem::Problem;
use slewplan_studies::envelope_study::{
    EnvelopeStudy, EnvelopeStudySpec, MAX_DEMANDS, MAX_TURNS, TurnSpec,
};

/// A valid study with what the caller should know about it.
#[derive(Debug)]
pub(crate) struct EnvelopeRequest {
    /// What is asked for.
    pub(crate) study: EnvelopeStudy,
    /// Doubts that do not stand in the way.
    pub(crate) warnings: Vec<Problem>,
}

/// Reads and validates a study.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read(bytes: &[u8]) -> Result<EnvelopeRequest, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node)
}

/// Reads and validates a study that has been parsed: first its shape, and only of a document of the
/// right shape the meaning, each with all of its problems at once.
///
/// # Errors
///
/// Everything that is wrong with it.
pub(crate) fn read_node(node: &Node) -> Result<EnvelopeRequest, Vec<Problem>> {
    let sink = Sink::default();
    let read = decode(&Cursor::root(node, &sink));
    let problems = sink.into_problems();
    let Some(spec) = read.filter(|_| problems.is_empty()) else {
        return Err(problems);
    };
    let (study, warnings) = EnvelopeStudy::try_new(&spec)?;
    Ok(EnvelopeRequest { study, warnings })
}

fn decode(cursor: &Cursor<'_>) -> Option<EnvelopeStudySpec> {
    let known = &[
        "name",
        "spacecraft",
        "turns",
        "demands_nm",
        "time_optimal",
        "options",
    ];
    let fields = cursor.object(known)?;
    // A label, which nothing depends on.
    fields.optional("name").and_then(|name| name.text());
    let [torque_authority, momentum_authority] = authorities(fields.optional("options"));
    Some(EnvelopeStudySpec {
        spacecraft: fields
            .required("spacecraft")
            .map_or_else(spacecraft::substitute, |it| spacecraft::read(&it)),
        torque_authority,
        momentum_authority,
        turns: fields
            .optional("turns")
            .and_then(|turns| turns.each_of_at_most(MAX_TURNS, turn))
            .unwrap_or_default(),
        demands_nm: fields
            .optional("demands_nm")
            .and_then(|demands| demands.each_of_at_most(MAX_DEMANDS, demand))
            .unwrap_or_default(),
        time_optimal: fields
            .optional("time_optimal")
            .and_then(|it| it.boolean())
            .unwrap_or(false),
    })
}

fn authorities(options: Option<Cursor<'_>>) -> [f64; 2] {
    let known = &["torque_authority", "momentum_authority"];
    let fields = options.and_then(|options| options.object(known));
    known.map(|name| {
        let share = fields.as_ref().and_then(|fields| fields.optional(name));
        share.and_then(|it| it.number()).unwrap_or(1.0)
    })
}

/// A torque; that which cannot be read is reported.
fn demand(cursor: &Cursor<'_>) -> [f64; 3] {
    cursor.numbers().unwrap_or_default()
}

fn turn(cursor: &Cursor<'_>) -> TurnSpec {
    let fields = cursor.object(&["from", "to"]);
    let end = |name| {
        let end = fields.as_ref().and_then(|fields| fields.required(name));
        end.map(|end| attitude::read(&end)).unwrap_or_default()
    };
    TurnSpec {
        from: end("from"),
        to: end("to"),
    }
}
