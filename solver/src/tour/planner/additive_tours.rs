//! Tours whose slews take times of their own, whatever comes before and after them.

use super::places::Places;
use crate::model::order_rules::OrderRules;
use crate::tour::order::{Evaluation, Place, TourEvaluation, TourModel};

/// Tours over slews of given durations, s, with settle and dwell.
pub(super) struct AdditiveTours<'a, F> {
    places: &'a Places<'a>,
    slew: F,
}

impl<'a, F: Fn(Place, Place) -> f64 + Sync> AdditiveTours<'a, F> {
    /// Tours over slews that take so long, s, from one place to another.
    pub(super) fn new(places: &'a Places<'a>, slew: F) -> Self {
        Self { places, slew }
    }

    /// Time from leaving the first place of a route to leaving its last, s.
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
        (self.slew)(from, to) + self.places.service_time(to)
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
