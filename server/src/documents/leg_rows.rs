//! The rows of an answer about leg times.

use super::leg_query::Pair;
use super::number::Number;
use crate::store::leg_key;
use serde::{Deserialize, Serialize};
use slewplan_solver::tour::planner::LegTime;
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
    pub(crate) from: usize,
    /// Position in `attitudes` of the end, or position of the pair.
    pub(crate) to: usize,
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
            from: pair.from,
            to: pair.to,
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
        let source = match (time.duration_s, time.status) {
            (Some(_), _) if time.from_store => Source::Cached,
            (Some(_), _) | (None, "proved" | "none") => Source::Computed,
            (None, _) => Source::Missing,
        };
        Self {
            duration_s: time.duration_s,
            certified_lower_bound_s: time.certified_lower_bound_s,
            status: Some(time.status.to_owned()),
            source,
            key: time.identity.as_deref().map(leg_key),
        }
    }
}
