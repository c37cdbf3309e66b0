//! Verification of the certified bounds of a plan.
//!
//! The bounds of a plan may come from anywhere. For the bound of a leg, a leg certificate is made
//! from the scenario (box, turn and end rates; nothing of the flight), the plan's bound is put into
//! it, and [`crate::bounds::certify`] proves it in interval arithmetic or says why it cannot. The
//! bound on all tours rests on every leg that can be part of a tour: their bounds are verified in
//! the same way, legs that cannot be verified count as 0, and the plan's bound must not exceed the
//! shortest path through the table of these bounds. With many targets only those legs are verified on
//! which the bound depends ([`super::tour_bound`]); the others count with their turn at the largest
//! rate.
//!
//! The premises of a certificate (box, turn, end rates) are compared with the scenario by formulas
//! other than those that made them (`premises`). The search for the shortest path runs in ordinary
//! arithmetic and is not verified.

mod premises;
pub(super) mod proofs;

use super::Run;
use super::additive_tours::LegTimes;
use super::bounds_by_form::BoundsByForm;
use super::canonical::CanonicalLeg;
use super::places::Places;
use super::proved_legs::ProvedLegs;
use super::strongest::{ProofEffort, StrongestBounds, strongest_between};
use super::tables::CertifiedLeg;
use super::tour_bound::tour_bound;
use super::{named_pairs, tour_pairs};
use crate::bounds::certify::Rejection;
use crate::model::scenario::Scenario;
use crate::run::progress::{Progress, Stage};
use crate::tour::order::Place;
use proofs::prove_by_box;
use std::sync::atomic::{AtomicU64, Ordering};

/// The certified bounds of a plan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlanCertificate {
    /// The bounds of its legs.
    pub legs: Vec<LegCertificate>,
    /// Lower bound on all tours, s, in any order that the scenario admits; `None` when the plan
    /// gives none.
    pub lower_bound_s: Option<f64>,
    /// Duration of the plan, s, when it is given.
    pub total_time_s: Option<f64>,
}

/// The certified bound of a leg of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct LegCertificate {
    /// `start` or a target's identifier.
    pub from: String,
    /// A target's identifier or `end`.
    pub to: String,
    /// Lower bound on any slew between the places, s; `None` when the plan gives none.
    pub lower_bound_s: Option<f64>,
    /// Duration of the leg in the plan, s, when it is given.
    pub duration_s: Option<f64>,
}

/// Result of the verification of a bound.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// The plan gives no bound.
    NoBound,
    /// The bound is proved.
    Confirmed,
    /// The bound is false, or no proof was found.
    Rejected(Objection),
    /// The bound was not checked.
    NotChecked(Obstacle),
}

/// Why a bound is rejected.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Objection {
    /// The bound exceeds the duration in the plan itself.
    #[error("the plan itself takes {duration_s} s only")]
    AboveDuration {
        /// Duration in the plan, s.
        duration_s: f64,
    },
    /// No tour contains such a leg.
    #[error("no tour of the scenario has such a leg")]
    NoSuchLeg,
    /// The scenario leaves rates or accelerations without limits.
    #[error("nothing is proved of such slews: their rates are not limited")]
    UnlimitedRates,
    /// A premise of the leg's certificate does not follow from the scenario.
    #[error("a proof would rest on {what}, which the scenario does not support")]
    Premises {
        /// The premise.
        what: &'static str,
    },
    /// The interval arithmetic does not prove the bound.
    #[error("the solver's own bound for such slews is {known_s} s: {rejection}")]
    NotProved {
        /// The bound that the solver itself computes, s.
        known_s: f64,
        /// Why the proof failed.
        rejection: Rejection,
    },
    /// The bound exceeds the shortest path through the proved bounds of the legs.
    #[error("the proved bounds of {proved} of {legs} legs add up to {supported_s} s at least")]
    AboveTourBound {
        /// Shortest path through all targets in the table of proved bounds, s.
        supported_s: f64,
        /// Number of legs with a proved bound.
        proved: usize,
        /// Number of legs that can be part of a tour.
        legs: usize,
    },
}

