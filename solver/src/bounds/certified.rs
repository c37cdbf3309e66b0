//! Certified bounds: proved lower bounds on the durations of a spacecraft's slews.
//!
//! [`crate::bounds::kinematic`] bounds slews whose rates and accelerations stay in boxes. This
//! module computes, for a spacecraft, boxes that contain all reachable rates and accelerations and,
//! for a leg, limits of the rates at its ends.
//!
//! # The boxes
//!
//! Without momentum `J w = -h_locked - sum a_i I_i W_i` and `J_eff w' = -A u` at every attitude:
//! rates and accelerations are linear images of boxes of wheel speeds and torques. The largest
//! component along any direction is a linear program over a box, whose solution has every wheel at
//! one of its limits ([`Dynamics::reachable_rate`], [`Dynamics::reachable_acceleration`]), for any
//! inertia and any axes. Limits of the rate's components and norm reduce the rates further. So for
//! every orthonormal frame fixed in the body there are boxes in its axes that no motion leaves. In
//! these axes a turn has the components of its rotation vector in the frame. Body axes and the axes
//! nearest to those of the wheels are tried; each gives a proved bound, and the larger one is used.
//!
//! # The ends
//!
//! A rate component that is stopped or prescribed is known at the end of a leg; one within a range
//! is limited by its larger end (both are rounded up, [`SHARES`]); a free one is not limited.
//! Nothing else is used, so **the bound holds for the leg as part of any tour with the same
//! conditions at its two ends**, and the bounds of the legs of a tour can be summed. In a tour
//! through targets with free components only the first and last legs begin or end at rest, so the
//! ramps of these components count in these legs only.
//!
//! # The tolerances
//!
//! The bounds hold for every flight that the checker accepts, not only for one that meets its
//! conditions exactly. It may miss attitudes and rates and exceed limits by the tolerances of
//! [`crate::model::tolerances`], which are given away:
//!
//! * both ends of a leg are missed by [`MISSED_ATTITUDE`] ([`SlewBound::missing`]);
//! * conditions on rates at its ends are widened by [`MISSED_RATE`], body axes;
//! * torques and wheel speeds are larger by [`EXCEEDED_LIMITS`], and so are the boxes, which are
//!   linear in them, and limits of the body rate.
//!
//! The state at the start is met exactly. Its tolerance is given away nevertheless: one leg in a
//! tour, and canonical legs do not tell their ends apart. What the checker allows of times is a
//! matter of whole tours.
//!
//! # Limitations
//!
//! Without limits of speed there is no box of rates and no bound. Stored momentum has boxes of its
//! own ([`momentum`]). A turn whose quaternion has to arrive with a given sign is bounded as a
//! rotation, which may be the shorter way round.

mod momentum;

use crate::bounds::kinematic::certificate::Certificate;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::model::attitude::Attitude;
use crate::model::dynamics::{Dynamics, along};
use crate::model::scenario::RateCondition;
use crate::model::tolerances::{ATTITUDE_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE};
use crate::model::waypoint::Waypoint;
use momentum::MomentumBounds;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Version of the mathematics of the bounds. A stored bound of another version is not used: raise it
/// whenever a bound that was given before could be above one that is given now.
pub const VERSION: u32 = 2;

/// Tolerances are given away with a thousandth more, far above the rounding of turns and the errors of
/// the checker's integration.
const GIVEN: f64 = 1.001;
/// Largest angle, rad, by which the attitude at an end of a leg is missed.
const MISSED_ATTITUDE: f64 = GIVEN * ATTITUDE_TOLERANCE;
/// Largest error of a body rate component at an end of a leg, rad/s.
const MISSED_RATE: f64 = GIVEN * RATE_TOLERANCE;
/// Torques, wheel speeds and body rates, relative to their limits.
const EXCEEDED_LIMITS: f64 = 1.0 + GIVEN * LIMIT_TOLERANCE;

/// Relative accuracy of the least times: a tenth of the gap that the ramps leave.
const TOLERANCE: f64 = 1e-4;

/// Difference of two frames' axes below which they are treated as one.
const SAME_AXES: f64 = 1e-6;

/// End rates that are neither stopped nor free are rounded up to these shares of the spacecraft's
/// largest rates, so that few combinations of end rates occur.
const SHARES: [f64; 2] = [0.25, 0.5];
/// Largest number of combinations of end rates whose boxes are cached, some 1 MB each; others are
/// prepared again for every leg.
const MAX_KINDS: usize = 64;

