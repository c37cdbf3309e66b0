//! The largest lower bounds that are proved, for a plan that is there.
//!
//! The bounds that steer the search come from boxes of rates, in some 30 microseconds a leg. Norms whose unit balls
//! are polytopes prove more of legs of arrays, with unequal ramps, and between targets that stop some components only
//! (`bounds::certified`). Both are proved a second time in intervals, and what is not confirmed does not count. Bounds
//! with stored momentum, with a free roll, and by a limit of the norm of the rate are proved once.

use super::bounds_by_form::BoundsByForm;
use super::canonical::CanonicalLeg;
use super::certificate::proofs::{prove_by_box, prove_by_norm, prove_in_box};
use super::certificate::{canonical, has_free_roll};
use super::legs::certify;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::tables::CertifiedLeg;
use super::tour_bound::tour_bound;
use super::{Run, named_pairs, tour_pairs};
use crate::model::scenario::Scenario;
use crate::tour::order::Place;
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// Number of targets up to which all tours are bounded.
const MAX_TARGETS: usize = 20;

/// Lower bounds on legs and tours of a scenario.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StrongestBounds {
    /// On any slew between two places; `None` where nothing is proved.
    pub legs: Vec<Option<StrongestBound>>,
    /// On any tour in any order; `None` where no leg is bounded, and with more than twenty targets.
    pub tour: Option<StrongestBound>,
}

/// A lower bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrongestBound {
    /// The bound, s.
    pub bound_s: f64,
    /// Whether it is proved a second time, in intervals.
    pub is_confirmed: bool,
}

/// The largest bounds that are proved for some legs, by the names of their ends, and for all tours.
#[must_use]
pub fn strongest_bounds(
    scenario: &Scenario,
    legs: &[(String, String)],
    run: Run<'_>,
) -> StrongestBounds {
    let places = Places::of(scenario);
    let names = legs.iter().map(|(from, to)| [from.as_str(), to.as_str()]);
    let legs = named_pairs(&places, &tour_pairs(&places), names);
    strongest_between(&places, &legs, run)
}

/// The same between places; `None` where no tour has such a leg.
pub(super) fn strongest_between(
    places: &Places<'_>,
    legs: &[Option<(Place, Place)>],
    run: Run<'_>,
) -> StrongestBounds {
    let known = BoundsByForm::default();
    // Forms of legs whose bounds are proved once.
    let once: Mutex<BTreeSet<String>> = Mutex::default();
    let lock = || once.lock().unwrap_or_else(PoisonError::into_inner);
    let form = |pair: &Option<(Place, Place)>| Some(canonical(places, (*pair)?));
    let prove = |pairs: &[Option<(Place, Place)>]| {
        let bound = |index: usize, leg: &CanonicalLeg| {
            let pair = pairs[index].filter(|_| !run.stop.is_set())?;
            let (bound, is_confirmed) = strongest(places, pair, leg);
            if !is_confirmed {
                lock().insert(leg.key().to_owned());
            }
            Some(bound)
        };
        let forms: Vec<_> = pairs.iter().map(form).collect();
        known.of(&forms, run.pool, |_| (), bound)
    };
    let proved = prove(legs);
    let between =
        |pairs: &[(Place, Place)]| prove(&pairs.iter().copied().map(Some).collect::<Vec<_>>());
    let bounds = ProvedLegs::new(places, Box::new(between));
    let few = places.scenario.targets().len() <= MAX_TARGETS;
    let tour_s = few.then(|| tour_bound(places, &bounds, run.pool, run.stop));
    let tour_s = tour_s.flatten().filter(|_| !run.stop.is_set());
    let is_confirmed = |pair| form(pair).is_some_and(|leg| !lock().contains(leg.key()));
    StrongestBounds {
        legs: legs
            .iter()
            .zip(proved)
            .map(|(pair, leg)| {
                Some(StrongestBound {
                    bound_s: leg?.lower_bound?,
                    is_confirmed: is_confirmed(pair),
                })
            })
            .collect(),
        tour: tour_s.map(|bound_s| StrongestBound {
            bound_s,
            is_confirmed: lock().is_empty(),
        }),
    }
}

/// The largest bound on a leg that is proved, and whether that is confirmed.
fn strongest(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
) -> (CertifiedLeg, bool) {
    let boxed = certify(places, leg);
    let Some(once_s) = boxed.lower_bound else {
        return (boxed, true);
    };
    let with = |bound_s| CertifiedLeg {
        lower_bound: Some(bound_s),
        ..boxed
    };
    if places.dynamics.has_momentum() || has_free_roll(places.scenario, pair) {
        let beyond = places.certified.beyond(&leg.from, &leg.to, once_s);
        return (with(beyond.map_or(once_s, |beyond| beyond.bound_s)), false);
    }
    let confirmed_s = prove_by_box(places, pair, leg, None).ok();
    let known_s = confirmed_s.unwrap_or(once_s);
    let norm = prove_by_norm(places, pair, leg, known_s);
    let (bound, certificate) = match &norm {
        Some((bound, certificate)) => (*bound, certificate.as_ref()),
        None => {
            let is_confirmed = confirmed_s.is_some();
            (
                StrongestBound {
                    bound_s: known_s,
                    is_confirmed,
                },
                None,
            )
        }
    };
    match prove_in_box(places, pair, leg, bound.bound_s, certificate) {
        Some(in_box_s) => (with(in_box_s), true),
        None => (with(bound.bound_s), bound.is_confirmed),
    }
}
