//! Inner, outer and joint multipliers of the decomposition.

use super::coupling_gaps::narrow;
use foldhash::fast::FixedState;
use std::collections::HashMap;

/// Multipliers for some places, s. Those for all others are zero.
#[derive(Debug, Clone, Default)]
pub(super) struct PlaceMultipliers {
    /// By place, sorted.
    values: Vec<(u32, f64)>,
    /// The least of them, or zero.
    pub(super) least: f64,
    /// The largest of them, or zero.
    pub(super) most: f64,
}

impl PlaceMultipliers {
    /// All zero.
    pub(super) const NONE: &Self = &Self {
        values: Vec::new(),
        least: 0.0,
        most: 0.0,
    };

    /// That for a place.
    pub(super) fn of(&self, place: usize) -> f64 {
        self.position(place).map_or(0.0, |at| self.values[at].1)
    }

    /// The places that are listed, in their order, with their values.
    pub(super) fn listed(&self) -> impl Iterator<Item = (usize, f64)> {
        let values = self.values.iter();
        values.map(|&(place, value)| (place as usize, value))
    }

    fn position(&self, place: usize) -> Result<usize, usize> {
        self.values
            .binary_search_by_key(&place, |entry| entry.0 as usize)
    }

    /// Adds to the value for a place, which is listed from now on.
    fn add(&mut self, place: usize, change: f64) {
        match self.position(place) {
            Ok(at) => self.values[at].1 += change,
            Err(at) => self.values.insert(at, (narrow(place), change)),
        }
        let values = self.values.iter().map(|entry| entry.1);
        self.least = values.clone().fold(0.0, f64::min);
        self.most = values.fold(0.0, f64::max);
    }
}

/// The multipliers, s. Of many targets, nearly all are those that are equivalent to node potentials.
#[derive(Debug, Clone)]
pub(super) struct Multipliers {
    /// Less each target's node potential: the common part of its inner multipliers.
    common: Vec<f64>,
    /// The rest of the inner multipliers, by target: cost of the place as a neighbour of the target. Each
    /// target lists the start, the end, and all targets with which it shares a joint multiplier.
    near: Vec<PlaceMultipliers>,
    /// Outer multipliers, by target: cost for a neighbour of the target when the place lies beyond the
    /// target.
    outer: Vec<PlaceMultipliers>,
    /// Joint multipliers by target and neighbour: cost for the neighbour when the place lies beyond the
    /// target.
    joint: HashMap<[usize; 2], PlaceMultipliers, FixedState>,
}

impl Multipliers {
    /// The multipliers that are equivalent to node potentials, s.
    pub(super) fn of_potentials(potentials: &[f64]) -> Self {
        let targets = potentials.len();
        let mut ends = PlaceMultipliers::default();
        ends.add(targets, 0.0);
        ends.add(targets + 1, 0.0);
        Self {
            common: potentials.iter().map(|potential| -potential).collect(),
            near: vec![ends; targets],
            outer: vec![PlaceMultipliers::default(); targets],
            joint: HashMap::default(),
        }
    }

    /// The common part of a target's inner multipliers.
    pub(super) fn common(&self, target: usize) -> f64 {
        self.common[target]
    }

    /// The common parts of all targets.
    pub(super) fn common_parts(&self) -> &[f64] {
        &self.common
    }

    /// The rest of its inner multipliers.
    pub(super) fn near_rest(&self, target: usize) -> &PlaceMultipliers {
        &self.near[target]
    }

    /// The inner multiplier `r_j(i)` of a target.
    pub(super) fn near(&self, target: usize, place: usize) -> f64 {
        self.common[target] + self.near[target].of(place)
    }

    /// The outer multipliers `s_i(h)` of a target.
    pub(super) fn outer(&self, target: usize) -> &PlaceMultipliers {
        &self.outer[target]
    }

    /// The joint multipliers `w_i(j, h)` of a target `i` for its neighbour `j`, by the place `h` beyond.
    pub(super) fn joint(&self, target: usize, neighbour: usize) -> &PlaceMultipliers {
        let known = self.joint.get(&[target, neighbour]);
        known.unwrap_or(PlaceMultipliers::NONE)
    }

    /// Sum of the target's two multipliers for a place, which is subtracted from the edge between
    /// them, s.
    pub(super) fn taken(&self, target: usize, place: usize) -> f64 {
        self.near(target, place) + self.outer[target].of(place)
    }

    /// Adds to the common part of the inner multipliers of all targets.
    pub(super) fn shift(&mut self, changes: impl Iterator<Item = f64>) {
        for (common, change) in self.common.iter_mut().zip(changes) {
            *common += change;
        }
    }

    /// Adds changes to single multipliers, times a factor.
    pub(super) fn add(&mut self, changes: &Heading, factor: f64) {
        for (rows, changes) in [
            (&mut self.near, &changes.near),
            (&mut self.outer, &changes.outer),
        ] {
            for (&[target, place], change) in changes {
                rows[target].add(place, factor * change);
            }
        }
        for (&[target, neighbour, beyond], change) in &changes.joint {
            let joint = self.joint.entry([target, neighbour]);
            let joint = joint.or_insert_with(|| {
                self.near[target].add(neighbour, 0.0);
                self.near[neighbour].add(target, 0.0);
                PlaceMultipliers::default()
            });
            joint.add(beyond, factor * change);
        }
    }
}

/// Values below this are dropped from a direction.
const NEGLIGIBLE: f64 = 1e-4;

/// A direction in the multipliers that is zero nearly everywhere.
#[derive(Debug, Default)]
pub(super) struct Heading {
    /// By target and place.
    near: HashMap<[usize; 2], f64, FixedState>,
    outer: HashMap<[usize; 2], f64, FixedState>,
    /// By target, neighbour and place beyond.
    joint: HashMap<[usize; 3], f64, FixedState>,
}

impl Heading {
    /// Multiplies all values by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        let scale = |value: &mut f64| {
            *value *= factor;
            value.abs() > NEGLIGIBLE
        };
        self.near.retain(|_, value| scale(value));
        self.outer.retain(|_, value| scale(value));
        self.joint.retain(|_, value| scale(value));
    }

    /// Makes all values of outer and joint multipliers zero.
    pub(super) fn stay_outside(&mut self) {
        self.outer.clear();
        self.joint.clear();
    }

    /// Adds to the value of a target's inner multiplier for a place.
    pub(super) fn add_near(&mut self, target: usize, place: usize, change: f64) {
        *self.near.entry([target, place]).or_default() += change;
    }

    /// Adds to the value of a target's outer multiplier for a place.
    pub(super) fn add_outer(&mut self, target: usize, place: usize, change: f64) {
        *self.outer.entry([target, place]).or_default() += change;
    }

    /// Adds to the value of the joint multiplier of a target for its neighbour and a place beyond the
    /// target.
    pub(super) fn add_joint(&mut self, path: [usize; 3], change: f64) {
        *self.joint.entry(path).or_default() += change;
    }
}
