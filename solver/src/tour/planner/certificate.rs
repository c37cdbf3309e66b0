//! The certified bounds of a plan, proved a second time.
//!
//! What a plan claims is of unknown origin here. For every claim about a leg the certificate is made
//! anew from the scenario (boxes, turn, and what is known of the ends; nothing of the flight), the
//! claimed duration is put in, and [`crate::bounds::certify`] proves it or says why not. A claim about all
//! tours rests on every leg that a tour may fly: the bounds of these are proved in the same way,
//! legs whose proof fails count nothing, and the shortest way through the table is what may be
//! claimed at most.
//!
//! What a certificate takes for granted (boxes, turn, ends) is compared with the scenario's own words,
//! by other ways than those it was made by (`premises`). Computed in ordinary arithmetic and not proved
//! a second time is the search of the shortest way.

mod premises;

use super::Run;
use super::canonical::CanonicalLeg;
use super::places::Places;
use super::tables::{CertifiedLeg, CertifiedTable, Table};
use super::tour_bound::tour_bound;
use super::tour_pairs;
use crate::bounds::certify::{self, Rejection};
use crate::model::scenario::Scenario;
use crate::run::progress::{Progress, Stage};
use crate::tour::order::Place;
use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicU64, Ordering};

/// What a plan claims to be proved.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlanCertificate {
    /// Its legs.
    pub legs: Vec<LegCertificate>,
    /// No tour takes less, s, in any order that the scenario admits; `None` where nothing is claimed.
    pub lower_bound_s: Option<f64>,
    /// How long the plan takes, s, when it says so.
    pub total_time_s: Option<f64>,
}

/// What a plan claims of a leg.
#[derive(Debug, Clone, PartialEq)]
pub struct LegCertificate {
    /// `start` or a target's identifier.
    pub from: String,
    /// A target's identifier or `end`.
    pub to: String,
    /// No slew between the places takes less, s; `None` where nothing is claimed.
    pub lower_bound_s: Option<f64>,
    /// How long the leg takes, s, when the plan says so.
    pub duration_s: Option<f64>,
}

/// What became of a claim.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// There is none.
    NoBound,
    /// It is proved.
    Confirmed,
    /// It is wrong, or no proof was found.
    Rejected(Objection),
    /// It may be right or wrong.
    NotChecked(Obstacle),
}

/// Why a claim is rejected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Objection {
    /// The plan contradicts itself.
    #[error("the plan itself takes {duration_s} s only")]
    AboveDuration {
        /// How long it takes there, s.
        duration_s: f64,
    },
    /// No tour flies such a leg.
    #[error("no tour of the scenario has such a leg")]
    NoSuchLeg,
    /// The scenario leaves rates or accelerations without limits.
    #[error("nothing is proved of such slews: their rates are not limited")]
    UnlimitedRates,
    /// What a proof rests on is not what the scenario says.
    #[error("a proof would take for granted {what}, which the scenario does not support")]
    Premises {
        /// What it is.
        what: &'static str,
    },
    /// The second proof failed.
    #[error("{known_s} s is the bound that is known of such slews: {rejection}")]
    NotProved {
        /// The bound that the solver itself would claim, s.
        known_s: f64,
        /// What the second proof says.
        rejection: Rejection,
    },
    /// The legs do not add up to it.
    #[error("the proved bounds of {proved} of {legs} legs add up to {supported_s} s at least")]
    AboveTourBound {
        /// The shortest way through all targets in the table of proved bounds, s.
        supported_s: f64,
        /// Legs with a proved bound.
        proved: usize,
        /// Legs that a tour may fly.
        legs: usize,
    },
}

/// Why a claim is not checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Obstacle {
    /// There is no second proof of bounds on slews with stored momentum.
    #[error("there is no second proof of bounds with stored momentum")]
    Momentum,
    /// The work was stopped before.
    #[error("stopped before it was checked")]
    Stopped,
}

/// What became of the claims of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedCertificate {
    /// Of its legs, in the order of the claims.
    pub legs: Vec<Verdict>,
    /// Of all tours.
    pub tour: Verdict,
}

impl CheckedCertificate {
    /// Whether something is claimed and all of it is proved.
    #[must_use]
    pub fn confirmed(&self) -> bool {
        let claims = || self.legs.iter().chain([&self.tour]);
        let fine = |claim: &Verdict| matches!(claim, Verdict::Confirmed | Verdict::NoBound);
        claims().all(fine) && claims().any(|claim| *claim == Verdict::Confirmed)
    }
}

/// Proves what a plan claims of its legs and of all tours a second time, in intervals.
///
/// Takes some 10 ms for every claimed leg, and as much for every distinct leg that a tour may fly
/// when something is claimed of tours, divided among the workers. The store of legs is not asked.
#[must_use]
pub fn verify_certificate(
    scenario: &Scenario,
    certificate: &PlanCertificate,
    run: Run<'_>,
) -> CheckedCertificate {
    let places = Places::of(scenario);
    let pairs = tour_pairs(&places);
    let distinct = match certificate.lower_bound_s {
        Some(_) if !places.dynamics.has_momentum() => DistinctLegs::of(&places, &pairs),
        _ => DistinctLegs::default(),
    };
    let verifier = CertificateVerifier {
        places: &places,
        named: places
            .all()
            .into_iter()
            .map(|p| (places.name(p), p))
            .collect(),
        flown: pairs.iter().copied().collect(),
        run,
        done: AtomicU64::new(0),
        total: (certificate.legs.len() + distinct.legs.len()) as u64,
    };
    let legs = run.pool.map(&certificate.legs, |claim| {
        let verdict = verifier.verify_leg(claim);
        verifier.report_progress();
        verdict
    });
    let tour = verifier.verify_tour_bound(certificate, &pairs, &distinct);
    CheckedCertificate { legs, tour }
}

