//! A proved bound on the whole tour, before any program has been solved.
//!
//! Cut a tour where it arrives at a target or the end, and leave out settling and dwelling: each
//! slew lasts at least its certified bound, which holds whatever comes before and after it. So the
//! shortest way through all targets in the table of these bounds, service times added, is a bound
//! on all tours in all orders that the scenario admits. The search finds that way; up to
//! [`crate::sequence::remainder::EXACT_TARGETS`] targets its first step is exact, beyond it stops
//! after some work with the bound that it has by then.

use super::places::Places;
use super::tables::CertifiedTable;
use crate::pool::SolverPool;
use crate::progress::Progress;
use crate::sequence::{
    Evaluation, Incumbent, OrderRules, Place, SearchObserver, SearchSettings, TourEvaluation,
    TourModel, search,
};
use crate::stop::StopSignal;

/// Nodes of the search times the third power of the number of targets: a fraction of a second.
const EFFORT: u64 = 50_000_000;
/// How far from the shortest way the search may end: nothing beside the gap of the bounds.
const GAP: f64 = 2e-4;
/// Share taken off for orders that the search takes to be equal, and for rounding.
const DEFLATION: f64 = 3e-9;

/// Tours whose slews take as long as their certified bounds.
struct CertifiedTours<'a> {
    places: &'a Places<'a>,
    bounds: &'a CertifiedTable,
}

/// A duration, s, that no tour undercuts, in whatever order the scenario admits; legs of which nothing is proved count
/// nothing. `None` when that is all of them.
pub(super) fn tour_bound(
    places: &Places<'_>,
    bounds: &CertifiedTable,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Option<f64> {
    if !bounds.says_anything() {
        return None;
    }
    let targets = places.scenario.targets().len() as u64;
    let settings = SearchSettings {
        node_limit: Some(EFFORT / targets.pow(3).max(1)),
        relative_gap: GAP,
        ..SearchSettings::default()
    };
    let tours = CertifiedTours { places, bounds };
    let found = search(&tours, &[], &settings, pool, stop, &Unobserved);
    Some(found.lower_bound_s * (1.0 - DEFLATION))
}

/// The same of the tours along one route.
pub(super) fn route_bound(
    places: &Places<'_>,
    bounds: &CertifiedTable,
    route: &[Place],
) -> Option<f64> {
    let sum = || CertifiedTours { places, bounds }.along(route);
    bounds.says_anything().then(|| sum() * (1.0 - DEFLATION))
}

impl CertifiedTours<'_> {
    fn along(&self, route: &[Place]) -> f64 {
        let legs = route.windows(2);
        legs.map(|leg| self.pair_bound(leg[0], leg[1])).sum()
    }
}

impl TourModel for CertifiedTours<'_> {
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
        self.bounds.bound(from, to).unwrap_or(0.0) + self.places.service_time(to)
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        Evaluation::Value(self.along(&self.places.route(prefix, false)))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        Evaluation::Value(self.along(path))
    }

    /// The bound of a slew does not ask what comes before and after it.
    fn couples(&self, _: usize) -> bool {
        false
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        TourEvaluation::Flown(self.along(&self.places.route(order, true)))
    }
}

/// Nobody is told how this search goes.
struct Unobserved;

impl SearchObserver for Unobserved {
    fn progress(&self, _: Progress) {}

    fn improved(&self, _: &Incumbent<'_>) {}
}
