//! How much work a plan was.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::model::plan::{Milestone, Statistics};
use utoipa::ToSchema;

/// How much work it was, and how it went. Not part of the answer: two runs may differ here only.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Statistics)]
pub(super) struct StatisticsDocument {
    wall_time_s: Number,
    /// Nodes of the search tree that were evaluated.
    nodes_explored: u64,
    /// Nonlinear programs solved, all starts counted.
    nlp_solves: u64,
    nlp_solves_by_kind: NlpSolvesDocument,
    /// Beginnings of orders evaluated for their bound.
    prefixes_evaluated: u64,
    /// Those that did not converge, and so had the bound of the one before only.
    prefixes_unresolved: u64,
    /// Whole orders flown.
    tours_evaluated: u64,
    /// Those that did not converge.
    tours_unresolved: u64,
    /// Nodes pruned by the table of legs alone, before any program of their own.
    pruned_by_table: u64,
    /// Nodes pruned by their own evaluation.
    pruned_by_prefix: u64,
    /// Open nodes pruned when a better order was found.
    pruned_by_incumbent: u64,
    /// Nodes dropped for want of memory; the lower bound allows for them.
    dropped_for_memory: u64,
    /// Every plan that was better than those before, and last this one.
    history: Vec<MilestoneDocument>,
    legs_solved: u64,
    legs_from_cache: u64,
    threads: usize,
    version: &'static str,
}

/// Nonlinear programs by what they were solved for.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = NlpSolves)]
struct NlpSolvesDocument {
    /// Single slews.
    legs: u64,
    /// Several slews at once, coupled where rates are free: beginnings of orders and whole ones.
    segments: u64,
}

/// A moment at which a better plan was known.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Milestone)]
#[expect(clippy::struct_field_names, reason = "the postfix is the unit")]
struct MilestoneDocument {
    /// Wall-clock time since the beginning.
    time_s: Number,
    /// Duration of the best plan then.
    total_time_s: Number,
    /// Its lower bound then.
    lower_bound_s: Number,
}

impl From<&Milestone> for MilestoneDocument {
    fn from(then: &Milestone) -> Self {
        Self {
            time_s: Number(then.time_s),
            total_time_s: Number(then.total_time_s),
            lower_bound_s: Number(then.lower_bound_s),
        }
    }
}

impl From<&Statistics> for StatisticsDocument {
    fn from(work: &Statistics) -> Self {
        Self {
            wall_time_s: Number(work.wall_time_s),
            nodes_explored: work.nodes_explored,
            nlp_solves: work.nlp_solves,
            nlp_solves_by_kind: NlpSolvesDocument {
                legs: work.nlp_solves_by_kind.legs,
                segments: work.nlp_solves_by_kind.segments,
            },
            prefixes_evaluated: work.search.prefixes,
            prefixes_unresolved: work.search.prefixes_unresolved,
            tours_evaluated: work.search.tours,
            tours_unresolved: work.search.tours_unresolved,
            pruned_by_table: work.search.pruned_by_table,
            pruned_by_prefix: work.search.pruned_by_prefix,
            pruned_by_incumbent: work.search.pruned_by_incumbent,
            dropped_for_memory: work.search.dropped_for_memory,
            history: work.history.iter().map(MilestoneDocument::from).collect(),
            legs_solved: work.legs_solved,
            legs_from_cache: work.legs_from_cache,
            threads: work.threads,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}
