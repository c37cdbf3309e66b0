//! A certified lower bound on whole tours, before any program is solved.
//!
//! Each leg of a tour lasts at least its certified bound, which holds whatever comes before and
//! after the leg. So the shortest path through all targets in the table of these bounds, with
//! settle and dwell times added, bounds all tours in all orders that the scenario admits. The order
//! search finds a bound on that path: exact up to
//! [`crate::tour::order::completion::MAX_EXACT_TARGETS`] targets, beyond that number the bound
//! reached within a node limit, and for so many that the limit is 0 that of spanning trees.
//!
//! Times of passages may be off by the checker's tolerance of the flight's duration: an arrival lies
//! before the departure by it, a stay is shorter by it. With three of them for every place, the sum of
//! legs and stays is at most the duration and a small part of itself.

use super::additive_tours::AdditiveTours;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use crate::model::tolerances::TIME_TOLERANCE;
use crate::run::pool::SolverPool;
use crate::run::progress::Progress;
use crate::run::stop::StopSignal;
use crate::tour::order::{
    Incumbent, KnownOrders, Place, SearchObserver, SearchSettings, least_bound, search,
};

/// Node limit of the search times the cube of the number of targets: a fraction of a second.
const NODES_TIMES_TARGETS_CUBED: u64 = 50_000_000;
/// Relative gap at which the search may end; small beside the gap of the certified bounds.
const GAP: f64 = 2e-4;
/// Relative reduction of the bound, for orders that the search treats as ties and for rounding.
const DEFLATION: f64 = 3e-9;
/// Times of a flight at each place that may be off, with one for the rounding of passages onto
/// controls.
const TIMES_PER_PLACE: f64 = 4.0;

/// Certified lower bound on the duration of all tours, s, over all orders that the scenario admits.
/// A leg without a proved bound counts as 0; `None` when no leg has one.
pub(super) fn tour_bound(
    places: &Places<'_>,
    bounds: &ProvedLegs<'_>,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Option<f64> {
    Some(shortest(places, bounds, pool, stop)?.0)
}

/// The same with an order of the targets that has such a bound or hardly more; without one for very many targets.
pub(super) fn shortest(
    places: &Places<'_>,
    bounds: &ProvedLegs<'_>,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Option<(f64, Option<Vec<usize>>)> {
    let tours = AdditiveTours::new(places, bounds);
    let targets = places.scenario.targets().len() as u64;
    let nodes = NODES_TIMES_TARGETS_CUBED / targets.pow(3).max(1);
    let (bound, order) = if nodes == 0 {
        (least_bound(&tours, stop), None)
    } else {
        let settings = SearchSettings {
            node_limit: Some(nodes),
            relative_gap: GAP,
            ..SearchSettings::default()
        };
        let nothing = KnownOrders::default();
        let found = search(&tours, nothing, &settings, pool, stop, &Unobserved);
        (found.lower_bound_s, found.best.map(|best| best.order))
    };
    let proved = bounds.has_bounds();
    proved.then(|| (within_tolerance(places, bound), order))
}

/// The same for the tours along one route.
pub(super) fn route_bound(
    places: &Places<'_>,
    bounds: &ProvedLegs<'_>,
    route: &[Place],
) -> Option<f64> {
    let sum = || AdditiveTours::new(places, bounds).along(route);
    bounds.has_bounds().then(|| within_tolerance(places, sum()))
}

/// The bound on the duration of tours, s, whose legs and stays last at least so long, s.
fn within_tolerance(places: &Places<'_>, sum: f64) -> f64 {
    let count = places.all().len() as f64;
    let off = TIMES_PER_PLACE * count * TIME_TOLERANCE;
    sum * (1.0 - DEFLATION) / (1.0 + off)
}

/// Ignores the progress of this search.
struct Unobserved;

impl SearchObserver for Unobserved {
    fn progress(&self, _: Progress) {}

    fn improved(&self, _: &Incumbent<'_>) {}
}

#[cfg(test)]
mod tests;
