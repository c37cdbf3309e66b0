//! Bounds by norms whose unit balls are polytopes of rates.
//!
//! Let `G` be the gauge of a symmetric polytope `K = {w : f . w <= p_f}`, and `V_K(R)` the least time of the turn
//! `R` with rates in `K` ([`crate::bounds::polytope`]). Along a slew of duration `T` that makes the turn, time can
//! be measured by `G(w)` instead, as in [`crate::bounds::kinematic::ramps`]: the motion then has rates in `K`. So
//!
//! ```text
//!   V_K(R) <= int_0^T G(w) dt <= s(T),    s(T) = int_0^T max_f m_f(t; T) / p_f dt
//! ```
//!
//! for any limits `m_f(t; T)` of the component `f . w` at a time, and `T >= s^-1(V_K(R))` for every `K`. Two
//! limits are known, and the smaller one counts. The first is that of the component itself,
//!
//! ```text
//!   m_f = min(r_f, b_f + a_f t, e_f + a_f (T - t))
//! ```
//!
//! with the largest component of rates and accelerations along `f`, which is exact for the zonotopes that wheels
//! reach, and of the rates at the ends. The other is `sum_i |f_i| m_i(t; T)` with the components along the axes
//! of a frame: it knows that a component is stopped of which `f` has a share only.
//!
//! # The polytopes
//!
//! * Arrays: all facets of what the wheels reach ([`Facets`]), with `p_f` the mean of `m_f` over a duration: from
//!   the rates themselves to the shape of the accelerations.
//! * Unequal ramps, and components that are stopped beside others that are not. Boxes of rates `p` lose the ramp
//!   of one axis while another one turns at its full rate. With weights `b_i >= 0`, `B = b_1 + b_2 + b_3 < 1`,
//!
//!   ```text
//!   G(w) = (1 - B) max_i |w_i| / p_i + sum_i b_i |w_i| / p_i
//!   ```
//!
//!   every axis pays for its own ramp: at rest at both ends and for long slews
//!   `T >= V_K + sum_i b_i tau_i + (1 - B) min tau_i` with `tau_i = p_i / a_i`.
//! * The ball of the Euclidean norm (`rate_norm`), with momentum too: where this norm of the rate is limited, and for
//!   quaternions that have to arrive with a sign, whose turns of up to 360 degrees no other norm knows.

mod norm;
mod rate_norm;

use super::{BodyFrame, EXCEEDED_LIMITS};
use crate::bounds::kinematic::ramps::stated;
use crate::bounds::polytope::certificate::NormCertificate;
use crate::bounds::polytope::trapezoid::Trapezoid;
use crate::model::attitude::Attitude;
use crate::model::dynamics::{Dynamics, component};
use nalgebra::{Matrix3, Vector3};
use norm::Norm;

/// Durations whose mean rates give polytopes of arrays, in units of the longest ramp.
const DURATIONS: [f64; 4] = [0.7, 1.5, 3.0, 8.0];
/// Weights of single axes.
const WEIGHTS: [f64; 9] = [0.15, 0.3, 0.4, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8];
/// Weights of two axes.
const PAIRS_OF_WEIGHTS: [[f64; 2]; 12] = [
    [0.1, 0.2],
    [0.1, 0.4],
    [0.1, 0.6],
    [0.2, 0.2],
    [0.2, 0.4],
    [0.2, 0.6],
    [0.3, 0.3],
    [0.35, 0.35],
    [0.2, 0.1],
    [0.4, 0.1],
    [0.4, 0.2],
    [0.6, 0.1],
];
/// Ratio of ramps from which weights are worth trying.
const UNEQUAL: f64 = 1.1;
/// Norms that are tried for a slew.
const MAX_TRIED: usize = 12;
/// Relative gain for which a norm is not tried.
const SMALL_GAIN: f64 = 5e-4;
/// Facets beyond those of a box.
const FACETS_OF_A_BOX: usize = 3;

/// A bound by a norm.
#[derive(Debug)]
pub(crate) struct NormBound {
    /// The bound, s.
    pub(crate) bound_s: f64,
    /// Its certificate; `None` where it follows from the Euclidean norm of the rate.
    pub(crate) certificate: Option<NormCertificate>,
}

/// The norms for a spacecraft without momentum and some rates at the ends of a slew.
#[derive(Debug)]
pub(super) struct Norms {
    norms: Vec<Norm>,
    /// Limits of the Euclidean norm of the rate.
    rate_norm: Trapezoid,
}

