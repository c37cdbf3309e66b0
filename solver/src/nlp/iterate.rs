//! The current point of a solve: primal variables, slacks and multipliers.

use super::chain::{Chain, Link, LinkMultipliers};
use std::ops::Range;

/// Primal and dual variables of a chain.
#[derive(Debug, Clone, Default)]
pub(crate) struct Iterate {
    /// States, `point_len` numbers per node.
    pub(crate) points: Vec<f64>,
    /// Controls, `control_dim` numbers per interval.
    pub(crate) controls: Vec<f64>,
    /// Slacks of all inequalities.
    pub(crate) slack: Vec<f64>,
    /// Multipliers of all inequalities.
    pub(crate) z: Vec<f64>,
    /// Multipliers of the links, `state_dim` per interval.
    pub(crate) lambda: Vec<f64>,
    /// Multipliers of all node equalities.
    pub(crate) nu: Vec<f64>,
}

/// Where the blocks of each node lie in the flat vectors.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    point_len: usize,
    pub(crate) states: usize,
    pub(crate) controls: usize,
    pub(crate) intervals: usize,
    equality_start: Vec<usize>,
    inequality_start: Vec<usize>,
}

impl Iterate {
    /// An iterate with given primal values and neutral multipliers.
    pub(crate) fn cold(points: Vec<f64>, controls: Vec<f64>) -> Self {
        Self {
            points,
            controls,
            ..Self::default()
        }
    }

    /// The link that begins at a node.
    pub(crate) fn link<'a>(&'a self, layout: &Layout, node: usize) -> Link<'a> {
        let next = if node < layout.intervals {
            layout.point(node + 1)
        } else {
            0..0
        };
        Link {
            node,
            point: &self.points[layout.point(node)],
            control: &self.controls[layout.control(node)],
            next: &self.points[next],
        }
    }

    /// The multipliers of the link that begins at a node.
    pub(crate) fn multipliers<'a>(&'a self, layout: &Layout, node: usize) -> LinkMultipliers<'a> {
        LinkMultipliers {
            gap: &self.lambda[layout.link(node)],
            equality: &self.nu[layout.equality(node)],
            inequality: &self.z[layout.inequality(node)],
        }
    }

    /// Raises the smaller of every slack and its multiplier until their product is no less than a
    /// barrier parameter, so that a solution becomes an interior start near it.
    pub(crate) fn recentre(&mut self, barrier: f64) {
        for (slack, z) in self.slack.iter_mut().zip(&mut self.z) {
            if *slack * *z < barrier {
                if *z > *slack {
                    *slack = barrier / *z;
                } else {
                    *z = barrier / *slack;
                }
            }
        }
    }
}

impl Layout {
    /// The layout of a chain's variables.
    pub(crate) fn of<C: Chain>(chain: &C) -> Self {
        let nodes = 0..=chain.intervals();
        Self {
            point_len: chain.point_len(),
            states: chain.state_dim(),
            controls: chain.control_dim(),
            intervals: chain.intervals(),
            equality_start: running_sum(nodes.clone().map(|k| chain.equalities(k))),
            inequality_start: running_sum(nodes.map(|k| chain.inequalities(k))),
        }
    }

    /// Numbers in all points.
    pub(crate) fn all_points(&self) -> usize {
        (self.intervals + 1) * self.point_len
    }

    /// Numbers in the tangent steps of all points.
    pub(crate) fn all_states(&self) -> usize {
        (self.intervals + 1) * self.states
    }

    /// Number of all controls.
    pub(crate) fn all_controls(&self) -> usize {
        self.intervals * self.controls
    }

    /// Number of all link multipliers.
    pub(crate) fn all_links(&self) -> usize {
        self.intervals * self.states
    }

    /// Number of all inequalities.
    pub(crate) fn all_inequalities(&self) -> usize {
        *self.inequality_start.last().unwrap_or(&0)
    }

    /// Number of all equalities.
    pub(crate) fn all_equalities(&self) -> usize {
        *self.equality_start.last().unwrap_or(&0)
    }

    /// The point of a node.
    pub(crate) fn point(&self, node: usize) -> Range<usize> {
        node * self.point_len..(node + 1) * self.point_len
    }

    /// The tangent step of a node.
    pub(crate) fn state(&self, node: usize) -> Range<usize> {
        node * self.states..(node + 1) * self.states
    }

    /// The controls of the interval after a node; empty at the last node.
    pub(crate) fn control(&self, node: usize) -> Range<usize> {
        let end = (node + 1).min(self.intervals) * self.controls;
        node.min(self.intervals) * self.controls..end
    }

    /// The link multipliers of the interval after a node; empty at the last node.
    pub(crate) fn link(&self, node: usize) -> Range<usize> {
        let end = (node + 1).min(self.intervals) * self.states;
        node.min(self.intervals) * self.states..end
    }

    /// The equalities of a node.
    pub(crate) fn equality(&self, node: usize) -> Range<usize> {
        self.equality_start[node]..self.equality_start[node + 1]
    }

    /// The inequalities of a node and its interval.
    pub(crate) fn inequality(&self, node: usize) -> Range<usize> {
        self.inequality_start[node]..self.inequality_start[node + 1]
    }
}

fn running_sum(counts: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut starts = vec![0];
    for count in counts {
        starts.push(starts[starts.len() - 1] + count);
    }
    starts
}
