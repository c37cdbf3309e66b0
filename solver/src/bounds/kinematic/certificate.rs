//! What a bound claims, in plain data: all that a checker needs to verify it.

use super::limits::{EndRates, SlewLimits};
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

/// Share by which least times are lowered before they are claimed. It leaves an independent proof
/// in intervals room for its own rounding, and for rates that it raises a little so that no two are
/// nearly equal (see [`crate::bounds::certify`]).
pub(super) const PROOF_MARGIN: f64 = 2e-6;

/// A turn with a time that no motion within a box of rates undercuts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedTurn {
    /// The turn, body axes at its beginning; either sign of the quaternion.
    pub turn: Attitude,
    /// The claim, s: no motion with `|w_i| <= box_i` that makes the turn is faster.
    pub least_s: f64,
}

/// The claim that a slew, or a tour through several attitudes, takes a time at least.
///
/// Every motion with rates and accelerations within `limits` and end rates within `ends`, that makes
/// the turns one after the other, lasts `duration_s` at least: because the turns within the box
/// `box_rad_s` take their `least_s` at least, and by the link of [`super::ramps`] from these to the
/// duration.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificate {
    /// What no motion of the spacecraft exceeds.
    pub limits: SlewLimits,
    /// What the rates do not exceed at the ends of the whole.
    pub ends: EndRates,
    /// The box of rates `p` whose least times bound the duration, rad/s.
    pub box_rad_s: Vector3<f64>,
    /// The turns, each in the body axes where the one before ended.
    pub turns: Vec<CertifiedTurn>,
    /// The claim, s.
    pub duration_s: f64,
}
