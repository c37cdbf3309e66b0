//! Verification in interval arithmetic of the bounds of [`crate::bounds::kinematic`].
//!
//! [`verify`] proves the bound of a [`Certificate`] again, with outward rounding and without the
//! code of the fast search: with its own list of extremals, its own enumeration, its own integral.
//! It confirms the bound or says why not: there is a faster motion, or no proof was found. A
//! certificate comes from
//! [`SlewBound::certificate`](crate::bounds::kinematic::ramps::SlewBound::certificate); to verify a
//! bound from elsewhere, replace the `duration_s` of one.
//!
//! ```
//! use nalgebra::Vector3;
//! use slewplan_solver::model::attitude::Attitude;
//! use slewplan_solver::bounds::certify::{self, Rejection};
//! use slewplan_solver::bounds::kinematic::limits::{EndRates, SlewLimits};
//! use slewplan_solver::bounds::kinematic::ramps::SlewBound;
//!
//! let limits = SlewLimits {
//!     rates_rad_s: Vector3::new(0.018, 0.013, 0.012),
//!     accelerations_rad_s2: Vector3::new(0.0015, 0.0011, 0.001),
//! };
//! let bound = SlewBound::new(limits, EndRates::at_rest()).expect("ordinary limits");
//! let turn = Attitude::from_rotation_vector(Vector3::new(0.4, -0.9, 0.7));
//! let mut certificate = bound.certificate(&[turn], 1e-4);
//! assert_eq!(certify::verify(&certificate), Ok(()));
//! certificate.duration_s *= 1.001;
//! assert!(matches!(certify::verify(&certificate), Err(Rejection::Link { .. })));
//! ```
//!
//! # What is proved
//!
//! 1. **Turns** ([`verify_turn`]). A motion of least time exists and is one of the extremals that
//!    the docs of [`crate::bounds::kinematic`] derive from Pontryagin's principle. These facts are
//!    taken from there: the folded costate runs on a circle and is reflected where a component
//!    vanishes, so that arcs between flips have the same duration; it can rest on saddles only; all
//!    dwells can be moved to the first visit of the saddle. With corners of length one, an arc
//!    longer than `pi` is no part of a shortest motion, because the opposite corner makes its turn
//!    faster. That leaves
//!    * two arcs;
//!    * arcs of one unknown duration `D <= pi` whose flips alternate between two axes, terminal
//!      arcs no longer than `D` (where one axis alone flips, arcs last longer than `pi`: the part
//!      of the circle beyond the wall is less than half of it);
//!    * a dwell with arcs before and after it whose durations follow from the costate (`dwelling`).
//!
//!    All orders of axes and all octants are enumerated, whether they are extremals or not: each
//!    sequence is a motion within the box, so superfluous ones do no harm. For each, the range of
//!    the unknown is bisected until every part is refuted: `c_0 . P c_f` differs from the target's
//!    value, or the terminal arcs that close the sequence (`terminal_arcs`) are negative, too long,
//!    or make the sequence as long as the bound. Sequences of many flips are refuted together
//!    (`near_axis`).
//! 2. **The link** to the duration: `s(T)` is bounded from above, and what missed attitudes save too
//!    (`link`).
//! 3. **With stored momentum** ([`verify_drift`]) both for every range of durations that is excluded, and that
//!    the ranges leave no gap.
//!
//! On a part of half-width `b` about its middle, the interior is enclosed by Taylor's theorem, with
//! the derivative at the middle in intervals and, for a product of turns, a second derivative of at
//! most the square of the sum of its speeds `v`: `|f - f_m| <= |f_m'| b + v^2 b^2 / 2`, and the
//! turn from the middle is at most `|velocity| b + v^2 b^2 / 2`.
//!
//! Nearly equal rates are separated by raising them, by 4e-7 at most, which makes the proved
//! statement stronger; certificates leave a margin of 2e-6.

mod drift;
mod dwelling;
mod link;
mod near_axis;
mod polytope;
mod prover;
mod rates;
mod sequence;
mod terminal_arcs;
#[cfg(test)]
mod tests;
mod turn;

use crate::bounds::interval::Interval;
use crate::bounds::kinematic::certificate::{Certificate, CertifiedTurn};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::polytope::certificate::{FramePremise, NormCertificate};
use crate::bounds::polytope::trapezoid::Trapezoid;
pub use drift::verify_drift;
use nalgebra::Vector3;
use polytope::PolytopeProver;
use prover::Prover;

/// Why a bound was not confirmed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// A motion within the box of rates is faster than the least time of a turn in the certificate.
    #[error("turn {turn} can be made in {time_s} s, less than its least time in the certificate")]
    Faster {
        /// Index of the turn in the certificate.
        turn: usize,
        /// Time of the motion, s.
        time_s: f64,
    },
    /// The least times of the turns do not imply the bound on the duration.
    #[error("least times of {least_s} s in all bound no duration with s(T) = {needed_s} s")]
    Link {
        /// Sum of the turns' least times, less what missed attitudes save, s.
        least_s: f64,
        /// Sum that the bound on the duration requires, s.
        needed_s: f64,
    },
    /// Shorter durations than the bound are not excluded.
    #[error("durations from {excluded_s} s on are not excluded")]
    Open {
        /// The least of them, s.
        excluded_s: f64,
    },
    /// Neither a proof nor a counterexample was found.
    #[error("not proved: {reason}")]
    NotProved {
        /// Why the proof failed.
        reason: &'static str,
    },
    /// A number is not finite, or a limit not positive.
    #[error("the certificate is malformed: {what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
}