/// Lower bounds on the slews of one spacecraft. The boxes for a combination of end rates are
/// prepared when they are first needed, and shared between threads.
#[derive(Debug)]
pub(crate) struct CertifiedBounds {
    frames: Vec<BodyFrame>,
    /// Bounds with momentum, used in place of the frames.
    momentum: Option<MomentumBounds>,
    /// Norm of the body rate that no motion exceeds, rad/s; infinite without limits of speed.
    largest_rate: f64,
    prepared: Mutex<HashMap<EndKey, Arc<[Option<SlewBound>]>>>,
}

/// Limits of all motions in axes fixed in the body.
#[derive(Debug, Clone, Copy)]
struct BodyFrame {
    /// Its axes as columns, in body axes.
    axes: Matrix3<f64>,
    limits: SlewLimits,
}

/// Bit patterns of the limits of the rates at begin and end, per body axis.
type EndKey = [[u64; 3]; 2];

impl CertifiedBounds {
    /// The bounds of a spacecraft.
    pub(crate) fn of(dynamics: &Dynamics) -> Self {
        let mut axes = vec![Matrix3::identity(), dynamics.wheel_axes()];
        if (axes[1] - axes[0]).amax() <= SAME_AXES {
            axes.truncate(1);
        }
        let momentum = dynamics
            .has_momentum()
            .then(|| MomentumBounds::of(dynamics, &axes));
        let frames = if momentum.is_some() {
            Vec::new()
        } else {
            axes.iter()
                .map(|axes| BodyFrame::of(dynamics, *axes))
                .collect()
        };
        let norms = frames.iter().map(BodyFrame::largest_rate);
        let largest_rate = norms.chain(momentum.as_ref().map(MomentumBounds::largest_rate));
        Self {
            largest_rate: largest_rate.fold(f64::INFINITY, f64::min),
            frames,
            momentum,
            prepared: Mutex::default(),
        }
    }

    /// Lower bound, s, on the duration of any slew between two waypoints, whatever comes before and
    /// after it; `None` when nothing is proved. Wheel conditions are not used. The momentum, N m s,
    /// is the total one in the frame of the two attitudes.
    pub(crate) fn leg(
        &self,
        from: &Waypoint,
        to: &Waypoint,
        momentum: &Vector3<f64>,
    ) -> Option<f64> {
        let turn = from.attitude.turn_to(&to.attitude);
        let ends = [rate_limits(from), rate_limits(to)];
        if let Some(bounds) = &self.momentum {
            let held = [from, to].map(|end| end.attitude.to_body(*momentum));
            return bounds.leg(&turn, &held, &ends, TOLERANCE);
        }
        let prepared = self.prepared_for(ends)?;
        self.seen(&turn, &prepared)
            .map(|(_, bound, turn)| bound.lower_bound_s(&[turn], TOLERANCE))
            .reduce(f64::max)
    }

    /// A smaller bound that is known at once, s: the angle of the turn at the largest rate of all
    /// motions. 0 without limits of speed.
    pub(crate) fn at_largest_rate(&self, from: &Attitude, to: &Attitude) -> f64 {
        let angle = from.angle_to(to) - 2.0 * MISSED_ATTITUDE;
        (angle / self.largest_rate).max(0.0)
    }

    /// The certificate of the bound [`Self::leg`] and the axes in which it is expressed; `None`
    /// where nothing is proved, and with momentum, for which there is no verification.
    pub(crate) fn certificate(
        &self,
        from: &Waypoint,
        to: &Waypoint,
    ) -> Option<(Matrix3<f64>, Certificate)> {
        let turn = from.attitude.turn_to(&to.attitude);
        let prepared = self.prepared_for([rate_limits(from), rate_limits(to)])?;
        self.seen(&turn, &prepared)
            .map(|(axes, bound, turn)| (axes, bound.certificate(&[turn], TOLERANCE)))
            .max_by(|(_, a), (_, b)| a.duration_s.total_cmp(&b.duration_s))
    }