/// The legs between pairs of places, equal ones once.
#[derive(Default)]
struct DistinctLegs {
    legs: Vec<((Place, Place), CanonicalLeg)>,
    /// Which of them each pair is.
    of_pair: Vec<usize>,
}

impl DistinctLegs {
    fn of(places: &Places<'_>, pairs: &[(Place, Place)]) -> Self {
        let (mut distinct, mut known) = (Self::default(), HashMap::new());
        for pair in pairs {
            let leg = canonical(places, *pair);
            let next = distinct.legs.len();
            let index = *known.entry(leg.identity.clone()).or_insert(next);
            distinct.of_pair.push(index);
            if index == next {
                distinct.legs.push((*pair, leg));
            }
        }
        distinct
    }
}

/// Proves claims about the legs and tours of a scenario.
struct CertificateVerifier<'a> {
    places: &'a Places<'a>,
    named: HashMap<String, Place>,
    /// The legs that a tour may fly.
    flown: HashSet<(Place, Place)>,
    run: Run<'a>,
    done: AtomicU64,
    total: u64,
}

impl CertificateVerifier<'_> {
    fn verify_leg(&self, claim: &LegCertificate) -> Verdict {
        let Some(bound) = claim.lower_bound_s else {
            return Verdict::NoBound;
        };
        let ends = self.named.get(&claim.from).zip(self.named.get(&claim.to));
        let Some(pair) = ends
            .map(|(from, to)| (*from, *to))
            .filter(|pair| self.flown.contains(pair))
        else {
            return Verdict::Rejected(Objection::NoSuchLeg);
        };
        if let Some(early) = self.early_verdict(bound, claim.duration_s) {
            return early;
        }
        match self.prove_leg(pair, &canonical(self.places, pair), Some(bound)) {
            Ok(_) => Verdict::Confirmed,
            Err(objection) => Verdict::Rejected(objection),
        }
    }

    fn verify_tour_bound(
        &self,
        certificate: &PlanCertificate,
        pairs: &[(Place, Place)],
        distinct: &DistinctLegs,
    ) -> Verdict {
        let Some(bound) = certificate.lower_bound_s else {
            return Verdict::NoBound;
        };
        if let Some(early) = self.early_verdict(bound, certificate.total_time_s) {
            return early;
        }
        let bounds = self.run.pool.map(&distinct.legs, |(pair, leg)| {
            let bound = (!self.run.stop.is_set()).then(|| self.prove_leg(*pair, leg, None).ok());
            self.report_progress();
            bound.flatten()
        });
        let entry = |index: &usize| CertifiedLeg {
            lower_bound: bounds[*index],
            solve_time: 0.0,
        };
        let entries = pairs.iter().zip(&distinct.of_pair);
        let table: CertifiedTable = Table::new(
            self.places,
            entries.map(|(pair, index)| (*pair, Some(entry(index)))),
        );
        let supported_s = tour_bound(self.places, &table, self.run.pool, self.run.stop);
        if self.run.stop.is_set() {
            return Verdict::NotChecked(Obstacle::Stopped);
        }
        let Some(supported_s) = supported_s else {
            return Verdict::Rejected(Objection::UnlimitedRates);
        };
        if bound <= supported_s {
            return Verdict::Confirmed;
        }
        let proved = distinct.of_pair.iter().filter(|i| bounds[**i].is_some());
        Verdict::Rejected(Objection::AboveTourBound {
            supported_s,
            proved: proved.count(),
            legs: pairs.len(),
        })
    }

    /// The verdict on a bound, s, that can be told before anything is proved: what has this
    /// duration, s, is in the plan.
    fn early_verdict(&self, bound: f64, duration_s: Option<f64>) -> Option<Verdict> {
        if let Some(duration_s) = duration_s.filter(|duration| bound > *duration) {
            return Some(Verdict::Rejected(Objection::AboveDuration { duration_s }));
        }
        if self.places.dynamics.has_momentum() {
            return Some(Verdict::NotChecked(Obstacle::Momentum));
        }
        let stopped = self.run.stop.is_set();
        stopped.then_some(Verdict::NotChecked(Obstacle::Stopped))
    }

    /// A bound on the leg between two places that has been proved, s: the given one, or that of the
    /// solver.
    fn prove_leg(
        &self,
        (from, to): (Place, Place),
        leg: &CanonicalLeg,
        bound: Option<f64>,
    ) -> Result<f64, Objection> {
        let certificate = self.places.certified.certificate(&leg.from, &leg.to);
        let (axes, mut certificate) = certificate.ok_or(Objection::UnlimitedRates)?;
        let flown = if leg.mirrored { [to, from] } else { [from, to] };
        premises::check(self.places.scenario, flown, &axes, &certificate)
            .map_err(|what| Objection::Premises { what })?;
        let known_s = certificate.duration_s;
        certificate.duration_s = bound.unwrap_or(known_s);
        match certify::verify(&certificate) {
            Ok(()) => Ok(certificate.duration_s),
            Err(rejection) => Err(Objection::NotProved { known_s, rejection }),
        }
    }

    fn report_progress(&self) {
        self.run.observer.progress(Progress {
            stage: Stage::Legs,
            done: self.done.fetch_add(1, Ordering::Relaxed) + 1,
            total: Some(self.total),
            incumbent_s: None,
            lower_bound_s: None,
        });
    }
}

/// A leg in the form in which it is certified, each end with its own conditions only.
fn canonical(places: &Places<'_>, (from, to): (Place, Place)) -> CanonicalLeg {
    CanonicalLeg::of(places, &places.waypoint(from), &places.waypoint(to))
}
