//! Tours whose duration is the sum of leg durations that do not depend on each other.

use super::places::Places;
use crate::model::order_rules::OrderRules;
use crate::tour::order::{Evaluation, Place, TourEvaluation, TourModel};

/// Tours over legs of given durations, s, with settle and dwell times.
pub(super) struct AdditiveTours<'a, F> {
    places: &'a Places<'a>,
    leg_s: F,
}

impl<'a, F: Fn(Place, Place) -> f64 + Sync> AdditiveTours<'a, F> {
    /// Tours over the places of a scenario; `leg_s` gives the duration of a leg, s.
    pub(super) fn new(places: &'a Places<'a>, leg_s: F) -> Self {
        Self { places, leg_s }
    }

    /// Time from leaving the first place of a route to leaving its last one, s.
    pub(super) fn along(&self, route: &[Place]) -> f64 {
        let legs = route.windows(2);
        legs.map(|leg| self.pair_bound(leg[0], leg[1])).sum()
    }
}

impl<F: Fn(Place, Place) -> f64 + Sync> TourModel for AdditiveTours<'_, F> {
    fn target_count(&self) -> usize {
        self.places.scenario.targets().len()
    }

    fn has_end(&self) -> bool {
        self.places.scenario.end().is_some()
    }

    fn rules(&self) -> &OrderRules {
        self.places.scenario.order_rules()
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        (self.leg_s)(from, to) + self.places.service_time(to)
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        Evaluation::Value(self.along(&self.places.route(prefix, false)))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        Evaluation::Value(self.along(path))
    }

    fn couples(&self, _: usize) -> bool {
        false
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        TourEvaluation::Solved(self.along(&self.places.route(order, true)))
    }
}
