//! Inner and outer multipliers of the decomposition.

use foldhash::fast::FixedState;
use std::collections::HashMap;

/// Inner and outer multipliers, s: one row for each target, with a value for each place.
#[derive(Debug, Clone)]
pub(super) struct Multipliers {
    places: usize,
    /// Inner multipliers: cost of the place as a neighbour of the target.
    pub(super) near: Vec<f64>,
    /// Outer multipliers: cost for a neighbour of the target when the place lies beyond the target.
    pub(super) outer: Vec<f64>,
}

impl Multipliers {
    /// All zero.
    pub(super) fn zero(targets: usize) -> Self {
        let places = targets + 2;
        Self {
            places,
            near: vec![0.0; targets * places],
            outer: vec![0.0; targets * places],
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
}

impl Heading {
    /// The direction zero.
    pub(super) fn zero(targets: usize) -> Self {
        Self {
            places: targets + 2,
            near: HashMap::default(),
            outer: HashMap::default(),
        }
    }

    /// Multiplies all values by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        for values in [&mut self.near, &mut self.outer] {
            values.retain(|_, value| {
                *value *= factor;
                value.abs() > NEGLIGIBLE
            });
        }
    }

    /// Makes all values of outer multipliers zero.
    pub(super) fn stay_outside(&mut self) {
        self.outer.clear();
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
