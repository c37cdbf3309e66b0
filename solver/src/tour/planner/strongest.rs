//! The largest lower bounds that are proved, for a plan that is there.
//!
//! The bounds that steer the search come from boxes of rates, in some 30 microseconds a leg, and are proved a
//! second time by `certify`. Norms whose unit balls are polytopes prove more of legs of arrays, with unequal
//! ramps, and between targets that stop some components only (`bounds::certified`), in milliseconds.
//! Momentum and free rolls have bounds by boxes alone.

use super::bounds_by_form::BoundsByForm;
use super::canonical::CanonicalLeg;
use super::certificate::canonical;
use super::legs::certify;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::tables::CertifiedLeg;
use super::tour_bound::tour_bound;
use super::{Run, named_pairs, tour_pairs};
use crate::model::scenario::Scenario;
use crate::tour::order::Place;

/// Number of targets up to which all tours are bounded.
const MAX_TARGETS: usize = 20;

/// Lower bounds on legs and tours of a scenario.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StrongestBounds {
    /// On any slew between two places, s; `None` where nothing is proved.
    pub legs: Vec<Option<f64>>,
    /// On any tour in any order, s; `None` where no leg is bounded, and with more than twenty targets.
    pub tour_s: Option<f64>,
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
    let prove = |pairs: &[Option<(Place, Place)>]| {
        let forms = pairs.iter().map(|pair| Some(canonical(places, (*pair)?)));
        let bound = |_, leg: &CanonicalLeg| (!run.stop.is_set()).then(|| strongest(places, leg));
        known.of(&forms.collect::<Vec<_>>(), run.pool, |_| (), bound)
    };
    let proved = prove(legs).into_iter();
    let between =
        |pairs: &[(Place, Place)]| prove(&pairs.iter().copied().map(Some).collect::<Vec<_>>());
    let bounds = ProvedLegs::new(places, Box::new(between));
    let few = places.scenario.targets().len() <= MAX_TARGETS;
    let tour_s = few.then(|| tour_bound(places, &bounds, run.pool, run.stop));
    StrongestBounds {
        legs: proved.map(|leg| leg?.lower_bound).collect(),
        tour_s: tour_s.flatten().filter(|_| !run.stop.is_set()),
    }
}

/// The largest bound on a leg that is proved.
fn strongest(places: &Places<'_>, leg: &CanonicalLeg) -> CertifiedLeg {
    let boxed = certify(places, leg);
    let beyond = |known_s| places.certified.beyond(&leg.from, &leg.to, known_s);
    CertifiedLeg {
        lower_bound: boxed.lower_bound.and_then(beyond).or(boxed.lower_bound),
        ..boxed
    }
}
