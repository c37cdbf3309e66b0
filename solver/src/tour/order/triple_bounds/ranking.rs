//! The places around every target, sorted by cost.

/// For every target all other places, sorted by cost.
///
/// The ranking is kept between the steps of an ascent: insertion sort is fast where little changes.
#[derive(Debug)]
pub(super) struct Ranking {
    places: usize,
    /// Costs by rows, one for each target.
    costs: Vec<f64>,
    /// Sorted places by rows, one for each target.
    ranked: Vec<u32>,
}

impl Ranking {
    pub(super) fn new(targets: usize) -> Self {
        let places = targets + 2;
        let others = |of| (0..places).filter(move |&place| place != of);
        Self {
            places,
            costs: vec![0.0; targets * places],
            ranked: (0..targets)
                .flat_map(others)
                .map(|place| u32::try_from(place).unwrap_or(u32::MAX))
                .collect(),
        }
    }

    /// The places around a target, cheapest first.
    pub(super) fn row(&self, of: usize) -> impl Iterator<Item = usize> + Clone {
        let row = &self.ranked[of * (self.places - 1)..][..self.places - 1];
        row.iter().map(|&place| place as usize)
    }

    pub(super) fn cost(&self, of: usize, place: usize) -> f64 {
        self.costs[of * self.places + place]
    }

    /// The least cost around a target.
    pub(super) fn least(&self, of: usize) -> f64 {
        self.row(of)
            .next()
            .map_or(f64::INFINITY, |place| self.cost(of, place))
    }

    /// Updates the costs of the places around a target and sorts them by insertion.
    pub(super) fn rank(&mut self, of: usize, cost: impl Fn(usize) -> f64) {
        let costs = &mut self.costs[of * self.places..][..self.places];
        for (place, entry) in costs.iter_mut().enumerate() {
            *entry = cost(place);
        }
        let row = &mut self.ranked[of * (self.places - 1)..][..self.places - 1];
        for i in 1..row.len() {
            let place = row[i];
            let mut hole = i;
            while hole > 0 && costs[row[hole - 1] as usize] > costs[place as usize] {
                row[hole] = row[hole - 1];
                hole -= 1;
            }
            row[hole] = place;
        }
    }
}
