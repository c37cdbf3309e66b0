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
//! Two maps: [`magnus`] for zero momentum, fast and good to about 1e-6 rad, and [`runge_kutta`].
//! The derivatives of both are exact derivatives of the discrete map.

mod magnus;
mod quaternion;
mod runge_kutta;
#[cfg(test)]
mod tests;

pub(crate) use quaternion::{Quat, conjugate, dot4, imaginary, product, quat, rotate_back};

use nalgebra::{Matrix3, Vector3};
use runge_kutta::RungeKutta;

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
    /// `sum_i mu_i d2 p_i / dz dz`, both triangles.
    pub(crate) second: [[f64; INPUTS]; INPUTS],
}

/// The map from inputs to turns.
#[derive(Debug, Clone)]
pub(crate) enum TurnMap {
    /// Two Magnus steps of order six.
    Magnus,
    /// Runge-Kutta of order six.
    RungeKutta(RungeKutta),
}

impl TurnMap {
    /// The map to iterate with; `inertia_inverse` is that of `J_eff` in matching units.
    pub(crate) fn fast(inertia_inverse: Matrix3<f64>, with_momentum: bool) -> Self {
        if with_momentum {
            Self::exact(inertia_inverse, true, FAST_SUBSTEPS)
        } else {
            Self::Magnus
        }
    }

    /// A map as exact as its number of substeps makes it.
    pub(crate) fn exact(
        inertia_inverse: Matrix3<f64>,
        with_momentum: bool,
        substeps: usize,
    ) -> Self {
        Self::RungeKutta(RungeKutta::new(inertia_inverse, with_momentum, substeps))
    }

    /// Number of inputs with non-zero derivatives.
    pub(crate) fn inputs(&self) -> usize {
        match self {
            Self::Magnus => INPUTS_WITHOUT_MOMENTUM,
            Self::RungeKutta(map) => map.inputs(),
        }
    }

    /// The turn over the interval.
    pub(crate) fn turn(&self, z: &TurnInputs) -> Quat {
        match self {
            Self::Magnus => magnus::turn(z),
            Self::RungeKutta(map) => map.turn(z),
        }
    }

    /// The turn with derivatives, the second ones weighted by `mu`.
    pub(crate) fn derivatives(&self, z: &TurnInputs, mu: &Quat) -> TurnDerivatives {
        match self {
            Self::Magnus => magnus::derivatives(z, mu),
            Self::RungeKutta(map) => map.derivatives(z, mu),
        }
    }
}
