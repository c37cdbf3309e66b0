//! The kinds of documents that can be drawn.

use super::{WrittenComparison, WrittenEnvelopes, WrittenFlight, WrittenPlan, WrittenSlews};
use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};

/// A document that can be drawn.
#[derive(Debug)]
pub(crate) enum DrawableDocument {
    /// A plan.
    Plan(WrittenPlan),
    /// The answer to a slew, with or without a sweep.
    Slews(WrittenSlews),
    /// A comparison of wheels and gyroscopes.
    Comparison(WrittenComparison),
    /// A study of envelopes.
    Envelopes(WrittenEnvelopes),
    /// A flight in closed loop.
    Flight(Box<WrittenFlight>),
}

/// Members that identify a kind.
#[derive(Deserialize)]
struct Members {
    slews: Option<IgnoredAny>,
    advantage: Option<IgnoredAny>,
    turns: Option<IgnoredAny>,
    flight: Option<IgnoredAny>,
}

impl DrawableDocument {
    /// Reads a document; its members identify its kind.
    ///
    /// # Errors
    ///
    /// A message, when it cannot be drawn.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let members: Members = of(bytes, "a document")?;
        if members.slews.is_some() {
            return Ok(Self::Slews(of(bytes, "an answer to a slew")?));
        }
        if members.advantage.is_some() {
            return Ok(Self::Comparison(of(bytes, "a comparison")?));
        }
        if members.turns.is_some() {
            return WrittenEnvelopes::read(bytes).map(Self::Envelopes);
        }
        if members.flight.is_some() {
            return Ok(Self::Flight(of(bytes, "a flight")?));
        }
        WrittenPlan::read(bytes).map(Self::Plan)
    }

    /// Whether it is the answer to a slew with a sweep.
    pub(crate) fn is_swept(&self) -> bool {
        matches!(self, Self::Slews(slews) if slews.sweep.is_some())
    }
}

fn of<T: DeserializeOwned>(bytes: &[u8], kind: &str) -> Result<T, String> {
    serde_json::from_slice(bytes).map_err(|error| format!("not {kind} that can be drawn: {error}"))
}
