//! Shortest paths in place of least trees, for few targets.

use super::Charges;
use super::choice::Part;
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;
use crate::tour::order::remainder::{LegCosts, SubsetTable};

/// The bound of [`Charges`] with the edges chosen as a path: tighter than a tree, and a table of
/// `n 2^n` entries. Of the shares as they were when it was filled.
#[derive(Debug)]
pub struct ChargedSubsets {
    charges: Charges,
    /// Missing when it was not finished: then trees have to do.
    subsets: Option<SubsetTable>,
}

impl ChargedSubsets {
    /// Fills the table for the orders that some rules admit, unless stopped: `n^2 2^n` steps.
    #[must_use]
    pub fn new(charges: Charges, rules: &OrderRules, stop: &StopSignal) -> Self {
        Self {
            subsets: SubsetTable::new(&charges, rules, stop),
            charges,
        }
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        let charges = &self.charges;
        let subsets = self.subsets.as_ref();
        let path = subsets.and_then(|table| table.entered(remaining, |to| charges.first(from, to)));
        path.map_or_else(
            || charges.bound(from, remaining),
            |path| (charges.passing(&Part::new(from, charges.end(), remaining)) + path).max(0.0),
        )
    }
}