/// Why a bound is not checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Obstacle {
    /// Bounds on slews whose roll is free at an end cannot be verified.
    #[error("there is no second proof of bounds where the roll is free")]
    FreeRoll,
    /// The work was stopped first.
    #[error("stopped before it was checked")]
    Stopped,
}

/// Verdicts on the bounds of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedCertificate {
    /// On the bounds of its legs, in the order of the certificate.
    pub legs: Vec<Verdict>,
    /// On the bound on all tours.
    pub tour: Verdict,
    /// The largest bounds that are known to hold for the same legs and for all tours.
    pub strongest: StrongestBounds,
}

impl CheckedCertificate {
    /// Whether the plan gives at least one bound and all its bounds are proved.
    #[must_use]
    pub fn confirmed(&self) -> bool {
        let verdicts = || self.legs.iter().chain([&self.tour]);
        let fine = |verdict: &Verdict| matches!(verdict, Verdict::Confirmed | Verdict::NoBound);
        verdicts().all(fine) && verdicts().any(|verdict| *verdict == Verdict::Confirmed)
    }
}

/// Verifies the certified bounds of a plan in interval arithmetic.
///
/// Takes some 10 ms for every leg with a bound and, if there is a bound on all tours, as much for
/// every distinct leg that can be part of a tour, divided among the workers; some 50 ms more for each whose
/// strongest bound comes from a norm, and seconds with many wheels. The strongest bounds of the plan's legs and of
/// those of the shortest tour take up to ten seconds each. The leg store is not used.
#[must_use]
pub fn verify_certificate(
    scenario: &Scenario,
    certificate: &PlanCertificate,
    run: Run<'_>,
) -> CheckedCertificate {
    let places = Places::of(scenario);
    let pairs = tour_pairs(&places);
    let names = certificate.legs.iter();
    let names = names.map(|leg| [leg.from.as_str(), leg.to.as_str()]);
    let between = named_pairs(&places, &pairs, names);
    let verifier = CertificateVerifier {
        places: &places,
        run,
        done: AtomicU64::new(0),
        total: AtomicU64::new(certificate.legs.len() as u64),
        known: BoundsByForm::default(),
    };
    let claims: Vec<_> = certificate.legs.iter().zip(&between).collect();
    let legs = run.pool.map(&claims, |(leg, pair)| {
        let verdict = verifier.verify_leg(leg, **pair);
        verifier.report_progress();
        verdict
    });
    CheckedCertificate {
        legs,
        tour: verifier.verify_tour_bound(certificate, &pairs),
        strongest: strongest_between(&places, &between, ProofEffort::Confirmed, run),
    }
}

/// Verifies bounds on the legs and tours of a scenario.
struct CertificateVerifier<'a> {
    places: &'a Places<'a>,
    run: Run<'a>,
    /// Number of proofs attempted.
    done: AtomicU64,
    /// Number of proofs asked for so far.
    total: AtomicU64,
    /// Bounds that are proved; of a leg without one the proof failed.
    known: BoundsByForm,
}

