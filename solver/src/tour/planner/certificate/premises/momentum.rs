//! The premises of bounds with stored momentum.
//!
//! Relative to axes that turn with the share `k` of the momentum `H` the rate is `v = w - k R^T H`, and
//!
//! ```text
//!   v  = J^-1 (- h_locked - sum a I W) + (J^-1 - k) R^T H,
//!   v' = - J_eff^-1 sum a u + (J_eff^-1 - k) (R^T H x w).
//! ```
//!
//! From rest the rate grows more slowly than at its largest acceleration: with the gauge `mu` of the rate in the set
//! of all that are reached, `mu' <= alpha + gamma mu`, it has changed along a direction by `a t + c int mu` after a
//! time `t` at most. This is convex, so it stays below a chord that it meets at the limit of the rate or later. The
//! integral is computed by Simpson's rule here.

use super::{
    ACCELERATIONS, ATTITUDE_TOLERANCE, EXCEEDED, NO_INVERSE, RATE_TOLERANCE, RATES, SAME_TURN,
    Slews, check_axes, check_missed, within,
};
use crate::bounds::kinematic::certificate::{DriftCertificate, ExcludedDurations};
use crate::model::scenario::Scenario;
use crate::tour::order::Place;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Tolerance for the components of two equal drifts, relative to the drift.
const SAME_DRIFT: f64 = 1e-9;
/// Intervals of Simpson's rule; the error is below 1e-12 over the time in which a rate grows by `e^20`.
const INTERVALS: u32 = 4096;

/// Checks the premises of a certificate for slews with stored momentum between two places.
///
/// # Errors
///
/// The first premise that the scenario does not support.
pub(in super::super) fn check_drift(
    scenario: &Scenario,
    places: [Place; 2],
    certificate: &DriftCertificate,
) -> Result<(), &'static str> {
    check_missed(certificate.attitude_tolerance_rad)?;
    let slews = Slews::of(scenario, places).ok_or(NO_INVERSE)?;
    let slews = HeldSlews::of(&slews);
    for step in &certificate.steps {
        slews.check(step)?;
    }
    Ok(())
}

/// All slews between two places with stored momentum.
struct HeldSlews<'a> {
    slews: &'a Slews<'a>,
    /// The momentum at both ends, N m s, body axes there.
    held: [Vector3<f64>; 2],
}

/// `mu' <= alpha + gamma mu` from rest up to the tolerance.
struct Growth {
    first: f64,
    alpha: f64,
    gamma: f64,
}

impl<'a> HeldSlews<'a> {
    fn of(slews: &'a Slews<'a>) -> Self {
        let (spacecraft, start) = (slews.scenario.spacecraft(), slews.scenario.start());
        let wheels = spacecraft.wheels().iter().zip(&start.wheel_speed);
        let spins = wheels.map(|(wheel, speed)| wheel.axis * (wheel.inertia * speed));
        let in_body = spacecraft.inertia() * start.rate + spins.sum::<Vector3<f64>>();
        let momentum = start.attitude.matrix() * in_body;
        Self {
            slews,
            held: slews.attitudes.map(|attitude| attitude.tr_mul(&momentum)),
        }
    }

