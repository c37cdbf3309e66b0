//! The rows of an answer about leg times.

use super::leg_query::Pair;
use super::number::Number;
use serde::{Deserialize, Serialize};
use slewplan_solver::tour::planner::{self, LegTime};
use std::fmt;
use utoipa::ToSchema;

/// The answer to a query.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegAnswers)]
pub(crate) struct LegAnswersDocument {
    /// `rest_to_rest`, `lower_bound` or `certified`.
    pub(crate) kind: &'static str,
    /// SHA-256 of the canonical text of the spacecraft.
    pub(crate) spacecraft_key: String,
    /// One entry for every leg, in the order of the query.
    pub(crate) legs: Vec<LegAnswerDocument>,
}

/// The answer for one leg.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegAnswer)]
pub(crate) struct LegAnswerDocument {
    /// Position in `attitudes` of the begin, or position of the pair.
    #[schema(value_type = usize)]
    pub(crate) from: LegEnd,
    /// Position in `attitudes` of the end, or position of the pair.
    #[schema(value_type = usize)]
    pub(crate) to: LegEnd,
    /// Minimum time, s; `null` when it is not known, and for `certified`, which solves nothing.
    pub(crate) duration_s: Option<Number>,
    /// No slew between these attitudes under the conditions of the kind takes less, s, proved, for
    /// `certified` those of `rest_to_rest`; `null` where nothing is proved or nothing is known.
    pub(crate) certified_lower_bound_s: Option<Number>,
    /// How the solve ended (for `certified`: `proved`, or `none` without a bound); `no_clear_path` where
    /// no way around the cones was found, `infeasible` where it is proved that there is none; `null`
    /// when it was not tried.
    pub(crate) status: Option<String>,
    /// Where the time comes from.
    pub(crate) source: Source,
    /// Key of the cached leg; `null` when it is not stored.
    pub(crate) key: Option<String>,
}

/// Where a leg begins or ends.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum LegEnd {
    /// Position in a query.
    Position(usize),
    /// Identifier of a place of a scenario.
    Name(String),
}

impl fmt::Display for LegEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position(position) => position.fmt(f),
            Self::Name(name) => name.fmt(f),
        }
    }
}

/// Where a leg time comes from.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema, strum::IntoStaticStr,
)]
#[schema(as = LegSource)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub(crate) enum Source {
    /// It was known.
    Cached,
    /// It was solved for this query.
    Computed,
    /// It is not known.
    Missing,
}

impl From<&planner::LegRow> for LegAnswerDocument {
    fn from(row: &planner::LegRow) -> Self {
        Self {
            from: LegEnd::Name(row.from.clone()),
            to: LegEnd::Name(row.to.clone()),
            duration_s: row.duration_s.map(Number),
            certified_lower_bound_s: row.certified_lower_bound_s.map(Number),
            status: Some(row.status.clone()),
            source: source(row.duration_s, &row.status, row.from_store),
            key: None,
        }
    }
}

fn source(duration_s: Option<f64>, status: &str, from_store: bool) -> Source {
    match (duration_s, status) {
        (Some(_), _) if from_store => Source::Cached,
        (Some(_), _) | (None, "proved" | "none") => Source::Computed,
        (None, _) => Source::Missing,
    }
}

/// What a table keeps of a leg. Its ends follow from its position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LegRow {
    duration_s: Option<f64>,
    certified_lower_bound_s: Option<f64>,
    status: Option<String>,
    pub(crate) source: Source,
    key: Option<String>,
}

impl LegRow {
    /// The row of a leg of which nothing is known.
    pub(crate) const MISSING: Self = Self {
        duration_s: None,
        certified_lower_bound_s: None,
        status: None,
        source: Source::Missing,
        key: None,
    };

    /// The answer for the leg between the ends of a pair.
    pub(crate) fn between(self, pair: Pair) -> LegAnswerDocument {
        LegAnswerDocument {
            from: LegEnd::Position(pair.from),
            to: LegEnd::Position(pair.to),
            duration_s: self.duration_s.map(Number),
            certified_lower_bound_s: self.certified_lower_bound_s.map(Number),
            status: self.status,
            source: self.source,
            key: self.key,
        }
    }
}

impl From<LegTime> for LegRow {
    fn from(time: LegTime) -> Self {
        Self {
            duration_s: time.duration_s,
            certified_lower_bound_s: time.certified_lower_bound_s,
            status: Some(time.status.to_owned()),
            source: source(time.duration_s, time.status, time.from_store),
            key: time.key,
        }
    }
}
