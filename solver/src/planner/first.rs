//! A first tour, before any leg is solved: short in the durations of slews about the eigenaxis.

use super::places::Places;
use super::tours::Tours;
use crate::sequence::{
    Evaluation, FlownOrder, OrderRules, Place, TourEvaluation, TourModel, short_order,
};
use crate::stop::StopSignal;

/// Slews about the eigenaxis from rest to rest.
struct EigenaxisTours<'a>(&'a Places<'a>);

/// Flies one tour; none when it does not converge or the solve is stopped.
pub(super) fn first_tour(tours: &Tours<'_>, stop: &StopSignal) -> Option<FlownOrder> {
    let order = short_order(&EigenaxisTours(tours.places), stop)?;
    match tours.tour(&order) {
        TourEvaluation::Flown(duration_s) => Some(FlownOrder { order, duration_s }),
        TourEvaluation::Unresolved | TourEvaluation::Stopped => None,
    }
}

impl TourModel for EigenaxisTours<'_> {
    fn target_count(&self) -> usize {
        self.0.scenario.targets().len()
    }

    fn has_end(&self) -> bool {
        self.0.scenario.end().is_some()
    }

    fn rules(&self) -> &OrderRules {
        self.0.scenario.order_rules()
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let (begin, end) = (self.0.waypoint(from), self.0.waypoint(to));
        let slew = self.0.slew(&begin, &end).eigenaxis();
        slew.trapezoid.duration + self.0.service_time(to)
    }

    fn prefix_bound(&self, _: &[usize]) -> Evaluation {
        Evaluation::Unresolved
    }

    fn path_bound(&self, _: &[Place]) -> Evaluation {
        Evaluation::Unresolved
    }

    fn couples(&self, _: usize) -> bool {
        false
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        let route = self.0.route(order, true);
        let legs = route.windows(2);
        TourEvaluation::Flown(legs.map(|leg| self.pair_bound(leg[0], leg[1])).sum())
    }
}