impl Norms {
    /// Norms for end rates within these limits, rad/s, body axes, infinite where they are free; the frames are
    /// those in which boxes are tried for every slew, and `facets` directions across facets of what the wheels
    /// reach. With momentum the ball alone, without a ramp.
    pub(super) fn new(
        dynamics: &Dynamics,
        frames: &[BodyFrame],
        facets: &[Vector3<f64>],
        ends: &[Vector3<f64>; 2],
    ) -> Self {
        let rate_norm = rate_norm(dynamics, frames, ends);
        if dynamics.has_momentum() {
            return Self {
                norms: Vec::new(),
                rate_norm,
            };
        }
        let mut norms = Vec::new();
        let limits = |f: &Vector3<f64>| Trapezoid {
            most: dynamics.greatest_rate(f) * EXCEEDED_LIMITS,
            slope: dynamics.reachable_acceleration(f) * EXCEEDED_LIMITS,
            ends: ends.map(|end| component(f, &end)),
        };
        if facets.len() > FACETS_OF_A_BOX {
            let limited: Vec<_> = facets.iter().map(|f| (*f, limits(f))).collect();
            let ramps = limited.iter().map(|(_, limits)| limits.most / limits.slope);
            let longest = ramps.fold(0.0, f64::max);
            let durations = DURATIONS.iter().map(|duration| duration * longest);
            for duration in durations.chain([f64::INFINITY]) {
                let mean = limited.iter().map(|(f, limits)| f / limits.mean(duration));
                norms.extend(Norm::new(&mean.collect::<Vec<_>>(), None, limits));
            }
        }
        for frame in frames {
            let Some(boxed) = frame.envelope(ends) else {
                continue;
            };
            for weights in weights(frame, &ends.map(|end| frame.limits_in_axes(&end))) {
                let half_spaces = weighted(&frame.axes, &frame.limits.rates_rad_s, &weights);
                norms.extend(Norm::new(&half_spaces, Some((frame.axes, boxed)), limits));
            }
        }
        Self { norms, rate_norm }
    }

    /// The largest bound that some norm proves for a turn by an angle, rad, whose ends are missed by another one each, if
    /// it exceeds one that is known, s.
    pub(super) fn beyond(
        &self,
        (turn, angle): (&Attitude, f64),
        missed: f64,
        known_s: f64,
        tolerance: f64,
    ) -> Option<NormBound> {
        let identity = Attitude::identity();
        let vector = identity.signed_turn_to(&turn.nearest_sign(&identity));
        let mut promising: Vec<(f64, &Norm)> = self
            .norms
            .iter()
            .map(|norm| (norm.promise(&vector, known_s), norm))
            .filter(|(promise, _)| *promise > 1.0 + SMALL_GAIN)
            .collect();
        promising.sort_by(|one, other| other.0.total_cmp(&one.0));
        let by_norm = rate_norm::least_duration(angle - 2.0 * missed, &self.rate_norm);
        let (mut best, mut of) = (known_s.max(by_norm), None);
        for (_, norm) in promising.into_iter().take(MAX_TRIED) {
            let raised = norm.raised(turn, missed, best, tolerance);
            if raised > best {
                (best, of) = (raised, Some(norm));
            }
        }
        let bound_s = stated(best);
        (bound_s > known_s).then(|| NormBound {
            bound_s,
            certificate: of.map(|norm| norm.certificate(turn, missed, bound_s, tolerance)),
        })
    }
}

/// Limits of the Euclidean norm of the rate.
fn rate_norm(dynamics: &Dynamics, frames: &[BodyFrame], ends: &[Vector3<f64>; 2]) -> Trapezoid {
    let least = |norms: &dyn Fn(&BodyFrame) -> f64| {
        let norms = frames.iter().map(norms);
        norms.fold(f64::INFINITY, f64::min)
    };
    let most = dynamics.max_rate_norm * EXCEEDED_LIMITS;
    let slope = if dynamics.has_momentum() {
        f64::INFINITY
    } else {
        least(&|frame| frame.limits.accelerations_rad_s2.norm())
    };
    Trapezoid {
        most: most.min(least(&BodyFrame::largest_rate)),
        slope,
        ends: ends.map(|end| end.norm()),
    }
}

/// Weights that may pay: of axes whose ramps are longer than the shortest one that counts.
fn weights(frame: &BodyFrame, ends: &[Vector3<f64>; 2]) -> Vec<Vector3<f64>> {
    let limits = &frame.limits;
    let ramps = limits
        .rates_rad_s
        .component_div(&limits.accelerations_rad_s2);
    // The ramp that an axis has: none where the component is free at both ends, half of it at one.
    let stopped = |axis: usize| {
        let at_rest = ends
            .iter()
            .filter(|end| end[axis] < 0.5 * limits.rates_rad_s[axis]);
        0.5 * at_rest.count() as f64
    };
    let gains = Vector3::from_fn(|axis, _| stopped(axis) * ramps[axis]);
    let least = gains.min();
    let gaining: Vec<usize> = (0..3)
        .filter(|axis| gains[*axis] > UNEQUAL * least && gains[*axis] > 0.0)
        .collect();
    let mut all: Vec<Vector3<f64>> = gaining
        .iter()
        .flat_map(|&axis| WEIGHTS.map(|weight| Vector3::ith(axis, weight)))
        .collect();
    if let [one, other] = gaining[..] {
        let pairs = PAIRS_OF_WEIGHTS.iter();
        all.extend(pairs.map(|pair| Vector3::ith(one, pair[0]) + Vector3::ith(other, pair[1])));
    }
    all
}

/// The half-spaces `f . w <= 1` of a norm with weights, in body axes.
fn weighted(
    axes: &Matrix3<f64>,
    rates: &Vector3<f64>,
    weights: &Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let rest = 1.0 - weights.sum();
    let mut half_spaces = Vec::new();
    for axis in 0..3 {
        let signs =
            (0..8).map(|bits| Vector3::from_fn(|i, _| if bits >> i & 1 == 0 { 1.0 } else { -1.0 }));
        // The opposite half-space belongs to it.
        for signs in signs.filter(|signs| signs[axis] > 0.0) {
            let shares = Vector3::from_fn(|i, _| {
                let all = weights[i] + if i == axis { rest } else { 0.0 };
                signs[i] * all / rates[i]
            });
            half_spaces.push(axes * shares);
        }
    }
    half_spaces
}

#[cfg(test)]
mod tests;