impl CertificateVerifier<'_> {
    /// The verdict on the bound of a leg between two places; `None` for them where no tour has it.
    fn verify_leg(&self, leg: &LegCertificate, pair: Option<(Place, Place)>) -> Verdict {
        let Some(bound) = leg.lower_bound_s else {
            return Verdict::NoBound;
        };
        let Some(pair) = pair else {
            return Verdict::Rejected(Objection::NoSuchLeg);
        };
        if let Some(early) = self.early_verdict(bound, leg.duration_s) {
            return early;
        }
        if has_free_roll(self.places.scenario, pair) {
            return Verdict::NotChecked(Obstacle::FreeRoll);
        }
        match prove_by_box(
            self.places,
            pair,
            &canonical(self.places, pair),
            Some(bound),
        ) {
            Ok(_) => Verdict::Confirmed,
            Err(objection) => Verdict::Rejected(objection),
        }
    }

    fn verify_tour_bound(
        &self,
        certificate: &PlanCertificate,
        pairs: &[(Place, Place)],
    ) -> Verdict {
        let Some(bound) = certificate.lower_bound_s else {
            return Verdict::NoBound;
        };
        if let Some(early) = self.early_verdict(bound, certificate.total_time_s) {
            return early;
        }
        if pairs
            .iter()
            .any(|pair| has_free_roll(self.places.scenario, *pair))
        {
            return Verdict::NotChecked(Obstacle::FreeRoll);
        }
        let bounds = ProvedLegs::new(self.places, Box::new(|pairs| self.prove_legs(pairs)));
        if self.places.needs_all_legs() {
            bounds.raise(pairs);
        }
        let supported_s = tour_bound(self.places, &bounds, self.run.pool, self.run.stop);
        if self.run.stop.is_set() {
            return Verdict::NotChecked(Obstacle::Stopped);
        }
        let Some(supported_s) = supported_s else {
            return Verdict::Rejected(Objection::UnlimitedRates);
        };
        if bound <= supported_s {
            return Verdict::Confirmed;
        }
        let proved = pairs.iter().filter(|(a, b)| bounds.bound(*a, *b).is_some());
        Verdict::Rejected(Objection::AboveTourBound {
            supported_s,
            proved: proved.count(),
            legs: pairs.len(),
        })
    }

    /// Proves the bounds of the legs between pairs of places; legs with equal canonical forms once.
    fn prove_legs(&self, pairs: &[(Place, Place)]) -> Vec<Option<CertifiedLeg>> {
        let forms = pairs.iter().map(|pair| Some(canonical(self.places, *pair)));
        let begin = |missing: usize| _ = self.total.fetch_add(missing as u64, Ordering::Relaxed);
        let bound = |index: usize, leg: &CanonicalLeg| {
            let proved = (!self.run.stop.is_set()).then(|| CertifiedLeg {
                lower_bound: prove_by_box(self.places, pairs[index], leg, None).ok(),
                solve_time: 0.0,
            });
            self.report_progress();
            proved
        };
        self.known
            .of(&forms.collect::<Vec<_>>(), self.run.pool, begin, bound)
    }

    /// The verdict on a bound, s, where it needs no proof. `duration_s` is the duration in the plan
    /// of what the bound is for, s.
    fn early_verdict(&self, bound: f64, duration_s: Option<f64>) -> Option<Verdict> {
        if let Some(duration_s) = duration_s.filter(|duration| bound > *duration) {
            return Some(Verdict::Rejected(Objection::AboveDuration { duration_s }));
        }
        let stopped = self.run.stop.is_set();
        stopped.then_some(Verdict::NotChecked(Obstacle::Stopped))
    }

    fn report_progress(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let total = self.total.load(Ordering::Relaxed);
        let progress = Progress::of_stage(Stage::Legs, done, Some(total));
        self.run.observer.progress(progress);
    }
}

/// Whether the roll is free at one of two places.
pub(super) fn has_free_roll(scenario: &Scenario, (from, to): (Place, Place)) -> bool {
    [from, to].into_iter().any(|place| match place {
        Place::Start => false,
        Place::Target(index) => scenario.targets()[index].roll.is_some(),
        Place::End => scenario.end().is_some_and(|end| end.roll.is_some()),
    })
}

/// The canonical leg between two places, each end with its own conditions only.
pub(super) fn canonical(places: &Places<'_>, (from, to): (Place, Place)) -> CanonicalLeg {
    CanonicalLeg::of(places, &places.waypoint(from), &places.waypoint(to))
}
