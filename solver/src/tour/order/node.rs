//! A node of the search tree: all orders that begin with a prefix.

use std::cmp::Ordering;

/// A prefix of orders with the bounds on its completions.
#[derive(Debug, Clone)]
pub(super) struct SearchNode {
    /// The fixed first targets; all of them in a leaf.
    pub(super) prefix: Vec<usize>,
    /// Lower bound of the time until the last fixed target is left, s.
    pub(super) head: f64,
    /// Lower bound of every completion, s.
    pub(super) bound: f64,
    /// Whether the node's prefix has been evaluated, resolved or not.
    pub(super) evaluated: bool,
}

impl SearchNode {
    /// The node of all orders.
    pub(super) fn root(bound: f64) -> Self {
        Self {
            prefix: Vec::new(),
            head: 0.0,
            bound,
            // There is no prefix to evaluate.
            evaluated: true,
        }
    }

    /// Raises the head to a bound of the time until the last fixed target is left, s, and the bound
    /// with it; `rest` bounds the time after that, s.
    pub(super) fn raise_head(&mut self, head: f64, rest: f64) {
        self.head = self.head.max(head);
        self.bound = self.bound.max(self.head + rest);
    }

    /// The targets that are not fixed, in increasing order.
    pub(super) fn remaining(&self, targets: usize) -> Vec<usize> {
        let mut fixed = vec![false; targets];
        for &target in &self.prefix {
            fixed[target] = true;
        }
        (0..targets).filter(|&target| !fixed[target]).collect()
    }
}

/// Smallest bound first, then lexicographic by the prefix.
impl Ord for SearchNode {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound
            .total_cmp(&other.bound)
            .then_with(|| self.prefix.cmp(&other.prefix))
    }
}

impl PartialOrd for SearchNode {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for SearchNode {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for SearchNode {}
