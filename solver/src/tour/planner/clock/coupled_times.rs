//! Times of legs with what neighbours lose together.

use super::Planning;
use crate::tour::order::{Evaluation, Place, TourModel};
use crate::tour::schedule::{TimedResult, TravelTimes, search};
use std::collections::HashMap;

/// Searches with the gaps of the best schedules of those before.
const ROUNDS: usize = 40;

/// Times of single legs with the coupling gaps of triples that have been solved.
pub(super) struct CoupledTimes<'a> {
    planning: &'a Planning<'a>,
    gaps: HashMap<[Place; 3], f64>,
}

impl TravelTimes for CoupledTimes<'_> {
    fn travel_s(&self, from: Place, to: Place) -> f64 {
        self.planning.time_s(from, to)
    }

    fn coupling_gaps_s(&self) -> Vec<([Place; 3], f64)> {
        let known = self.gaps.iter().filter(|(_, gap)| **gap > 0.0);
        known.map(|(triple, gap)| (*triple, *gap)).collect()
    }
}

impl<'a> CoupledTimes<'a> {
    /// These times with the gaps that the best schedules on them have, beginning with a schedule on the
    /// times of single legs, and the best schedule on them.
    pub(super) fn learned(
        planning: &'a Planning<'a>,
        mut best: TimedResult,
    ) -> (Self, TimedResult) {
        let mut times = Self {
            planning,
            gaps: HashMap::new(),
        };
        let stop = || planning.stop.is_set();
        for _ in 0..ROUNDS {
            let order = best.best.as_ref().map(|best| &best.order[..]);
            let unknown = order.map_or_else(Vec::new, |order| times.unknown(order));
            if unknown.is_empty() || stop() {
                break;
            }
            times.learn(&unknown);
            let problem = &planning.problem;
            let next = search(problem, &times, planning.limits, &stop, &mut |_| ());
            if !next.complete {
                break;
            }
            best = next;
        }
        (times, best)
    }

    /// The triples of an order whose gaps are not known.
    fn unknown(&self, order: &[usize]) -> Vec<[Place; 3]> {
        let tours = self.planning.tours;
        let route = tours.places.route(order, true);
        let triples = route
            .windows(3)
            .map(|triple| [triple[0], triple[1], triple[2]]);
        let couples = |via| matches!(via, Place::Target(target) if tours.couples(target));
        let open = triples.filter(|triple| couples(triple[1]) && !self.gaps.contains_key(triple));
        open.collect()
    }

    fn learn(&mut self, triples: &[[Place; 3]]) {
        let tours = self.planning.tours;
        let gaps = self.planning.run.pool.map(triples, |triple| {
            let alone: f64 = triple
                .windows(2)
                .map(|leg| tours.pair_bound(leg[0], leg[1]))
                .sum();
            match tours.path_bound(triple) {
                Evaluation::Value(together) => together - alone,
                _ => 0.0,
            }
        });
        self.gaps.extend(triples.iter().copied().zip(gaps));
    }
}
