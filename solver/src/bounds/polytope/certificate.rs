//! The certificate of a bound by a norm: the bound as plain data, with all that its verification needs.

use super::trapezoid::Trapezoid;
use crate::bounds::kinematic::certificate::CertifiedTurn;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use nalgebra::{Matrix3, Vector3};

/// Relative reduction of least times in a certificate. It leaves the verification in interval arithmetic a margin for
/// its own rounding, which is largest where an extremal rests, and for half-spaces and turns that it moves
/// ([`crate::bounds::certify`]).
pub(crate) const PROOF_MARGIN: f64 = 5e-5;

/// A lower bound on the duration of a slew with its premises.
///
/// Every motion within these limits that makes the turn, up to `attitude_tolerance_rad` at each end, lasts at least
/// `duration_s`: with rates in the polytope of the facets the turn takes at least its `least_s`, and what the facets
/// allow of a slew of that duration adds up to less.
#[derive(Debug, Clone, PartialEq)]
pub struct NormCertificate {
    /// The facets of the unit ball and those opposite to them.
    pub facets: Vec<FacetPremise>,
    /// Limits along the axes of a frame, which bound all facets too.
    pub frame: Option<FramePremise>,
    /// The turn, body axes at its beginning, with its least time in the polytope.
    pub turn: CertifiedTurn,
    /// Largest angle by which the attitudes at both ends of the turn are missed, rad.
    pub attitude_tolerance_rad: f64,
    /// The lower bound on the duration, s.
    pub duration_s: f64,
}

/// A facet `f . w = 1` with what limits `f . w` during a slew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetPremise {
    /// `f`, s/rad, body axes.
    pub normal: Vector3<f64>,
    /// Limits of `|f . w|`.
    pub share: Trapezoid,
}

/// Limits of rates and accelerations along the axes of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePremise {
    /// Its axes as columns, in body axes, orthonormal.
    pub axes: Matrix3<f64>,
    /// Limits along them.
    pub limits: SlewLimits,
    /// Limits of the rates along them at the two ends.
    pub ends: EndRates,
}
