//! A first tour, found before any leg is solved: its order is short in the durations of eigenaxis
//! slews or, where there are too many of them, of turns about the body axes and of the changes of their
//! rates between legs that couple.

use super::additive_tours::AdditiveTours;
use super::tours::Tours;
use super::turn_estimates::TurnEstimates;
use crate::model::waypoint::nearest_rolls;
use crate::run::stop::StopSignal;
use crate::tour::order::{
    SolvedOrder, TourEvaluation, TourModel, short_coupled_order, short_order,
};

/// An order that is short before any leg is solved; `None` when there are no targets.
pub(super) fn first_order(tours: &Tours<'_>, stop: &StopSignal) -> Option<Vec<usize>> {
    let places = tours.places;
    if places.needs_all_legs() {
        let eigenaxis_s = |from, to| {
            let ends = nearest_rolls(&places.waypoint(from), &places.waypoint(to));
            let slew = places.slew(&ends[0], &ends[1]);
            slew.eigenaxis().course.duration()
        };
        return short_order(&AdditiveTours::new(places, &eigenaxis_s), stop);
    }
    let estimates = TurnEstimates::of(places);
    let turn_s = |from, to| estimates.duration_s(from, to);
    let turns = AdditiveTours::new(places, &turn_s);
    if tours.has_couplings() {
        let free_ends = |from, to| estimates.free_ends(from, to);
        short_coupled_order(&turns, &free_ends, stop)
    } else {
        short_order(&turns, stop)
    }
}

/// Solves the tour of an order; `None` when it does not converge or the solve is stopped.
pub(super) fn first_tour(
    tours: &Tours<'_>,
    order: Vec<usize>,
) -> Option<(SolvedOrder, TourEvaluation)> {
    tours.load_legs(&order);
    let evaluation = tours.tour(&order);
    let duration_s = evaluation.duration_s()?;
    Some((SolvedOrder { order, duration_s }, evaluation))
}