    fn check(&self, step: &ExcludedDurations) -> Result<(), &'static str> {
        let axes = &step.axes;
        check_axes(axes)?;
        if !(step.share.is_finite() && step.share >= 0.0) {
            return Err("a share of the momentum that is none");
        }
        let drifts = self.held.map(|held| axes.tr_mul(&held) * step.share);
        for (drift, claimed) in drifts.iter().zip(&step.drifts_rad_s) {
            let off = (drift - claimed).norm();
            if off.is_nan() || off > SAME_DRIFT * drift.norm() {
                return Err("another drift");
            }
        }
        let drifted = Rotation3::from_scaled_axis(-drifts[0] * step.from_s);
        let left = drifted.matrix() * self.slews.turn(axes);
        let off = (left - step.left.turn.matrix()).norm();
        if off.is_nan() || off > SAME_TURN {
            return Err("another turn");
        }
        for axis in 0..3 {
            let direction = axes.column(axis).into_owned();
            let rate = step.limits.rates_rad_s[axis];
            if !within(self.largest_rate(&direction, step.share) * EXCEEDED, rate) {
                return Err(RATES);
            }
            let slope = step.limits.accelerations_rad_s2[axis];
            if !self.grants(&direction, step.share, rate, slope) {
                return Err(ACCELERATIONS);
            }
            // Where the attitude is missed, so is the direction of the drift.
            let moved = drifts.map(|drift| drift[axis].abs() + drift.norm() * ATTITUDE_TOLERANCE);
            let ends = [step.ends.begin_rad_s[axis], step.ends.end_rad_s[axis]];
            self.slews.check_ends(&direction, moved, ends)?;
        }
        Ok(())
    }

    /// Largest component along a direction of rates relative to a share of the momentum.
    fn largest_rate(&self, direction: &Vector3<f64>, share: f64) -> f64 {
        let size = self.held[0].norm();
        let lever = self.slews.inverses[0] * direction - direction * share;
        let reached = self.slews.reached_rate(direction) + lever.norm() * size;
        reached.min(self.slews.allowed_rate(direction) + share * size)
    }

    /// Largest component along a direction of `(J_eff^-1 - k) (R^T H x w)`, at the corners of the box of rates and by
    /// the limit of their norm.
    fn largest_gyroscopic(&self, direction: &Vector3<f64>, share: f64) -> f64 {
        let lever = self.slews.inverses[1] * direction - direction * share;
        let rates = self.body_rates();
        let corners = (0..8_u8).map(|corner| {
            let signed = |axis: usize| {
                if corner >> axis & 1 == 0 {
                    rates[axis]
                } else {
                    -rates[axis]
                }
            };
            lever.cross(&Vector3::from([0, 1, 2].map(signed))).norm()
        });
        // Unlimited rates give no number, which any other one exceeds.
        let by_corner = corners.fold(0.0, |most, x| {
            if x.is_nan() {
                f64::INFINITY
            } else {
                x.max(most)
            }
        });
        let by_norm = lever.norm() * self.slews.scenario.spacecraft().max_rate_norm();
        if lever == Vector3::zeros() {
            return 0.0;
        }
        by_corner.min(by_norm) * self.held[0].norm()
    }

    /// The largest rates about the body axes.
    fn body_rates(&self) -> Vector3<f64> {
        let limits = self.slews.scenario.spacecraft().max_rate();
        Vector3::from_fn(|axis, _| {
            let direction = Vector3::ith(axis, 1.0);
            let lever = self.slews.inverses[0] * direction;
            let reached = self.slews.reached_rate(&direction) + lever.norm() * self.held[0].norm();
            reached.min(limits[axis])
        })
    }

    fn growth_from_rest(&self) -> Growth {
        let (rates, norm) = (
            self.body_rates(),
            self.slews.scenario.spacecraft().max_rate_norm(),
        );
        let axes = Matrix3::<f64>::identity();
        let along = |quantity: &dyn Fn(&Vector3<f64>) -> f64| {
            Vector3::from_fn(|axis, _| quantity(&axes.column(axis).into_owned()))
        };
        let by_torques = along(&|direction| self.slews.largest_acceleration(direction));
        let by_momentum = along(&|direction| self.largest_gyroscopic(direction, 0.0));
        let gauge =
            |vector: &Vector3<f64>| vector.component_div(&rates).max().max(vector.norm() / norm);
        Growth {
            first: gauge(&Vector3::repeat(RATE_TOLERANCE)),
            alpha: gauge(&by_torques),
            gamma: gauge(&by_momentum),
        }
    }

    /// Whether a slope exceeds the acceleration along a direction, or a chord with it the growth from rest to a rate.
    fn grants(&self, direction: &Vector3<f64>, share: f64, rate: f64, slope: f64) -> bool {
        let by_torques = self.slews.largest_acceleration(direction);
        let by_momentum = self.largest_gyroscopic(direction, share);
        if within((by_torques + by_momentum) * EXCEEDED, slope) {
            return true;
        }
        let rest = |(low, high): &(f64, f64)| low.abs().max(high.abs()) <= RATE_TOLERANCE;
        if !self.slews.ranges.iter().flatten().all(rest) {
            return false;
        }
        let time = rate / slope;
        let grown = by_torques * time + by_momentum * self.growth_from_rest().integral(time);
        within(grown * EXCEEDED, rate)
    }
}

impl Growth {
    /// `int_0^t min(1, mu)`, s.
    fn integral(&self, time: f64) -> f64 {
        let Self {
            first,
            alpha,
            gamma,
        } = *self;
        if !(gamma > 0.0 && alpha.is_finite()) {
            return time;
        }
        let full = ((gamma + alpha) / (gamma * first + alpha)).ln() / gamma;
        let until = time.min(full);
        let gauge = |at: f64| first * (gamma * at).exp() + alpha * (gamma * at).exp_m1() / gamma;
        let step = until / f64::from(INTERVALS);
        let weighted = (0..=INTERVALS).map(|n| {
            let weight = match n {
                0 | INTERVALS => 1.0,
                _ if n % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * gauge(step * f64::from(n))
        });
        weighted.sum::<f64>() * step / 3.0 + (time - until)
    }
}
