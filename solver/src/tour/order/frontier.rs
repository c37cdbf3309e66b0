//! The open nodes of the search tree, ordered by their bounds, in bounded memory.

use super::node::SearchNode;
use std::collections::BTreeSet;

/// Default memory for open nodes, bytes: enough for some 300 000 nodes of twenty targets.
pub(super) const DEFAULT_BYTES: usize = 64 << 20;

/// Smallest capacity, whatever the memory: enough for the children of one node and a few others.
const MIN_NODES: usize = 16;

/// The open nodes.
#[derive(Debug)]
pub(super) struct Frontier {
    nodes: BTreeSet<SearchNode>,
    capacity: usize,
}

impl Frontier {
    /// An empty frontier for nodes with so many targets, within so many bytes.
    pub(super) fn new(targets: usize, bytes: usize) -> Self {
        let node_bytes = size_of::<SearchNode>() + targets * size_of::<usize>();
        Self {
            nodes: BTreeSet::new(),
            capacity: (bytes / node_bytes).max(MIN_NODES),
        }
    }

    /// Adds a node.
    pub(super) fn insert(&mut self, node: SearchNode) {
        self.nodes.insert(node);
    }

    /// Takes the node of the smallest bound.
    pub(super) fn pop(&mut self) -> Option<SearchNode> {
        self.nodes.pop_first()
    }

    /// Takes the node of the largest bound if there are more nodes than the capacity.
    pub(super) fn pop_excess(&mut self) -> Option<SearchNode> {
        if self.nodes.len() > self.capacity {
            self.nodes.pop_last()
        } else {
            None
        }
    }

    /// Takes out all nodes for which this holds.
    pub(super) fn take_if(
        &mut self,
        mut hopeless: impl FnMut(&SearchNode) -> bool,
    ) -> Vec<SearchNode> {
        self.nodes.extract_if(.., |node| hopeless(node)).collect()
    }

    /// The smallest bound, s; infinite when nothing is open.
    pub(super) fn bound(&self) -> f64 {
        self.nodes.first().map_or(f64::INFINITY, |node| node.bound)
    }

    /// Whether nothing is open.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(bound: f64, prefix: &[usize]) -> SearchNode {
        SearchNode {
            prefix: prefix.to_vec(),
            ..SearchNode::root(bound)
        }
    }

    #[test]
    fn nodes_come_out_by_bound_then_prefix() {
        let mut frontier = Frontier::new(3, DEFAULT_BYTES);
        for open in [node(2.0, &[0]), node(1.0, &[2]), node(1.0, &[1, 2])] {
            frontier.insert(open);
        }
        let order: Vec<_> = std::iter::from_fn(|| frontier.pop())
            .map(|n| n.prefix)
            .collect();
        assert_eq!(order, [vec![1, 2], vec![2], vec![0]]);
    }

    #[test]
    fn the_nodes_of_largest_bound_are_the_excess() {
        let mut frontier = Frontier::new(100, 0);
        for target in 0..MIN_NODES + 2 {
            frontier.insert(node(target as f64, &[target]));
        }
        let dropped: Vec<_> = std::iter::from_fn(|| frontier.pop_excess()).collect();
        assert_eq!(dropped.len(), 2);
        assert!(dropped.iter().all(|node| node.prefix[0] >= MIN_NODES));
        assert_eq!(frontier.bound().total_cmp(&0.0), std::cmp::Ordering::Equal);
    }
}
