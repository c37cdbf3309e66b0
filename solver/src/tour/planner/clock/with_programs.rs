//! Schedules whose legs couple: a branch and bound that begins with the search on times of single legs.

use super::Planning;
use super::coupled::CoupledSearch;
use super::coupled_times::CoupledTimes;
use crate::model::plan::Outcome;
use crate::run::progress::Stage;
use crate::tour::order::{Place, TourModel};
use crate::tour::schedule::{Continuations, SearchLimits, TimedOrder, TimedResult, search};
use std::collections::HashMap;

/// Rounds of first schedules, each with what has been learned of coupled legs.
const FIRST_ROUNDS: usize = 16;
/// Labels of a search for an order of these rounds.
const LABELS_OF_ORDERS: u64 = 100_000;
/// Rounds without a better schedule that end them.
const PATIENCE: usize = 4;

/// Times of legs as they are flown, s.
#[derive(Default)]
struct FlownLegs {
    times: HashMap<(Place, Place), f64>,
    /// Sums of the flown times, and of the times of the same legs on their own.
    sums: [f64; 2],
}

impl Planning<'_> {
    /// The answer where rates or rolls are free at targets.
    pub(super) fn with_programs(mut self) -> Outcome {
        self.solve_all_legs();
        let times = |from, to| self.time_s(from, to);
        let stop = || self.stop.is_set();
        let single = search(&self.problem, &times, self.limits, &stop, &mut |_| ());
        if single.best.is_none() {
            return self.conclude(&single, None);
        }
        let from = (Continuations::new(&self.problem, &times), &single);
        let mut programs = CoupledSearch::new(self.tours, (self.run.pool, self.stop), from);
        self.find_first_schedules(&mut programs, &single);
        let (times, relaxed) = CoupledTimes::learned(&self, single);
        let from = (Continuations::new(&self.problem, &times), &relaxed);
        let mut programs = programs.tightened(from);
        let mut known = programs.rank();
        while programs.step() {
            let state = self.state(&programs, &relaxed);
            if programs.rank() == known {
                self.report(Stage::Search, &state);
            } else {
                known = programs.rank();
                self.tell(&state, programs.chains());
            }
        }
        let state = self.state(&programs, &relaxed);
        let chains = programs.chains().unwrap_or_default().to_vec();
        self.conclude(&state, Some(&chains))
    }

    /// Solves good orders on the times of legs, which are learned from those that are flown.
    fn find_first_schedules(&self, programs: &mut CoupledSearch<'_>, relaxed: &TimedResult) {
        let mut flown = FlownLegs::default();
        let mut order = relaxed.best.as_ref().map(|best| best.order.clone());
        let mut failed = 0;
        for _ in 0..FIRST_ROUNDS {
            let Some(known) = order.filter(|_| !self.stop.is_set() && failed < PATIENCE) else {
                return;
            };
            if programs.try_order(&known) {
                failed = 0;
                self.tell(&self.state(programs, relaxed), programs.chains());
            } else {
                failed += usize::from(programs.best.is_some());
            }
            flown.learn(self, &known);
            order = self.order_on(&flown);
        }
    }

    /// A good order on the times of flown legs.
    fn order_on(&self, flown: &FlownLegs) -> Option<Vec<usize>> {
        let times = |from, to| {
            let single = self.flown_s(from, to);
            let single = single.unwrap_or_else(|| self.time_s(from, to));
            let known = flown.times.get(&(from, to)).copied();
            known.unwrap_or(single * flown.lengthening()).max(single)
        };
        let limits = SearchLimits {
            labels: Some(LABELS_OF_ORDERS),
            ..self.limits
        };
        let stop = || self.stop.is_set();
        let found = search(&self.problem, &times, limits, &stop, &mut |_| ());
        found.best.map(|best| best.order)
    }

    /// The state of the search as that of a search on times.
    fn state(&self, programs: &CoupledSearch<'_>, relaxed: &TimedResult) -> TimedResult {
        let best = programs.best.as_ref().map(|best| TimedOrder {
            order: best.order.clone(),
            begins_s: best.begins(),
            end_s: best.rank.end_s,
            value: self.problem.value_of(&best.order),
        });
        let value = best.as_ref().map_or(0.0, |best| best.value);
        let bound = programs.bound();
        let value_bound = bound.map_or(0.0, |bound| programs.value_of(bound));
        // An end bounds all schedules of at least the best value only if none has more.
        let about_time = bound
            .zip(programs.rank())
            .filter(|(bound, rank)| bound.units == rank.units);
        TimedResult {
            value_bound: value_bound.min(relaxed.value_bound).max(value),
            end_bound_s: about_time.map_or(0.0, |(bound, rank)| bound.end_s.min(rank.end_s)),
            complete: programs.is_complete(),
            labels: programs.nodes,
            best,
        }
    }
}

impl FlownLegs {
    /// Takes the times of the legs of an order, without windows.
    fn learn(&mut self, planning: &Planning<'_>, order: &[usize]) {
        let places = planning.tours.places;
        let route = places.route(order, true);
        let times = planning.tours.leg_times(order).unwrap_or_default();
        for (leg, time) in route.windows(2).zip(times) {
            let flown = time - places.service_time(leg[1]);
            self.times.insert((leg[0], leg[1]), flown);
            self.sums[0] += flown;
            self.sums[1] += planning.time_s(leg[0], leg[1]);
        }
    }

    /// By how much flown legs are longer than on their own, as a factor.
    fn lengthening(&self) -> f64 {
        let [flown, single] = self.sums;
        if single > 0.0 {
            (flown / single).max(1.0)
        } else {
            1.0
        }
    }
}
