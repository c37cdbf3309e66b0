//! The largest lower bounds that are proved, for a plan that is there.
//!
//! The bounds that steer the search come from boxes of rates, in some 30 microseconds a leg. Norms whose unit balls
//! are polytopes prove more of legs of arrays, with unequal ramps, and between targets that stop some components only
//! (`bounds::certified`). Both are proved a second time in intervals, and what is not confirmed does not count. Bounds
//! with a free roll and by a limit of the norm of the rate are proved once.
//!
//! Boxes that change in time (`bounds::reach`) prove most, in seconds a leg. They are used for the legs that are asked
//! for, and for the bound on all tours for those of the shortest tour, again and again until it has no other legs.

use super::bounds_by_form::BoundsByForm;
use super::canonical::CanonicalLeg;
use super::certificate::proofs::{beyond, prove_by_box, prove_by_norm, prove_in_box};
use super::certificate::{canonical, has_free_roll};
use super::legs::certify;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::tables::CertifiedLeg;
use super::tour_bound::shortest;
use super::{Run, named_pairs, tour_pairs};
use crate::bounds::polytope::certificate::NormCertificate;
use crate::model::scenario::Scenario;
use crate::tour::order::Place;
use std::collections::{BTreeSet, HashSet};
use std::sync::{Mutex, PoisonError};

/// Number of targets up to which all tours are bounded.
const MAX_TARGETS: usize = 20;
/// Number of shortest tours whose legs are bounded by boxes that change in time.
const MAX_ROUNDS: usize = 30;

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
    /// Whether it is proved with outward rounding: a second time, in intervals, or by a box that changes in time.
    pub is_confirmed: bool,
}

/// How much is done for a bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProofEffort {
    /// Boxes and norms, proved once: some milliseconds a leg.
    Once,
    /// All bounds, confirmed: seconds a leg.
    Confirmed,
}

/// The largest bounds that are proved for some legs, by the names of their ends, and for all tours.
#[must_use]
pub fn strongest_bounds(
    scenario: &Scenario,
    legs: &[(String, String)],
    effort: ProofEffort,
    run: Run<'_>,
) -> StrongestBounds {
    let places = Places::of(scenario);
    let names = legs.iter().map(|(from, to)| [from.as_str(), to.as_str()]);
    let legs = named_pairs(&places, &tour_pairs(&places), names);
    strongest_between(&places, &legs, effort, run)
}