    /// The axes of the frames that have a bound, each with its bound and with the turn in these
    /// axes.
    fn seen<'s>(
        &'s self,
        turn: &'s Attitude,
        prepared: &'s [Option<SlewBound>],
    ) -> impl Iterator<Item = (Matrix3<f64>, &'s SlewBound, Attitude)> {
        let frames = self.frames.iter().zip(prepared);
        frames.filter_map(|(frame, bound)| {
            let turn = turn.seen_from(&frame.axes)?;
            Some((frame.axes, bound.as_ref()?, turn))
        })
    }

    /// The bounds of all frames for end rates within these limits, body axes.
    fn prepared_for(&self, ends: [Vector3<f64>; 2]) -> Option<Arc<[Option<SlewBound>]>> {
        let rates = self.frames.first()?.limits.rates_rad_s;
        Some(self.prepared(&ends.map(|end| end.zip_map(&rates, rounded_up))))
    }

    fn prepared(&self, ends: &[Vector3<f64>; 2]) -> Arc<[Option<SlewBound>]> {
        let kind: EndKey = ends.map(|end| end.map(f64::to_bits).into());
        let lock = || self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&kind) {
            return Arc::clone(known);
        }
        // Computed without the lock: two threads may prepare the same, with the same result.
        let fresh: Arc<[_]> = self.frames.iter().map(|frame| frame.bound(ends)).collect();
        let mut known = lock();
        if known.len() < MAX_KINDS {
            known.insert(kind, Arc::clone(&fresh));
        }
        fresh
    }
}

impl BodyFrame {
    fn of(dynamics: &Dynamics, axes: Matrix3<f64>) -> Self {
        let rate = |axis: &Vector3<f64>| {
            dynamics
                .reachable_rate(axis)
                .min(allowed_rate(dynamics, axis))
        };
        let acceleration = |axis: &Vector3<f64>| dynamics.reachable_acceleration(axis);
        Self {
            axes,
            limits: exceeded(SlewLimits {
                rates_rad_s: along(&axes, rate),
                accelerations_rad_s2: along(&axes, acceleration),
            }),
        }
    }

    /// Norm of the rate that no motion exceeds, rad/s.
    fn largest_rate(&self) -> f64 {
        self.limits.rates_rad_s.norm()
    }

    /// Bounds on slews with end rates within these limits, body axes.
    fn bound(&self, ends: &[Vector3<f64>; 2]) -> Option<SlewBound> {
        let ends = EndRates {
            begin_rad_s: self.limits_in_axes(&ends[0]),
            end_rad_s: self.limits_in_axes(&ends[1]),
        };
        Some(SlewBound::new(self.limits, ends)?.missing(MISSED_ATTITUDE))
    }

    /// Limits of the components along the frame's axes, from limits along the body axes.
    fn limits_in_axes(&self, limits: &Vector3<f64>) -> Vector3<f64> {
        along(&self.axes, |axis| component(axis, limits))
    }
}

/// What motions reach whose torques and speeds exceed their limits by the tolerance.
fn exceeded(limits: SlewLimits) -> SlewLimits {
    SlewLimits {
        rates_rad_s: limits.rates_rad_s * EXCEEDED_LIMITS,
        accelerations_rad_s2: limits.accelerations_rad_s2 * EXCEEDED_LIMITS,
    }
}

/// Limits of the rate components at a waypoint, rad/s, with the tolerance; infinite where they are
/// free.
fn rate_limits(waypoint: &Waypoint) -> Vector3<f64> {
    Vector3::from(waypoint.rate.map(|condition| match condition {
        RateCondition::Fixed(rate) => rate.abs() + MISSED_RATE,
        RateCondition::Within(low, high) => f64::max(low.abs(), high.abs()) + MISSED_RATE,
        RateCondition::Free => f64::INFINITY,
    }))
}

/// An end rate, rounded up to that of a stopped component, to one of the [`SHARES`] of the largest
/// rate, or to infinity.
fn rounded_up(rate: f64, largest: f64) -> f64 {
    if rate <= MISSED_RATE {
        return MISSED_RATE;
    }
    let mut steps = SHARES.iter().map(|share| share * largest);
    steps.find(|step| rate <= *step).unwrap_or(f64::INFINITY)
}

/// Largest component of the rate along a direction that the rate limits allow, rad/s.
fn allowed_rate(dynamics: &Dynamics, direction: &Vector3<f64>) -> f64 {
    component(direction, &dynamics.max_rate).min(dynamics.max_rate_norm * direction.norm())
}

/// Largest component along a direction of vectors whose components have these largest sizes.
fn component(direction: &Vector3<f64>, limits: &Vector3<f64>) -> f64 {
    let parts = direction.iter().zip(limits);
    // A component orthogonal to the direction does not contribute, even if it is infinite.
    parts.fold(0.0, |sum, (share, limit)| {
        sum + if *share == 0.0 {
            0.0
        } else {
            share.abs() * limit
        }
    })
}
