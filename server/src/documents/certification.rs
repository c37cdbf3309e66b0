//! The answer of `certify`.

use super::number::Number;
use serde::Serialize;
use slewplan_solver::tour::planner::{
    CheckedCertificate, PlanCertificate, StrongestBound, Verdict,
};

/// What became of the claims of a plan.
#[derive(Debug, Serialize)]
pub(crate) struct CertificationDocument<'a> {
    /// Whether something is claimed and all of it is proved.
    confirmed: bool,
    legs: Vec<LegDocument<'a>>,
    /// The claim about all tours.
    tour: ClaimDocument,
}

#[derive(Debug, Serialize)]
struct LegDocument<'a> {
    from: &'a str,
    to: &'a str,
    #[serde(flatten)]
    claim: ClaimDocument,
}

#[derive(Debug, Serialize)]
struct ClaimDocument {
    certified_lower_bound_s: Option<Number>,
    /// The largest lower bound that is known to hold, s.
    strongest_lower_bound_s: Option<Number>,
    /// Whether that is proved with outward rounding.
    strongest_confirmed: Option<bool>,
    verdict: &'static str,
    reason: Option<String>,
}

impl<'a> CertificationDocument<'a> {
    /// Claims with what became of them.
    pub(crate) fn new(claims: &'a PlanCertificate, checked: &CheckedCertificate) -> Self {
        let strongest = &checked.strongest;
        let legs = claims.legs.iter().zip(&checked.legs).zip(&strongest.legs);
        Self {
            confirmed: checked.confirmed(),
            legs: legs
                .map(|((leg, verdict), strongest)| LegDocument {
                    from: &leg.from,
                    to: &leg.to,
                    claim: ClaimDocument::new(leg.lower_bound_s, *strongest, verdict),
                })
                .collect(),
            tour: ClaimDocument::new(claims.lower_bound_s, strongest.tour, &checked.tour),
        }
    }
}

impl ClaimDocument {
    fn new(bound: Option<f64>, strongest: Option<StrongestBound>, verdict: &Verdict) -> Self {
        Self {
            certified_lower_bound_s: bound.map(Number),
            strongest_lower_bound_s: strongest.map(|strongest| Number(strongest.bound_s)),
            strongest_confirmed: strongest.map(|strongest| strongest.is_confirmed),
            verdict: name(verdict),
            reason: reason(verdict),
        }
    }
}

/// The stable text of a verdict.
pub(crate) const fn name(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::NoBound => "no_claim",
        Verdict::Confirmed => "confirmed",
        Verdict::Rejected(_) => "rejected",
        Verdict::NotChecked(_) => "not_checked",
    }
}

/// Why a claim is not confirmed.
pub(crate) fn reason(verdict: &Verdict) -> Option<String> {
    match verdict {
        Verdict::NoBound | Verdict::Confirmed => None,
        Verdict::Rejected(objection) => Some(objection.to_string()),
        Verdict::NotChecked(obstacle) => Some(obstacle.to_string()),
    }
}
