//! A first tour, found before any leg is solved: its order is short in the durations of eigenaxis
//! slews or, where there are too many of them, of turns about the body axes.

use super::additive_tours::AdditiveTours;
use super::tour_bound::MAX_TARGETS_ALL_LEGS;
use super::tours::Tours;
use crate::run::stop::StopSignal;
use crate::tour::order::{SolvedOrder, TourEvaluation, TourModel, short_order};

/// An order that is short before any leg is solved; `None` when there are no targets.
pub(super) fn first_order(tours: &Tours<'_>, stop: &StopSignal) -> Option<Vec<usize>> {
    let places = tours.places;
    if places.scenario.targets().len() > MAX_TARGETS_ALL_LEGS {
        let turns = AdditiveTours::new(places, |from, to| tours.ramped_turn_s(from, to));
        return short_order(&turns, stop);
    }
    let eigenaxes = AdditiveTours::new(places, |from, to| {
        let (begin, end) = (places.waypoint(from), places.waypoint(to));
        places.slew(&begin, &end).eigenaxis().course.duration()
    });
    short_order(&eigenaxes, stop)
}

/// Solves the tour of an order; `None` when it does not converge or the solve is stopped.
pub(super) fn first_tour(tours: &Tours<'_>, order: Vec<usize>) -> Option<SolvedOrder> {
    match tours.tour(&order) {
        TourEvaluation::Solved(duration_s) => Some(SolvedOrder { order, duration_s }),
        TourEvaluation::Unresolved | TourEvaluation::Stopped => None,
    }
}
