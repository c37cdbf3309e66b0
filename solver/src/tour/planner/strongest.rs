//! The largest lower bounds that are proved, for a plan that is there.
//!
//! The bounds that steer the search come from boxes of rates, in some 30 microseconds a leg, and are proved a
//! second time by `certify`. Norms whose unit balls are polytopes prove more of legs of arrays, with unequal
//! ramps, and between targets that stop some components only (`bounds::certified`), in milliseconds.
//! Momentum and free rolls have bounds by boxes alone.

use super::canonical::{CanonicalLeg, missing_from};
use super::certificate::canonical;
use super::legs::certify;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::tables::CertifiedLeg;
use super::tour_bound::tour_bound;
use super::{Run, tour_pairs};
use crate::model::scenario::Scenario;
use crate::tour::order::Place;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

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
    strongest_between(&Places::of(scenario), legs, run)
}

/// The same between the places of a scenario.
pub(super) fn strongest_between(
    places: &Places<'_>,
    legs: &[(String, String)],
    run: Run<'_>,
) -> StrongestBounds {
    let strongest = Strongest {
        places,
        run,
        known: Mutex::default(),
    };
    let named: HashMap<String, Place> = places
        .all()
        .into_iter()
        .map(|place| (places.name(place), place))
        .collect();
    let pairs = tour_pairs(places);
    let asked: Vec<Option<(Place, Place)>> = legs
        .iter()
        .map(|(from, to)| named.get(from).copied().zip(named.get(to).copied()))
        .map(|pair| pair.filter(|pair| pairs.contains(pair)))
        .collect();
    let known: Vec<_> = asked.iter().flatten().copied().collect();
    let mut proved = strongest.prove(&known).into_iter();
    let legs = asked.iter().map(|pair| {
        let leg = pair.and_then(|_| proved.next().flatten());
        leg.and_then(|leg| leg.lower_bound)
    });
    let legs = legs.collect();
    let bounds = ProvedLegs::new(places, Box::new(|pairs| strongest.prove(pairs)));
    let few = places.scenario.targets().len() <= MAX_TARGETS;
    let tour_s = few.then(|| tour_bound(places, &bounds, run.pool, run.stop));
    StrongestBounds {
        legs,
        tour_s: tour_s.flatten().filter(|_| !run.stop.is_set()),
    }
}

struct Strongest<'a> {
    places: &'a Places<'a>,
    run: Run<'a>,
    /// Bounds by [`CanonicalLeg::key`], s.
    known: Mutex<HashMap<String, Option<f64>>>,
}

impl Strongest<'_> {
    /// The bounds of the legs between pairs of places; legs with equal canonical forms once.
    fn prove(&self, pairs: &[(Place, Place)]) -> Vec<Option<CertifiedLeg>> {
        let forms = pairs.iter().map(|pair| Some(canonical(self.places, *pair)));
        let legs: Vec<Option<CanonicalLeg>> = forms.collect();
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = missing_from(&known(), &legs);
        let bounds = self.run.pool.map(&missing, |(_, leg)| {
            (!self.run.stop.is_set()).then(|| self.bound(leg))
        });
        let mut known = known();
        for ((_, leg), bound) in missing.into_iter().zip(bounds) {
            if let Some(bound) = bound {
                known.insert(leg.key().to_owned(), bound);
            }
        }
        let entry = |leg: &Option<CanonicalLeg>| {
            Some(CertifiedLeg {
                lower_bound: *known.get(leg.as_ref()?.key())?,
                solve_time: 0.0,
            })
        };
        legs.iter().map(entry).collect()
    }

    fn bound(&self, leg: &CanonicalLeg) -> Option<f64> {
        let boxed = certify(self.places, leg).lower_bound?;
        let beyond = self.places.certified.beyond(&leg.from, &leg.to, boxed);
        Some(beyond.unwrap_or(boxed))
    }
}
