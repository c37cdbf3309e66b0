//! A proved bound on the whole tour, before any program has been solved.
//!
//! Cut a tour where it arrives at a target or the end, and leave out settling and dwelling: each
//! slew lasts at least its certified bound, which holds whatever comes before and after it. So the
//! shortest way through all targets in the table of these bounds, service times added, is a bound
//! on all tours in all orders that the scenario admits. The search finds that way; up to
//! [`crate::tour::order::completion::MAX_EXACT_TARGETS`] targets its first step is exact, beyond it stops
//! after some work with the bound that it has by then.

use super::additive_tours::AdditiveTours;
use super::places::Places;
use super::tables::CertifiedTable;
use crate::run::pool::SolverPool;
use crate::run::progress::Progress;
use crate::run::stop::StopSignal;
use crate::tour::order::{Incumbent, Place, SearchObserver, SearchSettings, search};

/// Nodes of the search times the third power of the number of targets: a fraction of a second.
const EFFORT: u64 = 50_000_000;
/// How far from the shortest way the search may end: nothing beside the gap of the bounds.
const GAP: f64 = 2e-4;
/// Share taken off for orders that the search takes to be equal, and for rounding.
const DEFLATION: f64 = 3e-9;

/// Tours whose slews take as long as their certified bounds; those of which nothing is proved, no time.
fn certified_tours<'a>(
    places: &'a Places<'a>,
    bounds: &'a CertifiedTable,
) -> AdditiveTours<'a, impl Fn(Place, Place) -> f64 + Sync> {
    AdditiveTours::new(places, |from, to| bounds.bound(from, to).unwrap_or(0.0))
}

/// A duration, s, that no tour undercuts, in whatever order the scenario admits; legs of which nothing is proved count
/// nothing. `None` when that is all of them.
pub(super) fn tour_bound(
    places: &Places<'_>,
    bounds: &CertifiedTable,
    pool: &SolverPool,
    stop: &StopSignal,
) -> Option<f64> {
    if !bounds.has_bounds() {
        return None;
    }
    let targets = places.scenario.targets().len() as u64;
    let settings = SearchSettings {
        node_limit: Some(EFFORT / targets.pow(3).max(1)),
        relative_gap: GAP,
        ..SearchSettings::default()
    };
    let tours = certified_tours(places, bounds);
    let found = search(&tours, &[], &settings, pool, stop, &Unobserved);
    Some(found.lower_bound_s * (1.0 - DEFLATION))
}

/// The same of the tours along one route.
pub(super) fn route_bound(
    places: &Places<'_>,
    bounds: &CertifiedTable,
    route: &[Place],
) -> Option<f64> {
    let sum = || certified_tours(places, bounds).along(route);
    bounds.has_bounds().then(|| sum() * (1.0 - DEFLATION))
}

/// Nobody is reported how this search goes.
struct Unobserved;

impl SearchObserver for Unobserved {
    fn progress(&self, _: Progress) {}

    fn improved(&self, _: &Incumbent<'_>) {}
}
