//! Reserves kept from limits at nodes, so that the limits hold between nodes too.

use crate::model::dynamics::Dynamics;

/// Clearance, rad, of a motion up to which it runs close to a cone.
const CLOSE: f64 = 0.03;

/// Depths, rad, of a motion inside a cone along an interval.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ConeDepth {
    /// At both ends.
    pub(crate) at_ends: [f64; 2],
    /// At the deepest point between them; `None` where an end is as deep.
    pub(crate) between: Option<f64>,
}

impl ConeDepth {
    /// How far, rad, the motion bends towards the cone between the ends, where it runs close to it.
    fn bend(&self) -> f64 {
        let close = self.between.filter(|between| *between > -CLOSE);
        close.map_or(0.0, |between| {
            between - self.at_ends[0].max(self.at_ends[1])
        })
    }
}

/// Relative reserves, one per node and per share of [`Dynamics::limit_shares`], and angles, rad, one
/// per node and cone.
#[derive(Debug, Clone)]
pub(crate) struct Reserves {
    shares: usize,
    values: Vec<f64>,
    cones: usize,
    angles: Vec<f64>,
}

impl Reserves {
    /// No reserve at any of the nodes around so many intervals.
    pub(crate) fn none(dynamics: &Dynamics, intervals: usize) -> Self {
        let shares = dynamics.wheel_count() + 4;
        Self {
            shares,
            values: vec![0.0; shares * (intervals + 1)],
            cones: dynamics.cones.len(),
            angles: vec![0.0; dynamics.cones.len() * (intervals + 1)],
        }
    }

    /// The reserves of a node.
    pub(super) fn at(&self, node: usize) -> &[f64] {
        &self.values[node * self.shares..(node + 1) * self.shares]
    }

    /// The angles, rad, kept from cones at a node.
    pub(super) fn of_cones_at(&self, node: usize) -> &[f64] {
        &self.angles[node * self.cones..(node + 1) * self.cones]
    }

    /// Sets the angles kept from cones to what a motion that runs close to them bends towards them
    /// between nodes, times a factor; `depths` lists the cones of one interval after the other.
    ///
    /// The bend hardly depends on the angles kept, so that a motion with these will touch the cones
    /// between its nodes.
    pub(crate) fn fit_cones(&mut self, depths: &[ConeDepth], factor: f64) {
        self.angles.fill(0.0);
        for (i, depth) in depths.iter().enumerate() {
            let kept = factor * depth.bend();
            for end in [i, i + self.cones] {
                self.angles[end] = self.angles[end].max(kept);
            }
        }
    }

    /// Raises the angles kept from cones where the motion enters them between nodes, by its depth
    /// times a factor.
    pub(crate) fn raise_cones(&mut self, depths: &[ConeDepth], factor: f64) {
        let before = self.angles.clone();
        for (i, depth) in depths.iter().enumerate() {
            let between = depth.between.map_or(0.0, |between| between.max(0.0));
            let nearest = depth.at_ends[0].max(depth.at_ends[1]);
            for (end, at_end) in [i, i + self.cones].into_iter().zip(depth.at_ends) {
                // A node that keeps away farther than its reserve would not notice a small one more.
                let near = at_end >= nearest - between;
                let kept = if near {
                    before[end].max(-at_end)
                } else {
                    before[end]
                };
                if between > 0.0 {
                    self.angles[end] = self.angles[end].max(kept + factor * between);
                }
            }
        }
    }

    /// Raises the reserves at both ends of every interval by the excess found inside it, times a
    /// factor; `excess` lists the shares of one interval after the other.
    pub(crate) fn raise(&mut self, excess: &[f64], factor: f64) {
        raise_both_ends(&mut self.values, self.shares, excess, factor);
    }

    /// Raises all reserves by the same amount.
    pub(crate) fn raise_all(&mut self, amount: f64) {
        for value in &mut self.values {
            *value += amount;
        }
    }
}

/// Raises values of nodes, so many per node, by what was found on the intervals around them.
fn raise_both_ends(values: &mut [f64], per_node: usize, found: &[f64], factor: f64) {
    let before = values.to_vec();
    for (i, found) in found.iter().enumerate() {
        for end in [i, i + per_node] {
            values[end] = values[end].max(before[end] + factor * found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keeping(angles: &[f64]) -> Reserves {
        Reserves {
            shares: 0,
            values: Vec::new(),
            cones: 1,
            angles: angles.to_vec(),
        }
    }

    fn assert_keeps(reserves: &Reserves, angles: &[f64]) {
        for (kept, expected) in reserves.angles.iter().zip(angles) {
            assert!((kept - expected).abs() < 1e-12, "{:?}", reserves.angles);
        }
    }

    fn depth(at_ends: [f64; 2], between: f64) -> ConeDepth {
        ConeDepth {
            at_ends,
            between: Some(between),
        }
    }

    #[test]
    fn nodes_beside_a_bend_keep_its_height_and_far_from_cones_nothing() {
        let mut reserves = keeping(&[0.5; 4]);
        let bends = [
            depth([-0.004, -0.002], 0.003),
            depth([-0.002, -0.3], -0.001),
            depth([-0.3, -0.4], -0.2),
        ];
        reserves.fit_cones(&bends, 2.0);
        assert_keeps(&reserves, &[0.01, 0.01, 0.002, 0.0]);
    }

    #[test]
    fn only_the_nodes_that_notice_it_are_raised_from_where_they_are() {
        let mut reserves = keeping(&[0.001, 0.02, 0.0]);
        let entered = [depth([-0.001, -0.25], 0.01), depth([-0.25, -0.3], -0.2)];
        reserves.raise_cones(&entered, 1.0);
        assert_keeps(&reserves, &[0.011, 0.03, 0.0]);
        reserves.raise_cones(&[depth([-0.2, -0.25], 0.06), entered[1]], 1.0);
        assert_keeps(&reserves, &[0.26, 0.31, 0.0]);
    }
}
