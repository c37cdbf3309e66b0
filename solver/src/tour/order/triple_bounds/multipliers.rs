//! Inner, outer and joint multipliers of the decomposition.

use foldhash::fast::FixedState;
use std::collections::HashMap;

/// The multipliers, s: of the inner and outer ones a row for each target, with a value for each place.
#[derive(Debug, Clone)]
pub(super) struct Multipliers {
    places: usize,
    /// Inner multipliers: cost of the place as a neighbour of the target.
    pub(super) near: Vec<f64>,
    /// Outer multipliers: cost for a neighbour of the target when the place lies beyond the target.
    pub(super) outer: Vec<f64>,
    /// Joint multipliers, most of which are zero, by target and neighbour.
    joint: HashMap<usize, JointMultipliers, FixedState>,
}

/// Cost for one neighbour of a target when a place lies beyond the target, s.
#[derive(Debug, Clone, Default)]
pub(super) struct JointMultipliers {
    /// By place, sorted.
    values: Vec<(u32, f64)>,
    /// The least of them, or zero.
    pub(super) least: f64,
    /// The largest of them, or zero.
    pub(super) most: f64,
}

impl JointMultipliers {
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

    fn position(&self, place: usize) -> Result<usize, usize> {
        self.values
            .binary_search_by_key(&place, |entry| entry.0 as usize)
    }

    fn add(&mut self, place: usize, change: f64) {
        match self.position(place) {
            Ok(at) => self.values[at].1 += change,
            Err(at) => {
                let place = u32::try_from(place).unwrap_or(u32::MAX);
                self.values.insert(at, (place, change));
            }
        }
        let values = self.values.iter().map(|entry| entry.1);
        self.least = values.clone().fold(0.0, f64::min);
        self.most = values.fold(0.0, f64::max);
    }
}

impl Multipliers {
    /// All zero.
    pub(super) fn zero(targets: usize) -> Self {
        let places = targets + 2;
        Self {
            places,
            near: vec![0.0; targets * places],
            outer: vec![0.0; targets * places],
            joint: HashMap::default(),
        }
    }

    /// The multipliers that are equivalent to node potentials, s.
    pub(super) fn of_potentials(potentials: &[f64]) -> Self {
        let mut multipliers = Self::zero(potentials.len());
        for (row, potential) in multipliers
            .near
            .chunks_exact_mut(multipliers.places)
            .zip(potentials)
        {
            row.fill(-potential);
        }
        multipliers
    }

    pub(super) fn near(&self, target: usize, place: usize) -> f64 {
        self.near[target * self.places + place]
    }

    pub(super) fn outer(&self, target: usize, place: usize) -> f64 {
        self.outer[target * self.places + place]
    }

    /// The joint multipliers `w_i(j, h)` of a target `i` for its neighbour `j`, by the place `h` beyond.
    pub(super) fn joint(&self, target: usize, neighbour: usize) -> &JointMultipliers {
        let known = self.joint.get(&(target * self.places + neighbour));
        known.unwrap_or(JointMultipliers::NONE)
    }

    /// Sum of the target's two multipliers for a place, which is subtracted from the edge between
    /// them, s.
    pub(super) fn taken(&self, target: usize, place: usize) -> f64 {
        self.near(target, place) + self.outer(target, place)
    }

    /// Adds changes to single multipliers, times a factor.
    pub(super) fn add(&mut self, changes: &Heading, factor: f64) {
        for (values, changes) in [
            (&mut self.near, &changes.near),
            (&mut self.outer, &changes.outer),
        ] {
            for (&at, change) in changes {
                values[at] += factor * change;
            }
        }
        for (&(pair, beyond), change) in &changes.joint {
            let joint = self.joint.entry(pair).or_default();
            joint.add(beyond, factor * change);
        }
    }
}

/// Values below this are dropped from a direction.
const NEGLIGIBLE: f64 = 1e-4;

/// A direction in the multipliers that is zero nearly everywhere.
#[derive(Debug)]
pub(super) struct Heading {
    places: usize,
    near: HashMap<usize, f64, FixedState>,
    outer: HashMap<usize, f64, FixedState>,
    /// By target and neighbour, and by place beyond.
    joint: HashMap<(usize, usize), f64, FixedState>,
}

impl Heading {
    /// The direction zero.
    pub(super) fn zero(targets: usize) -> Self {
        Self {
            places: targets + 2,
            near: HashMap::default(),
            outer: HashMap::default(),
            joint: HashMap::default(),
        }
    }

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

    /// Adds to the value of a joint multiplier.
    pub(super) fn add_joint(&mut self, [target, neighbour, beyond]: [usize; 3], change: f64) {
        let pair = target * self.places + neighbour;
        *self.joint.entry((pair, beyond)).or_default() += change;
    }

    /// Adds to the value of an inner multiplier.
    pub(super) fn add_near(&mut self, target: usize, place: usize, change: f64) {
        *self.near.entry(target * self.places + place).or_default() += change;
    }

    /// Adds to the value of an outer multiplier.
    pub(super) fn add_outer(&mut self, target: usize, place: usize, change: f64) {
        *self.outer.entry(target * self.places + place).or_default() += change;
    }
}
