//! The places around every target, sorted by cost.

use crate::run::pool::SolverPool;

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

    /// Updates the costs of the places around all targets, on the workers of a pool where there is one.
    pub(super) fn rank(
        &mut self,
        pool: Option<&SolverPool>,
        cost: impl Fn(usize, usize) -> f64 + Sync + Send,
    ) {
        let costs = self.costs.chunks_exact_mut(self.places);
        let rows = costs.zip(self.ranked.chunks_exact_mut(self.places - 1));
        let rows = rows.enumerate();
        let rank_row = |(of, (costs, ranked)): (usize, (&mut [f64], &mut [u32]))| {
            for (place, entry) in costs.iter_mut().enumerate() {
                *entry = cost(of, place);
            }
            sort_nearly_sorted(ranked, costs);
        };
        match pool {
            None => rows.for_each(rank_row),
            Some(pool) => drop(pool.map_short(rows.collect(), rank_row)),
        }
    }
}

/// Sorts places by their costs, by insertion.
fn sort_nearly_sorted(places: &mut [u32], costs: &[f64]) {
    for i in 1..places.len() {
        let place = places[i];
        let mut hole = i;
        while hole > 0 && costs[places[hole - 1] as usize] > costs[place as usize] {
            places[hole] = places[hole - 1];
            hole -= 1;
        }
        places[hole] = place;
    }
}
