//! Triple bounds with shortest paths in place of spanning trees, for few targets.

use super::TripleBounds;
use super::choice::Part;
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{LegCosts, SubsetTable};

/// The bound of [`TripleBounds`] with the edges chosen as a path: tighter than a tree, with a table
/// of `n 2^n` entries. It holds for the multipliers with which the table was filled.
#[derive(Debug)]
pub struct TripleBoundSubsets {
    triple_bounds: TripleBounds,
    /// `None` when filling it was interrupted; then trees are used.
    subsets: Option<SubsetTable>,
}

impl TripleBoundSubsets {
    /// Fills the table for the orders that some rules admit, unless stopped: `n^2 2^n` steps.
    #[must_use]
    pub fn new(triple_bounds: TripleBounds, rules: &OrderRules, stop: &StopSignal) -> Self {
        Self {
            subsets: SubsetTable::new(&triple_bounds, rules, stop),
            triple_bounds,
        }
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        let triple_bounds = &self.triple_bounds;
        let subsets = self.subsets.as_ref();
        let path =
            subsets.and_then(|table| table.entered(remaining, |to| triple_bounds.first(from, to)));
        path.map_or_else(
            || triple_bounds.bound(from, remaining),
            |path| {
                (triple_bounds.passing(&Part::new(from, triple_bounds.end(), remaining)) + path)
                    .max(0.0)
            },
        )
    }
}
