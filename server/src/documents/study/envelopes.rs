//! What the wheels can do together: the request of a study and its answer.

mod answer;

pub(crate) use answer::EnvelopeAnswerDocument;

use crate::documents::document::{self, Node};
use crate::documents::reader::{Cursor, Sink};
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::Problem;
use slewplan_studies::envelope_study::{EnvelopeStudy, EnvelopeStudySpec};

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
    let spec = EnvelopeStudySpec::read(&Cursor::root(node, &sink));
    let problems = sink.into_problems();
    let Some(spec) = spec.filter(|_| problems.is_empty()) else {
        return Err(problems);
    };
    let (study, warnings) = EnvelopeStudy::try_new(&spec)?;
    Ok(EnvelopeRequest { study, warnings })
}
