//! Tours whose duration is the sum of leg durations that do not depend on each other.

use super::places::Places;
use crate::model::order_rules::OrderRules;
use crate::tour::order::{Evaluation, Place, TourEvaluation, TourModel};

/// Durations of legs, s, or lower bounds on them.
pub(super) trait LegTimes: Sync {
    /// What is known of the leg between two places, s.
    fn leg_s(&self, from: Place, to: Place) -> f64;

    /// Whether more is known of it after [`Self::raise`].
    fn is_open(&self, from: Place, to: Place) -> bool {
        let _ = (from, to);
        false
    }

    /// Finds out what there is to know of some open legs.
    fn raise(&self, legs: &[(Place, Place)]) {
        let _ = legs;
    }
}

impl<F: Fn(Place, Place) -> f64 + Sync> LegTimes for F {
    fn leg_s(&self, from: Place, to: Place) -> f64 {
        self(from, to)
    }
}

/// Tours over legs of given durations, with settle and dwell times.
pub(super) struct AdditiveTours<'a, T> {
    places: &'a Places<'a>,
    legs: &'a T,
}

impl<'a, T: LegTimes> AdditiveTours<'a, T> {
    /// Tours over the places of a scenario.
    pub(super) fn new(places: &'a Places<'a>, legs: &'a T) -> Self {
        Self { places, legs }
    }

    /// Time from leaving the first place of a route to leaving its last one, s.
    pub(super) fn along(&self, route: &[Place]) -> f64 {
        let legs = route.windows(2);
        legs.map(|leg| self.pair_bound(leg[0], leg[1])).sum()
    }
}

impl<T: LegTimes> TourModel for AdditiveTours<'_, T> {
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
        self.legs.leg_s(from, to) + self.places.service_time(to)
    }

    fn is_open(&self, from: Place, to: Place) -> bool {
        self.legs.is_open(from, to)
    }

    fn raise_pair_bounds(&self, pairs: &[(Place, Place)]) {
        self.legs.raise(pairs);
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let route = self.places.route(prefix, false);
        let legs = route.windows(2).map(|leg| (leg[0], leg[1]));
        let open: Vec<_> = legs.filter(|(from, to)| self.is_open(*from, *to)).collect();
        self.raise_pair_bounds(&open);
        Evaluation::Value(self.along(&route))
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
