//! Schedules whose legs do not couple: the search on their times is all there is to it.

use super::{NO_LEG_S, Planning};
use crate::model::plan::Outcome;
use crate::tour::order::{Place, TourModel};
use crate::tour::planner::additive_tours::LegTimes;
use crate::tour::planner::turn_estimates::TurnEstimates;
use crate::tour::schedule::{
    MAX_LABELLED, SearchLimits, TimedOrder, TimedResult, possible_legs, search_from,
};

/// Rounds of first schedules among many targets.
const FIRST_ROUNDS: usize = 8;
/// Local searches where nothing is proved.
const MORE_ROUNDS: usize = 1000;
/// Legs that are solved between two looks for better schedules of solved legs.
const LEGS_AT_ONCE: usize = 1000;

impl Planning<'_> {
    /// The answer where every target is visited at rest.
    pub(super) fn with_legs_alone(mut self) -> Outcome {
        let mut has_all = self.tours.places.needs_all_legs();
        if has_all {
            self.solve_all_legs();
        } else {
            self.solve_good_schedules();
            self.prove_possible_legs();
        }
        let mut value_bound = f64::INFINITY;
        loop {
            let found = self.search(if has_all {
                self.limits_on_times()
            } else {
                self.limits_on_bounds()
            });
            value_bound = value_bound.min(found.value_bound);
            let found = TimedResult {
                value_bound,
                ..found
            };
            let order = found.best.as_ref().map(|best| &best.order[..]);
            let open = order.map_or(Vec::new(), |order| self.open_legs(order));
            if open.is_empty() && (found.complete || has_all) {
                if order.is_none_or(|order| self.is_flown(order)) {
                    return self.conclude(&found, None);
                }
                let flown = self.search_flown(None, self.limits_on_times());
                self.relaxed.get_or_insert(found);
                return self.conclude(&flown, None);
            }
            if self.stop.is_set() {
                let known = TimedResult {
                    best: self.search_flown(None, self.local_limits()).best,
                    complete: false,
                    end_bound_s: 0.0,
                    ..found
                };
                return self.conclude(&known, None);
            }
            self.solve(&open);
            self.tell_solved(&found);
            if !found.complete && !has_all {
                self.solve_possible_legs(&found);
                has_all = true;
            }
        }
    }

    /// Solves the legs of good schedules by estimates of their times.
    fn solve_good_schedules(&self) {
        let estimates = TurnEstimates::of(self.tours.places);
        for _ in 0..FIRST_ROUNDS {
            let found = self.search_flown(Some(&estimates), self.local_limits());
            let order = found.best.as_ref().map(|best| &best.order[..]);
            let open = order.map_or(Vec::new(), |order| self.open_legs(order));
            self.solve(&open);
            if let Some(best) = order.and_then(|order| self.what_fits(order)) {
                let best = Some(best).filter(|best| self.has_required(best));
                self.tell(
                    &TimedResult {
                        best,
                        ..found.clone()
                    },
                    None,
                );
            }
            if open.is_empty() || self.stop.is_set() {
                break;
            }
        }
    }

    /// Certified bounds of all legs that are possible in time: a tenth of the work of the legs, and so close
    /// to their times that labels need few of them solved.
    fn prove_possible_legs(&self) {
        if self.problem.targets.len() > MAX_LABELLED {
            return;
        }
        for some in self.possible_legs().chunks(LEGS_AT_ONCE) {
            if self.stop.is_set() {
                return;
            }
            self.tours.certified.raise(some);
        }
    }

    /// Solves all legs that are possible in time, and tells of the schedules that they make known.
    fn solve_possible_legs(&self, bounds: &TimedResult) {
        for some in self.possible_legs().chunks(LEGS_AT_ONCE) {
            if self.stop.is_set() {
                return;
            }
            self.tours.solve_free_legs(some);
            self.tell_solved(bounds);
        }
    }

    /// The legs that are possible in time and not solved.
    fn possible_legs(&self) -> Vec<(Place, Place)> {
        let times = |from, to| self.time_s(from, to);
        let mut possible = possible_legs(&self.problem, &times);
        possible.retain(|(from, to)| self.tours.is_open(*from, *to));
        possible
    }

    /// The schedule of the visits of an order that fit one after the other, all of whose legs are solved:
    /// legs take longer than their estimates.
    fn what_fits(&self, order: &[usize]) -> Option<TimedOrder> {
        let times = |from, to| self.flown_s(from, to).unwrap_or(NO_LEG_S);
        let mut fitting = self.problem.schedule_of(&[], &times);
        let mut kept: Vec<usize> = Vec::new();
        for target in order {
            kept.push(*target);
            self.solve(&self.open_legs(&kept));
            match self.problem.schedule_of(&kept, &times) {
                Some(longer) => fitting = Some(longer),
                None => {
                    kept.pop();
                }
            }
        }
        fitting
    }

    /// Whether a schedule visits all targets that have to be visited.
    fn has_required(&self, schedule: &TimedOrder) -> bool {
        let targets = self.problem.targets.iter().enumerate();
        let mut required = targets.filter(|(_, target)| target.value.is_none());
        required.all(|(target, _)| schedule.order.contains(&target))
    }

    fn solve(&self, legs: &[(Place, Place)]) {
        if legs.is_empty() {
            return;
        }
        self.tours.certified.raise(legs);
        self.tours.solve_free_legs(legs);
    }

    /// Reports the best schedule all of whose legs are solved, with the bounds of a search.
    fn tell_solved(&self, bounds: &TimedResult) {
        let known = TimedResult {
            best: self.search_flown(None, self.local_limits()).best,
            ..bounds.clone()
        };
        self.tell(&known, None);
    }

    /// The limits of the last search. Local searches go on where nothing is proved.
    fn limits_on_times(&self) -> SearchLimits {
        SearchLimits {
            // A limit of nodes is one of labels, and then of the whole search.
            more_rounds: self.limits.labels.map_or(MORE_ROUNDS, |_| 0),
            ..self.limits
        }
    }

    /// The search with bounds for the times of legs that are not solved.
    fn search(&self, limits: SearchLimits) -> TimedResult {
        let times = |from, to| self.time_s(from, to);
        let stop = || self.stop.is_set();
        let all = (&self.problem, &times);
        let first = self.told_order();
        search_from(all, &first, limits, &stop, &mut |now| {
            let order = now.best.as_ref().map(|best| &best.order[..]);
            if order.is_some_and(|order| self.open_legs(order).is_empty() && self.is_flown(order)) {
                self.tell(now, None);
            }
        })
    }

    /// Local searches alone.
    fn local_limits(&self) -> SearchLimits {
        SearchLimits {
            labels: Some(0),
            ..self.limits
        }
    }

    /// The search over schedules all of whose legs are flown, or else have an estimate. Its bounds are not those of all
    /// schedules.
    fn search_flown(
        &self,
        estimates: Option<&TurnEstimates<'_>>,
        limits: SearchLimits,
    ) -> TimedResult {
        let times = |from, to| {
            let estimate = || estimates.map(|estimates| estimates.duration_s(from, to));
            self.flown_s(from, to).or_else(estimate).unwrap_or(NO_LEG_S)
        };
        let all = (&self.problem, &times);
        let stop = || self.stop.is_set();
        search_from(all, &self.told_order(), limits, &stop, &mut |_| ())
    }

    fn open_legs(&self, order: &[usize]) -> Vec<(Place, Place)> {
        let route = self.tours.places.route(order, true);
        let legs = route.windows(2).map(|leg| (leg[0], leg[1]));
        legs.filter(|(from, to)| self.tours.is_open(*from, *to))
            .collect()
    }
}
