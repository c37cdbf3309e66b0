//! The places around every target, sorted by cost.

use super::coupling_gaps::narrow;
use crate::run::pool::SolverPool;

/// For every target all other places, sorted by cost. Each target has costs of its own for a few places;
/// the others cost the same around every target, but for a part common to all places around it.
#[derive(Debug, Default)]
pub(super) struct Ranking {
    rows: Vec<Row>,
    /// Costs of the places that have no own one around a target, s, sorted.
    others: Vec<(f64, u32)>,
}

/// The costs of the places around a target, s.
#[derive(Debug, Default)]
struct Row {
    /// Added to the costs of the places that are not listed.
    common: f64,
    /// The places with their own costs, sorted by cost.
    own: Vec<(f64, u32)>,
    /// The same places in their order.
    listed: Vec<u32>,
}

/// The costs around a target: the part common to all places without an own cost, and the own costs in the
/// order of the places, s.
pub(super) struct CostsAround<I> {
    pub(super) common: f64,
    pub(super) own: I,
}

impl Ranking {
    /// Updates the costs around all targets, on the workers of a pool where there is one. `others` has the
    /// costs of the places with no own one around a target.
    pub(super) fn rank<I: Iterator<Item = (usize, f64)>>(
        &mut self,
        pool: Option<&SolverPool>,
        targets: usize,
        others: impl Iterator<Item = f64>,
        around: impl Fn(usize) -> CostsAround<I> + Sync + Send,
    ) {
        self.others.clear();
        let others = others.enumerate();
        self.others
            .extend(others.map(|(place, cost)| (cost, narrow(place))));
        sort(&mut self.others);
        self.rows.resize_with(targets, Row::default);
        let fill = |(of, row): (usize, &mut Row)| {
            let CostsAround { common, own } = around(of);
            row.common = common;
            row.own.clear();
            row.own
                .extend(own.map(|(place, cost)| (cost, narrow(place))));
            row.listed.clear();
            row.listed.extend(row.own.iter().map(|entry| entry.1));
            sort(&mut row.own);
        };
        let rows = self.rows.iter_mut().enumerate();
        match pool {
            None => rows.for_each(fill),
            Some(pool) => drop(pool.map_short(rows.collect(), fill)),
        }
    }

    /// The places around a target with their costs, s, cheapest first.
    pub(super) fn row(&self, of: usize) -> RankedPlaces<'_> {
        RankedPlaces {
            of: narrow(of),
            row: &self.rows[of],
            own: &self.rows[of].own,
            others: &self.others,
        }
    }

    /// The least cost around a target, s.
    pub(super) fn least(&self, of: usize) -> f64 {
        self.row(of).next().map_or(f64::INFINITY, |place| place.1)
    }
}

fn sort(places: &mut [(f64, u32)]) {
    places.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
}

/// The places around a target with their costs, cheapest first: two sorted lists merged.
#[derive(Debug, Clone)]
pub(super) struct RankedPlaces<'a> {
    of: u32,
    row: &'a Row,
    own: &'a [(f64, u32)],
    others: &'a [(f64, u32)],
}

impl Iterator for RankedPlaces<'_> {
    type Item = (usize, f64);

    fn next(&mut self) -> Option<Self::Item> {
        while let Some((&(cost, place), rest)) = self.others.split_first() {
            let cost = cost + self.row.common;
            if self.own.first().is_some_and(|own| own.0 <= cost) {
                break;
            }
            self.others = rest;
            if place != self.of && self.row.listed.binary_search(&place).is_err() {
                return Some((place as usize, cost));
            }
        }
        let (&(cost, place), rest) = self.own.split_first()?;
        self.own = rest;
        Some((place as usize, cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::SplitMix;

    #[test]
    fn every_other_place_is_listed_once_and_cheapest_first() {
        let mut random = SplitMix::new(3);
        let targets = 12;
        let others: Vec<f64> = (0..targets).map(|_| random.below(5) as f64 - 2.0).collect();
        // The last two places are not among the others.
        let own: Vec<Vec<(usize, f64)>> = (0..targets)
            .map(|of| {
                let listed = (0..targets + 2)
                    .filter(|&place| place >= targets || (place != of && random.below(3) == 0));
                let listed: Vec<usize> = listed.collect();
                let cost = |place| (place, random.below(9) as f64 - 4.0);
                listed.into_iter().map(cost).collect()
            })
            .collect();
        let mut ranking = Ranking::default();
        ranking.rank(None, targets, others.iter().copied(), |of| CostsAround {
            common: of as f64,
            own: own[of].iter().copied(),
        });
        for of in 0..targets {
            let row: Vec<(usize, f64)> = ranking.row(of).collect();
            assert!(row.windows(2).all(|pair| pair[0].1 <= pair[1].1));
            let mut places: Vec<usize> = row.iter().map(|place| place.0).collect();
            places.sort_unstable();
            let expected: Vec<usize> = (0..targets + 2).filter(|&place| place != of).collect();
            assert_eq!(places, expected);
            for (place, cost) in row {
                let known = own[of].iter().find(|own| own.0 == place);
                let expected = known.map_or_else(|| others[place] + of as f64, |own| own.1);
                assert!((cost - expected).abs() < 1e-12);
            }
        }
    }
}
