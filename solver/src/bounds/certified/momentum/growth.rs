//! How fast rates grow from rest while the momentum turns the body.
//!
//! Let `K` be the set of all reachable rates (a box about the body axes, within a ball where the norm has a limit)
//! and `mu` the gauge of the rate in it, 0 at rest and 1 at most. The wheels accelerate the body along a direction
//! `d` by `a_d` at most, and the stored momentum by `c_d mu`: its acceleration is linear in the rate, and `c_d` is
//! the largest of all rates in `K` ([`Dynamics::gyroscopic_acceleration`]). So
//!
//! ```text
//!   mu' <= max over the facets f of K of (a_f + c_f mu) / p_f <= alpha + gamma mu,
//!   mu(t) <= min(1, (mu_0 + alpha / gamma) e^(gamma t) - alpha / gamma),
//! ```
//!
//! and along any direction the rate, relative to a drift or not, changes from rest until the time `t` by at most
//!
//! ```text
//!   N_d(t) = a_d t + c_d int_0^t mu,
//! ```
//!
//! which is convex. Until it reaches a limit `p` it is below the chord from 0, whose slope is less than `a_d + c_d`.

use super::MISSED_RATE;
use crate::model::dynamics::Dynamics;
use nalgebra::Vector3;

/// Steps of a bisection, enough for all digits.
const HALVINGS: usize = 60;

/// The growth of the gauge of the rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct RateGrowth {
    /// Gauge of what counts as rest.
    first: f64,
    /// 1/s.
    alpha: f64,
    /// 1/s.
    gamma: f64,
}

impl RateGrowth {
    /// That of a spacecraft.
    pub(super) fn of(dynamics: &Dynamics) -> Self {
        let most = dynamics.reachable_rates().inf(&dynamics.max_rate);
        let body = |axis: usize| Vector3::ith(axis, 1.0);
        let torques = Vector3::from_fn(|i, _| dynamics.reachable_acceleration(&body(i)));
        let held = Vector3::from_fn(|i, _| dynamics.gyroscopic_acceleration(&body(i), 0.0));
        let norm = dynamics.max_rate_norm;
        Self {
            first: 2.0 * MISSED_RATE / most.min().min(norm),
            alpha: torques
                .component_div(&most)
                .max()
                .max(torques.norm() / norm),
            gamma: held.component_div(&most).max().max(held.norm() / norm),
        }
    }

    /// Slope of the chord, rad/s², below which a rate grows from rest to a limit, rad/s, with these
    /// accelerations by torques and, at the largest rates, by the momentum, rad/s².
    pub(super) fn slope(&self, by_torques: f64, by_momentum: f64, limit: f64) -> f64 {
        let fastest = by_torques + by_momentum;
        let slow_enough = by_momentum > 0.0 && limit.is_finite() && self.gamma > 0.0;
        if !slow_enough {
            return fastest;
        }
        // The rate is below the limit before `early` at any acceleration, and may be above it after `late`.
        let (mut early, mut late) = (limit / fastest, limit / by_torques);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (early + late);
            if by_torques * middle + by_momentum * self.integral(middle) <= limit {
                early = middle;
            } else {
                late = middle;
            }
        }
        limit / early
    }

    /// `int_0^t min(1, mu)`, s.
    fn integral(&self, time: f64) -> f64 {
        let Self {
            first,
            alpha,
            gamma,
        } = *self;
        let scale = first + alpha / gamma;
        let full = ((1.0 + alpha / gamma) / scale).ln() / gamma;
        let until = |t: f64| scale * (gamma * t).exp_m1() / gamma - alpha / gamma * t;
        if time <= full {
            until(time)
        } else {
            until(full) + time - full
        }
    }
}