impl Rejection {
    fn not_proved(reason: &'static str) -> Self {
        Self::NotProved { reason }
    }
}

/// Verifies a certificate.
///
/// # Errors
///
/// The first [`Rejection`]; the link is checked before the turns.
pub fn verify(certificate: &Certificate) -> Result<(), Rejection> {
    let Certificate {
        limits,
        ends,
        box_rad_s,
        turns,
        attitude_tolerance_rad,
        duration_s,
    } = certificate;
    check_limits(limits, ends)?;
    check_times(turns.iter().map(|turn| turn.least_s).chain([*duration_s]))?;
    check_missed(*attitude_tolerance_rad)?;
    let mut prover = prover_within(box_rad_s)?;
    if *duration_s > 0.0 {
        let missed_s = link::missed(box_rad_s, *attitude_tolerance_rad);
        let least_s = turns.iter().fold(Interval::ZERO, |sum, turn| {
            let left_s = Interval::exactly(turn.least_s) - missed_s;
            sum + Interval::exactly(left_s.low.max(0.0))
        });
        let needed_s = link::at_most(limits, ends, box_rad_s, *duration_s);
        if needed_s > least_s.low {
            return Err(Rejection::Link {
                least_s: least_s.low,
                needed_s,
            });
        }
    }
    for (place, turn) in turns.iter().enumerate() {
        prover
            .prove(&turn.turn, turn.least_s)
            .map_err(|rejection| rejection.of_turn(place))?;
    }
    Ok(())
}

/// Verifies the certificate of a bound by a norm.
///
/// # Errors
///
/// The first [`Rejection`]; the link is checked before the turn.
pub fn verify_norm(certificate: &NormCertificate) -> Result<(), Rejection> {
    let NormCertificate {
        facets,
        frame,
        turn,
        attitude_tolerance_rad,
        duration_s,
    } = certificate;
    for Trapezoid { most, slope, ends } in facets.iter().map(|facet| &facet.share) {
        check_positive([most, slope])?;
        check_not_negative(ends)?;
    }
    if let Some(FramePremise { axes, limits, ends }) = frame {
        if !axes.iter().all(|x| x.is_finite()) {
            return malformed("axes must be finite");
        }
        check_limits(limits, ends)?;
    }
    check_times([turn.least_s, *duration_s])?;
    check_missed(*attitude_tolerance_rad)?;
    let normals: Vec<_> = facets.iter().map(|facet| facet.normal).collect();
    let Some(prover) = PolytopeProver::new(&normals) else {
        return malformed("the facets must enclose a polytope in general position");
    };
    if *duration_s > 0.0 {
        let missed_s = link::missed_across(facets, *attitude_tolerance_rad);
        let least_s = (Interval::exactly(turn.least_s) - missed_s).low;
        let needed_s = link::at_most_across(facets, frame.as_ref(), *duration_s);
        if needed_s > least_s {
            return Err(Rejection::Link { least_s, needed_s });
        }
    }
    prover.prove(&turn.turn, turn.least_s)
}

/// Verifies that no motion with `|w_i| <= box_i`, rad/s, makes a turn in less than its certified
/// time.
///
/// # Errors
///
/// Why the time is not confirmed.
pub fn verify_turn(box_rad_s: &Vector3<f64>, certified: &CertifiedTurn) -> Result<(), Rejection> {
    check_times([certified.least_s])?;
    prover_within(box_rad_s)?.prove(&certified.turn, certified.least_s)
}

fn malformed<T>(what: &'static str) -> Result<T, Rejection> {
    Err(Rejection::Malformed { what })
}

fn check_limits(limits: &SlewLimits, ends: &EndRates) -> Result<(), Rejection> {
    check_positive(
        limits
            .rates_rad_s
            .iter()
            .chain(&limits.accelerations_rad_s2),
    )?;
    check_not_negative(ends.begin_rad_s.iter().chain(&ends.end_rad_s))
}

fn check_positive<'a>(limits: impl IntoIterator<Item = &'a f64>) -> Result<(), Rejection> {
    if limits.into_iter().all(|x| x.is_finite() && *x > 0.0) {
        return Ok(());
    }
    malformed("limits must be positive and finite")
}

fn check_not_negative<'a>(ends: impl IntoIterator<Item = &'a f64>) -> Result<(), Rejection> {
    if ends.into_iter().all(|x| *x >= 0.0) {
        return Ok(());
    }
    malformed("end rates must not be negative")
}

fn check_times(times: impl IntoIterator<Item = f64>) -> Result<(), Rejection> {
    if times.into_iter().all(f64::is_finite) {
        return Ok(());
    }
    malformed("times must be finite")
}

fn check_missed(attitude_tolerance_rad: f64) -> Result<(), Rejection> {
    if attitude_tolerance_rad.is_finite() && attitude_tolerance_rad >= 0.0 {
        return Ok(());
    }
    malformed("the angle of missed attitudes must be finite and not negative")
}

fn prover_within(box_rad_s: &Vector3<f64>) -> Result<Prover, Rejection> {
    Prover::new(box_rad_s).map_or_else(|| malformed("the box must be positive and finite"), Ok)
}

impl Rejection {
    /// The same for the turn with an index.
    fn of_turn(self, turn: usize) -> Self {
        match self {
            Self::Faster { time_s, .. } => Self::Faster { turn, time_s },
            other => other,
        }
    }
}