/// The same between places; `None` where no tour has such a leg.
pub(super) fn strongest_between(
    places: &Places<'_>,
    legs: &[Option<(Place, Place)>],
    effort: ProofEffort,
    run: Run<'_>,
) -> StrongestBounds {
    let (by_norm, strongest): (Proof, Proof) = match effort {
        ProofEffort::Once => (once_proved, once_proved),
        ProofEffort::Confirmed => (by_norm, strongest),
    };
    // Forms of legs whose bounds are proved once.
    let once: Mutex<BTreeSet<String>> = Mutex::default();
    let lock = || once.lock().unwrap_or_else(PoisonError::into_inner);
    let form = |pair: &Option<(Place, Place)>| Some(canonical(places, (*pair)?));
    let prove = |known: &BoundsByForm, pairs: &[Option<(Place, Place)>], by: Proof| {
        let bound = |index: usize, leg: &CanonicalLeg| {
            let pair = pairs[index].filter(|_| !run.stop.is_set())?;
            let (bound, is_confirmed) = by(places, pair, leg);
            if is_confirmed {
                lock().remove(leg.key());
            } else {
                lock().insert(leg.key().to_owned());
            }
            Some(bound)
        };
        let forms: Vec<_> = pairs.iter().map(form).collect();
        known.of(&forms, run.pool, |_| (), bound)
    };
    let some = |pairs: &[(Place, Place)]| pairs.iter().copied().map(Some).collect::<Vec<_>>();
    let (by_norms, all) = (BoundsByForm::default(), BoundsByForm::default());
    let proved = prove(&all, legs, strongest);
    let between = |pairs: &[(Place, Place)]| prove(&by_norms, &some(pairs), by_norm);
    let bounds = ProvedLegs::new(places, Box::new(between));
    let few = places.scenario.targets().len() <= MAX_TARGETS;
    let mut tour_s = None;
    let mut raised = HashSet::new();
    for _ in 0..MAX_ROUNDS {
        let found = few.then(|| shortest(places, &bounds, run.pool, run.stop));
        let Some((bound_s, order)) = found.flatten() else {
            break;
        };
        // A stopped search knows little: the bound before it stays.
        if run.stop.is_set() {
            break;
        }
        tour_s = Some(bound_s);
        let route = order.map_or_else(Vec::new, |order| places.route(&order, true));
        let on_it = route.windows(2).map(|leg| (leg[0], leg[1]));
        let fresh: Vec<_> = on_it.filter(|leg| raised.insert(*leg)).collect();
        if fresh.is_empty() || effort == ProofEffort::Once {
            break;
        }
        bounds.replace(&fresh, prove(&all, &some(&fresh), strongest));
    }
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

/// Proves a bound on a leg, and tells whether it is confirmed.
type Proof = fn(&Places<'_>, (Place, Place), &CanonicalLeg) -> (CertifiedLeg, bool);

/// The largest bound on a leg by boxes and norms, not confirmed.
fn once_proved(places: &Places<'_>, _: (Place, Place), leg: &CanonicalLeg) -> (CertifiedLeg, bool) {
    let boxed = certify(places, leg);
    let Some(known_s) = boxed.lower_bound else {
        return (boxed, true);
    };
    let beyond = beyond(places, leg, known_s);
    let bound_s = beyond.map_or(known_s, |beyond| beyond.bound_s);
    let bound = CertifiedLeg {
        lower_bound: Some(bound_s),
        ..boxed
    };
    (bound, false)
}

/// The largest bound on a leg by boxes and norms.
fn by_norm(places: &Places<'_>, pair: (Place, Place), leg: &CanonicalLeg) -> (CertifiedLeg, bool) {
    let (bound, is_confirmed, _) = with_norm(places, pair, leg);
    (bound, is_confirmed)
}

/// The largest bound on a leg that is proved.
fn strongest(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
) -> (CertifiedLeg, bool) {
    let (bound, is_confirmed, norm) = with_norm(places, pair, leg);
    if places.dynamics.has_momentum() || has_free_roll(places.scenario, pair) {
        return (bound, is_confirmed);
    }
    let known_s = bound.lower_bound;
    let in_box_s =
        known_s.and_then(|known_s| prove_in_box(places, pair, leg, known_s, norm.as_ref()));
    match in_box_s {
        Some(_) => (
            CertifiedLeg {
                lower_bound: in_box_s,
                ..bound
            },
            true,
        ),
        None => (bound, is_confirmed),
    }
}

/// The largest bound on a leg by boxes and norms, whether it is confirmed, and the certificate of the norm that is.
fn with_norm(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
) -> (CertifiedLeg, bool, Option<NormCertificate>) {
    if has_free_roll(places.scenario, pair) {
        let (bound, is_confirmed) = once_proved(places, pair, leg);
        return (bound, is_confirmed, None);
    }
    let boxed = certify(places, leg);
    let Some(once_s) = boxed.lower_bound else {
        return (boxed, true, None);
    };
    let with = |bound_s| CertifiedLeg {
        lower_bound: Some(bound_s),
        ..boxed
    };
    let confirmed_s = prove_by_box(places, pair, leg, None).ok();
    let known_s = confirmed_s.unwrap_or(once_s);
    match prove_by_norm(places, pair, leg, known_s) {
        Some((beyond, norm)) => (with(beyond.bound_s), beyond.is_confirmed, norm),
        None => (with(known_s), confirmed_s.is_some(), None),
    }
}
