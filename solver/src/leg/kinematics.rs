//! The attitude change over one interval of linearly varying wheel momentum, with derivatives.
//!
//! Torque is constant on an interval, so the wheels' share of the body rate is linear in time.
//! With `sigma` in `[0, 1]` along the interval and `p` the turn since its beginning, the kinematics
//! `q' = 1/2 q (x) [w, 0]` become
//!
//! ```text
//!   p' = 1/2 p (x) w,   w = (1 - sigma) a + sigma c + Ji R(p)^T zeta,   p(0) = 1
//! ```
//!
//! where `a` and `c` are the rates times the interval's length at both ends as far as the wheels
//! make them, `Ji` is the inverse of `J_eff`, and `zeta` is the total momentum at the beginning
//! times the length. With zero momentum only `a` and `c` remain. The inputs are `z = (a, c, zeta)`.
//!
//! Three maps: [`magnus`] for zero momentum, fast and good to about 1e-5 rad, [`taylor`] for stored
//! momentum, as good on short intervals, and [`runge_kutta`] with and without momentum, as exact as
//! its substeps make it. The derivatives of all are exact derivatives of the discrete map.

mod magnus;
mod runge_kutta;
mod taylor;
#[cfg(test)]
mod tests;

use crate::math::quaternion::Quat;
pub(crate) use magnus::BentTurn;
use nalgebra::{Matrix3, Vector3};
use runge_kutta::{RungeKutta, flow};

/// Inputs of a step with momentum.
pub(crate) const INPUTS: usize = 9;
/// Inputs that matter when the momentum is zero.
const INPUTS_WITHOUT_MOMENTUM: usize = 6;
/// Substeps of the fast map with momentum, for which there is no closed form.
const FAST_SUBSTEPS: usize = 2;

/// Inputs of one interval's turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TurnInputs {
    /// `a`, rad.
    pub(crate) begin: Vector3<f64>,
    /// `c`, rad.
    pub(crate) end: Vector3<f64>,
    /// `zeta`.
    pub(crate) momentum: Vector3<f64>,
}

/// A turn with its first derivatives and, weighted by a covector, its second ones.
#[derive(Debug, Clone)]
pub(crate) struct TurnDerivatives {
    /// `p(1)`.
    pub(crate) turn: Quat,
    /// `dp / dz_j`.
    pub(crate) first: [Quat; INPUTS],
    /// `sum_i mu_i d2 p_i / dz dz` and the same of the rate in the middle, both triangles.
    pub(crate) second: [[f64; INPUTS]; INPUTS],
    /// Derivatives of the rate in the middle of the interval, times its length; zero without
    /// momentum, where rates are linear.
    pub(crate) middle: [Vector3<f64>; INPUTS],
}

/// A turn counts as exact when halving the step changes it by less than this: the error of the
/// finer one is a sixty-fourth of the change.
const EXACT: f64 = 1e-9;
/// Halvings of the step on the way there.
const MAX_HALVINGS: usize = 5;

/// The turn over an interval with a discretisation error far below all tolerances.
pub(crate) fn exact_turn(
    inertia_inverse: Matrix3<f64>,
    with_momentum: bool,
    z: &TurnInputs,
) -> Quat {
    let map = RungeKutta::new(inertia_inverse, with_momentum, 1);
    exact_flow(|sigma, p| map.rate(z, sigma, p))
}

/// The turn over an interval on which the rate times the length is any smooth function of the share
/// of the interval that has passed and of the turn since its beginning.
pub(crate) fn exact_flow(rate: impl Fn(f64, &Quat) -> Vector3<f64>) -> Quat {
    let mut substeps = 1;
    let mut turn = flow(substeps, &rate);
    for _ in 0..MAX_HALVINGS {
        substeps *= 2;
        let finer = flow(substeps, &rate);
        let change = finer.iter().zip(&turn).map(|(a, b)| (a - b).abs());
        let exact = change.fold(0.0, f64::max) <= EXACT;
        turn = finer;
        if exact {
            break;
        }
    }
    turn
}

/// The map from inputs to turns.
#[derive(Debug, Clone)]
pub(crate) enum TurnMap {
    /// One Magnus step of order six.
    Magnus,
    /// A Taylor expansion of the rate, for this inverse of `J_eff`.
    Taylor(Matrix3<f64>),
    /// Runge-Kutta of order six.
    RungeKutta(RungeKutta),
}

impl TurnMap {
    /// The map that solves begin with; `inertia_inverse` is the inverse of `J_eff` in matching
    /// units.
    pub(crate) fn fast(inertia_inverse: Matrix3<f64>, with_momentum: bool) -> Self {
        if with_momentum {
            Self::Taylor(inertia_inverse)
        } else {
            Self::Magnus
        }
    }

    /// A map with half the step.
    pub(crate) fn finer(&self, inertia_inverse: Matrix3<f64>) -> Self {
        Self::RungeKutta(match self {
            Self::Magnus => RungeKutta::new(inertia_inverse, false, FAST_SUBSTEPS),
            Self::Taylor(_) => RungeKutta::new(inertia_inverse, true, FAST_SUBSTEPS),
            Self::RungeKutta(map) => map.finer(),
        })
    }

    /// Number of inputs with non-zero derivatives.
    pub(crate) fn inputs(&self) -> usize {
        match self {
            Self::Magnus => INPUTS_WITHOUT_MOMENTUM,
            Self::Taylor(_) => INPUTS,
            Self::RungeKutta(map) => map.inputs(),
        }
    }

    /// The turn over the interval.
    pub(crate) fn turn(&self, z: &TurnInputs) -> Quat {
        match self {
            Self::Magnus => magnus::turn(z),
            Self::Taylor(inverse) => taylor::turn(z, inverse),
            Self::RungeKutta(map) => map.turn(z),
        }
    }

    /// The rate in the middle of the interval, times its length, by the expansion.
    pub(crate) fn middle(&self, z: &TurnInputs) -> Vector3<f64> {
        match self {
            Self::Magnus => (z.begin + z.end) * 0.5,
            Self::Taylor(inverse) => taylor::middle(z, inverse),
            Self::RungeKutta(map) => taylor::middle(z, map.inertia_inverse()),
        }
    }

    /// The turn with derivatives, and with momentum those of the rate in the middle; the second
    /// ones weighted by `mu` and `pull`.
    pub(crate) fn derivatives(
        &self,
        z: &TurnInputs,
        mu: &Quat,
        pull: &Vector3<f64>,
    ) -> TurnDerivatives {
        match self {
            Self::Magnus => magnus::derivatives(z, mu),
            Self::Taylor(inverse) => taylor::derivatives(z, inverse, mu, pull),
            Self::RungeKutta(map) if map.inputs() == INPUTS => {
                let mut turn = map.derivatives(z, mu);
                let inverse = map.inertia_inverse();
                let middle = taylor::derivatives(z, inverse, &[0.0; 4], pull);
                for (row, more) in turn.second.iter_mut().zip(&middle.second) {
                    for (out, more) in row.iter_mut().zip(more) {
                        *out += more;
                    }
                }
                turn.middle = middle.middle;
                turn
            }
            Self::RungeKutta(map) => map.derivatives(z, mu),
        }
    }
}
