//! The certificate of a bound: the bound as plain data, with all that its verification needs.

use super::limits::{EndRates, SlewLimits};
use crate::model::attitude::Attitude;
use nalgebra::{Matrix3, Vector3};

/// Relative reduction of least times in a certificate. It leaves the verification in interval
/// arithmetic a margin for its own rounding, and for rates that it raises so that no two are nearly
/// equal (see [`crate::bounds::certify`]).
pub(super) const PROOF_MARGIN: f64 = 2e-6;

/// A turn with a lower bound on its time within a box of rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedTurn {
    /// The turn, body axes at its beginning; either sign of the quaternion.
    pub turn: Attitude,
    /// Lower bound on the time of any motion with `|w_i| <= box_i` that makes the turn, s.
    pub least_s: f64,
}

/// A lower bound on the duration of a slew, or of a tour through several attitudes, with its
/// premises.
///
/// Every motion with rates and accelerations within `limits` and end rates within `ends` that makes
/// the turns one after the other, up to `attitude_tolerance_rad` at each end, lasts at least
/// `duration_s`: the turns within the box `box_rad_s` take at least their `least_s`, and
/// [`super::ramps`] links these times to the duration.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// Limits that every motion of the spacecraft satisfies.
    pub limits: SlewLimits,
    /// Limits of the rates at the two ends of the whole motion.
    pub ends: EndRates,
    /// The box of rates `p` whose least times bound the duration, rad/s.
    pub box_rad_s: Vector3<f64>,
    /// The turns, each in the body axes where the one before ended.
    pub turns: Vec<CertifiedTurn>,
    /// Largest angle by which the attitudes at both ends of every turn are missed, rad.
    pub attitude_tolerance_rad: f64,
    /// The lower bound on the duration, s.
    pub duration_s: f64,
}

/// Durations that no slew with stored momentum has: they are excluded by one box, in axes that turn with a drift
/// (`kinematic::drift`).
#[derive(Debug, Clone, PartialEq)]
pub struct ExcludedDurations {
    /// The axes as columns, in body axes.
    pub axes: Matrix3<f64>,
    /// The share of the momentum, 1/(kg m²), with which they turn in space.
    pub share: f64,
    /// This drift at begin and end of a slew, rad/s, in the axes there.
    pub drifts_rad_s: [Vector3<f64>; 2],
    /// Limits of every motion relative to the drift.
    pub limits: SlewLimits,
    /// Limits of the rates at its ends, relative to the drift too.
    pub ends: EndRates,
    /// The box of rates `p`, rad/s.
    pub box_rad_s: Vector3<f64>,
    /// What is left of the turn relative to the drift for slews of the duration `from_s`.
    pub left: CertifiedTurn,
    /// The least of the durations, s.
    pub from_s: f64,
    /// The greatest of them, s.
    pub to_s: f64,
}

/// A lower bound on the duration of a slew with stored momentum, with its premises: all durations from 0 on are
/// excluded, one range after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct DriftCertificate {
    /// The ranges.
    pub steps: Vec<ExcludedDurations>,
    /// Largest angle by which the attitudes at both ends are missed, rad.
    pub attitude_tolerance_rad: f64,
    /// The lower bound on the duration, s.
    pub duration_s: f64,
}
