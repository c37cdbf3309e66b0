//! Bounds on legs, proved with outward rounding by certificates made from the scenario.

use super::{Objection, premises};
use crate::bounds::certified::NormBound;
use crate::bounds::certify::{self, Rejection};
use crate::bounds::kinematic::certificate::{Certificate, DriftCertificate};
use crate::bounds::polytope::certificate::NormCertificate;
use crate::bounds::reach::SlewsInBox;
use crate::tour::order::Place;
use crate::tour::planner::canonical::CanonicalLeg;
use crate::tour::planner::places::Places;
use crate::tour::planner::strongest::StrongestBound;

/// Proves a bound on the leg between two places by boxes of rates, s: the given one, or the one that the solver
/// computes. Returns the proved bound.
pub(in super::super) fn prove_by_box(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
    bound: Option<f64>,
) -> Result<f64, Objection> {
    let (certified, scenario, ends) = (&places.certified, places.scenario, ends(pair, leg));
    let supported = |checked: Result<(), _>| checked.map_err(|what| Objection::Premises { what });
    if places.dynamics.has_momentum() {
        let momentum = &leg.dynamics.momentum;
        let certificate = certified.drift_certificate(&leg.from, &leg.to, momentum);
        let certificate = certificate.ok_or(Objection::UnlimitedRates)?;
        supported(premises::check_drift(scenario, ends, &certificate))?;
        return proved(certificate.duration_s, bound, |duration_s| {
            certify::verify_drift(&DriftCertificate {
                duration_s,
                ..certificate
            })
        });
    }
    let certificate = certified.certificate(&leg.from, &leg.to);
    let (axes, certificate) = certificate.ok_or(Objection::UnlimitedRates)?;
    supported(premises::check(scenario, ends, &axes, &certificate))?;
    proved(certificate.duration_s, bound, |duration_s| {
        certify::verify(&Certificate {
            duration_s,
            ..certificate
        })
    })
}

/// The bound that is asked for, s, else the one that the solver computes, if its verification succeeds.
fn proved(
    known_s: f64,
    asked_s: Option<f64>,
    verify: impl FnOnce(f64) -> Result<(), Rejection>,
) -> Result<f64, Objection> {
    let bound_s = asked_s.unwrap_or(known_s);
    match verify(bound_s) {
        Ok(()) => Ok(bound_s),
        Err(rejection) => Err(Objection::NotProved { known_s, rejection }),
    }
}

/// The largest bound by a norm, if it exceeds one that is known, s; with its proof in intervals where it has a
/// certificate. `None` too where this proof fails.
pub(in super::super) fn prove_by_norm(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
    known_s: f64,
) -> Option<(StrongestBound, Option<NormCertificate>)> {
    let beyond = beyond(places, leg, known_s)?;
    let is_confirmed = match &beyond.certificate {
        None => false,
        Some(certificate) => {
            premises::check_norm(places.scenario, ends(pair, leg), certificate).ok()?;
            certify::verify_norm(certificate).ok()?;
            true
        }
    };
    let bound = StrongestBound {
        bound_s: beyond.bound_s,
        is_confirmed,
    };
    Some((bound, beyond.certificate))
}

/// The largest bound by a box of rates that changes in time, if it exceeds one that is known, s. A norm whose
/// certificate is confirmed makes the proof shorter.
pub(in super::super) fn prove_in_box(
    places: &Places<'_>,
    pair: (Place, Place),
    leg: &CanonicalLeg,
    known_s: f64,
    norm: Option<&NormCertificate>,
) -> Option<f64> {
    let (axes, certificate) = places.certified.certificate(&leg.from, &leg.to)?;
    premises::check(places.scenario, ends(pair, leg), &axes, &certificate).ok()?;
    certify::verify(&certificate).ok()?;
    let slews = SlewsInBox::of(&certificate)?;
    let slews = match norm {
        Some(norm) => slews.knowing(&axes, norm),
        None => slews,
    };
    slews.longest_excluded_s(known_s)
}

/// The largest bound by a norm, if it exceeds one that is known, s.
pub(in super::super) fn beyond(
    places: &Places<'_>,
    leg: &CanonicalLeg,
    known_s: f64,
) -> Option<NormBound> {
    let angle = leg.arrival.turn(&leg.from.attitude, &leg.to.attitude);
    let ends = [&leg.from, &leg.to];
    places.certified.beyond(ends, angle, known_s)
}

/// The places at begin and end of a canonical leg.
fn ends((from, to): (Place, Place), leg: &CanonicalLeg) -> [Place; 2] {
    if leg.mirrored { [to, from] } else { [from, to] }
}
