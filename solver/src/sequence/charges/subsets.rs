//! Shortest paths in place of least trees, for few targets.

use super::Charges;
use super::choice::Part;
use crate::sequence::OrderRules;
use crate::sequence::remainder::{LegCosts, SubsetTable};

/// The bound of [`Charges`] with the edges chosen as a path: tighter than a tree, and a table of
/// `n 2^n` entries. Of the shares as they were when it was filled.
#[derive(Debug)]
pub struct ChargedSubsets {
    charges: Charges,
    subsets: SubsetTable,
}

impl ChargedSubsets {
    /// Fills the table for the orders that some rules admit: `n^2 2^n` steps.
    #[must_use]
    pub fn new(charges: Charges, rules: &OrderRules) -> Self {
        Self {
            subsets: SubsetTable::new(&charges, rules),
            charges,
        }
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    #[must_use]
    pub fn bound(&self, from: usize, remaining: &[usize]) -> f64 {
        let charges = &self.charges;
        let path = self
            .subsets
            .entered(remaining, |to| charges.first(from, to));
        path.map_or_else(
            || charges.bound(from, remaining),
            |path| (charges.passing(&Part::new(from, charges.end(), remaining)) + path).max(0.0),
        )
    }
}
