//! What targets take over of their edges.

/// By rows, one for each target, a value for each place: multipliers and outer multipliers, s, or a direction
/// in them.
#[derive(Debug, Clone)]
pub(super) struct Multipliers {
    places: usize,
    /// What the target pays when it has the place for a neighbour.
    pub(super) near: Vec<f64>,
    /// What is paid by whoever has the target for a neighbour and the place beyond it.
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

    /// What of every edge at a target makes up for its price, s.
    pub(super) fn of_potentials(prices: &[f64]) -> Self {
        let mut multipliers = Self::zero(prices.len());
        for (row, price) in multipliers
            .near
            .chunks_exact_mut(multipliers.places)
            .zip(prices)
        {
            row.fill(-price);
        }
        multipliers
    }

    pub(super) fn near(&self, target: usize, place: usize) -> f64 {
        self.near[target * self.places + place]
    }

    pub(super) fn outer(&self, target: usize, place: usize) -> f64 {
        self.outer[target * self.places + place]
    }

    /// What is taken off the edge from a target to a place on the target's side, s.
    pub(super) fn taken(&self, target: usize, place: usize) -> f64 {
        self.near(target, place) + self.outer(target, place)
    }

    /// Forgets a part of a direction.
    pub(super) fn fade(&mut self, kept: f64) {
        for value in self.near.iter_mut().chain(&mut self.outer) {
            *value *= kept;
        }
    }

    /// Adds to a share.
    pub(super) fn add_near(&mut self, target: usize, place: usize, change: f64) {
        self.near[target * self.places + place] += change;
    }

    /// Adds to an outer share.
    pub(super) fn add_outer(&mut self, target: usize, place: usize, change: f64) {
        self.outer[target * self.places + place] += change;
    }
}
