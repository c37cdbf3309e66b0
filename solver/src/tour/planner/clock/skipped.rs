//! Why targets are left out, and what it would cost to include them.

use crate::model::plan::{InclusionCost, SkipReason, SkippedTarget};
use crate::model::scenario::Scenario;
use crate::run::stop::StopSignal;
use crate::tour::schedule::{
    Reach, SearchLimits, TimedOrder, TimedProblem, TravelTimes, reaches, search,
};

/// How many targets are looked at, and labels of each look.
const LOOKS: usize = 3;
const LABELS: u64 = 300_000;

/// The targets that an order leaves out while the search goes on.
pub(super) fn untried(scenario: &Scenario, order: &[usize]) -> Vec<SkippedTarget> {
    left_out(scenario, order)
        .map(|i| skipped(scenario, i, SkipReason::NotTried))
        .collect()
}

fn left_out(scenario: &Scenario, order: &[usize]) -> impl Iterator<Item = usize> {
    (0..scenario.targets().len()).filter(|i| !order.contains(i))
}

fn skipped(scenario: &Scenario, index: usize, reason: SkipReason) -> SkippedTarget {
    SkippedTarget {
        target: scenario.targets()[index].id.clone(),
        reason,
        inclusion: None,
    }
}

/// Looks for schedules with targets that the best one leaves out.
pub(super) struct Inclusions<'a, T> {
    pub(super) problem: &'a TimedProblem,
    pub(super) times: &'a T,
    pub(super) limits: SearchLimits,
    pub(super) stop: &'a StopSignal,
    /// Whether the times of the legs of an order are those of motions, and not lower bounds.
    pub(super) is_flown: &'a dyn Fn(&[usize]) -> bool,
}

impl<T: TravelTimes> Inclusions<'_, T> {
    /// The targets that the best schedule leaves out.
    pub(super) fn of(
        &self,
        scenario: &Scenario,
        best: &TimedOrder,
        proved: bool,
    ) -> Vec<SkippedTarget> {
        let reach = reaches(self.problem, self.times);
        let mut looks = 0;
        let explained = left_out(scenario, &best.order).map(|i| match reach[i] {
            Reach::OutsideWindows => skipped(scenario, i, SkipReason::WindowUnreachable),
            Reach::TooLate => skipped(scenario, i, SkipReason::TimeIsUp),
            Reach::InTime if !proved => skipped(scenario, i, SkipReason::NotTried),
            Reach::InTime => {
                looks += 1;
                let look = looks <= LOOKS && !self.stop.is_set();
                let (reason, inclusion) = if look {
                    self.with(i, best)
                } else {
                    (SkipReason::ValueTooSmall, None)
                };
                SkippedTarget {
                    inclusion,
                    ..skipped(scenario, i, reason)
                }
            }
        });
        explained.collect()
    }

    /// The best schedule with a target, compared with the best of all.
    fn with(&self, index: usize, best: &TimedOrder) -> (SkipReason, Option<InclusionCost>) {
        let mut problem = self.problem.clone();
        let own = problem.targets[index].value.take().unwrap_or(0.0);
        let limits = SearchLimits {
            labels: Some(LABELS),
            ..self.limits
        };
        let stop = || self.stop.is_set();
        let found = search(&problem, self.times, limits, &stop, &mut |_| ());
        let Some(with) = found.best else {
            // Without a proof it is known only that no schedule with it is better.
            let never = if self.problem.latest_end_s.is_some() {
                SkipReason::TimeIsUp
            } else {
                SkipReason::WindowUnreachable
            };
            let reason = if found.complete {
                never
            } else {
                SkipReason::ValueTooSmall
            };
            return (reason, None);
        };
        if !(self.is_flown)(&with.order) {
            return (SkipReason::ValueTooSmall, None);
        }
        let cost = InclusionCost {
            value_change: with.value + own - best.value,
            time_change_s: with.end_s - best.end_s,
        };
        (SkipReason::ValueTooSmall, Some(cost))
    }
}
