//! A scenario as a problem of times alone.

use super::chains::may_wait;
use crate::model::order_rules::OrderRules;
use crate::model::scenario::{Scenario, Target};
use crate::tour::order::Place;
use crate::tour::planner::places::Places;
use crate::tour::schedule::{TimedProblem, TimedTarget};

/// Whether every target is visited at rest and leaves nothing free, so that legs do not couple.
pub(super) fn leaves_nothing_free(places: &Places<'_>) -> bool {
    let targets = (0..places.scenario.targets().len()).map(Place::Target);
    targets.into_iter().all(|target| may_wait(places, target))
}

/// Greatest number of targets, and of enabled wheels, whose programs bound the times of passages.
pub(super) const MAX_COUPLED: usize = 60;
pub(super) const MAX_WHEELS: usize = 16;

/// Whether programs can be solved for a scenario whose legs couple.
pub(super) fn is_plannable(places: &Places<'_>) -> bool {
    places.scenario.targets().len() <= MAX_COUPLED && places.dynamics.wheel_count() <= MAX_WHEELS
}

/// Windows, services, values and rules of a scenario.
pub(super) fn timed_problem(scenario: &Scenario) -> TimedProblem {
    let timed = |target: &Target| TimedTarget {
        service_s: target.service(),
        windows: target.windows.as_ref().map(|windows| {
            let spans = windows.iter().map(|window| [window.from, window.to]);
            spans.collect()
        }),
        value: target.value,
    };
    let rules: &OrderRules = scenario.order_rules();
    TimedProblem {
        targets: scenario.targets().iter().map(timed).collect(),
        rules: rules.clone(),
        has_end: scenario.end().is_some(),
        latest_end_s: scenario.latest_end(),
    }
}
