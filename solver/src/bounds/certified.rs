//! Certified bounds: durations that no slew of a spacecraft undercuts, proved.
//!
//! [`crate::bounds::kinematic`] bounds slews whose rates and accelerations stay in boxes. Here a
//! spacecraft gets boxes that contain all that its wheels can do, and a leg gets what is known of
//! the rates at its ends.
//!
//! # The boxes
//!
//! Without momentum `J w = -h_locked - sum a_i I_i W_i` and `J_eff w' = -A u` at every attitude: rates
//! and accelerations are linear images of boxes of wheel speeds and torques. The greatest component
//! along any direction is a linear program over a box, solved by taking every wheel at the limit
//! that suits it ([`Dynamics::reachable_rate`], [`Dynamics::reachable_acceleration`]), whatever the
//! inertia and the axes. Limits of the rate's components and norm cut the rates further. So for every
//! orthonormal frame fixed in the body there are boxes in its axes that nothing leaves. The rotation
//! vector of a turn seen from the frame is the turn to make there. Body axes and the axes nearest to
//! those of the wheels are tried: each is a proof, the larger bound counts.
//!
//! # The ends
//!
//! A rate component that is stopped or prescribed is known at the end of a leg; one within bounds is
//! at most as large as the larger of these (both are rounded up, [`SHARES`]); of one that is free
//! nothing is known. Nothing else is used, so **the bound holds for the leg as part of any tour with
//! the same conditions at its two ends**, and bounds of the legs of a tour add up. In a tour through
//! targets with free components only its first and last legs begin or end at rest, so the ramps of
//! these components are counted there and nowhere else.
//!
//! # What is not bounded
//!
//! Without limits of speed there is no box of rates, and then there is no bound. Stored momentum has
//! boxes of its own ([`momentum`]). A turn whose
//! quaternion has to arrive with a given sign is bounded as the rotation that it also is, which may
//! be the shorter way round.

mod momentum;

use crate::bounds::kinematic::certificate::Certificate;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::model::attitude::Attitude;
use crate::model::dynamics::{Dynamics, along};
use crate::model::scenario::RateCondition;
use crate::model::waypoint::Waypoint;
use momentum::MomentumBounds;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Relative accuracy of the least times: a tenth of what the ramps leave open.
const TOLERANCE: f64 = 1e-4;

/// Frames nearer to each other than this give one bound.
const SAME_AXES: f64 = 1e-6;

/// Rates at the ends that are neither stopped nor free count as these shares of the spacecraft's
/// largest rates, rounded up: so that few kinds of ends occur.
const SHARES: [f64; 2] = [0.25, 0.5];
/// Most kinds of ends whose boxes are kept, some 1 MB each; others are prepared again for every leg.
const MAX_KINDS: usize = 64;

/// Lower bounds on the slews of one spacecraft. What two ends of a kind have in common is prepared
/// when it is first needed, and shared between threads.
#[derive(Debug)]
pub(crate) struct CertifiedBounds {
    frames: Vec<BodyFrame>,
    /// With momentum, these are used instead.
    momentum: Option<MomentumBounds>,
    prepared: Mutex<HashMap<EndKey, Arc<[Option<SlewBound>]>>>,
}

/// What no motion exceeds, seen from axes fixed in the body.
#[derive(Debug, Clone, Copy)]
struct BodyFrame {
    /// Its axes as columns, in body axes.
    axes: Matrix3<f64>,
    limits: SlewLimits,
}

/// Bit patterns of what the rates do not exceed at begin and end, per body axis.
type EndKey = [[u64; 3]; 2];

impl CertifiedBounds {
    /// The bounds of a spacecraft with its momentum.
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
        Self {
            frames,
            momentum,
            prepared: Mutex::default(),
        }
    }

    /// A duration, s, that no slew between two waypoints undercuts, whatever happens before and
    /// after it; `None` when nothing is proved. Conditions of the wheels are not used. The momentum,
    /// N m s, is that of the spacecraft in the frame of the two attitudes.
    pub(crate) fn leg(
        &self,
        from: &Waypoint,
        to: &Waypoint,
        momentum: &Vector3<f64>,
    ) -> Option<f64> {
        let turn = from.attitude.turn_to(&to.attitude);
        let ends = [most(from), most(to)];
        if let Some(bounds) = &self.momentum {
            let held = [from, to].map(|end| end.attitude.to_body(*momentum));
            return bounds.leg(&turn, &held, &ends, TOLERANCE);
        }
        let prepared = self.prepared_for(ends)?;
        self.seen(&turn, &prepared)
            .map(|(_, bound, turn)| bound.lower_bound_s(&[turn], TOLERANCE))
            .reduce(f64::max)
    }

    /// The claim of [`Self::leg`] with all that a second proof needs, and the axes from which it is
    /// seen; `None` where nothing is proved, and with momentum, for which there is no second proof.
    pub(crate) fn certificate(
        &self,
        from: &Waypoint,
        to: &Waypoint,
    ) -> Option<(Matrix3<f64>, Certificate)> {
        let turn = from.attitude.turn_to(&to.attitude);
        let prepared = self.prepared_for([most(from), most(to)])?;
        self.seen(&turn, &prepared)
            .map(|(axes, bound, turn)| (axes, bound.certificate(&[turn], TOLERANCE)))
            .max_by(|(_, a), (_, b)| a.duration_s.total_cmp(&b.duration_s))
    }

    /// The axes of the frames that have a bound, with it and with a turn as it is seen from there.
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

    /// The bounds of all frames for ends with rates of these sizes at most, body axes.
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
        // Not under the lock: two threads may prepare the same, with the same result.
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
            limits: SlewLimits {
                rates_rad_s: along(&axes, rate),
                accelerations_rad_s2: along(&axes, acceleration),
            },
        }
    }

    /// Bounds on slews whose rates do not exceed these at begin and end, body axes.
    fn bound(&self, ends: &[Vector3<f64>; 2]) -> Option<SlewBound> {
        let ends = EndRates {
            begin_rad_s: self.seen(&ends[0]),
            end_rad_s: self.seen(&ends[1]),
        };
        SlewBound::new(self.limits, ends)
    }

    /// What the components along the frame's axes are at most, from those along the body axes.
    fn seen(&self, most: &Vector3<f64>) -> Vector3<f64> {
        along(&self.axes, |axis| component(axis, most))
    }
}

/// What the components of the rate do not exceed at a waypoint, rad/s; infinite where they are free.
fn most(waypoint: &Waypoint) -> Vector3<f64> {
    Vector3::from(waypoint.rate.map(|condition| match condition {
        RateCondition::Fixed(rate) => rate.abs(),
        RateCondition::Within(low, high) => f64::max(low.abs(), high.abs()),
        RateCondition::Free => f64::INFINITY,
    }))
}

/// A rate at an end, or what it is taken to be: never less.
fn rounded_up(rate: f64, largest: f64) -> f64 {
    if rate == 0.0 {
        return 0.0;
    }
    let mut steps = SHARES.iter().map(|share| share * largest);
    steps.find(|step| rate <= *step).unwrap_or(f64::INFINITY)
}

/// Greatest component of the rate along a direction that its limits allow, rad/s.
fn allowed_rate(dynamics: &Dynamics, direction: &Vector3<f64>) -> f64 {
    component(direction, &dynamics.max_rate).min(dynamics.max_rate_norm * direction.norm())
}

/// Greatest component along a direction of vectors whose components have these greatest sizes.
fn component(direction: &Vector3<f64>, most: &Vector3<f64>) -> f64 {
    let parts = direction.iter().zip(most);
    // A component across the direction does not count, infinite or not.
    parts.fold(0.0, |sum, (share, most)| {
        sum + if *share == 0.0 {
            0.0
        } else {
            share.abs() * most
        }
    })
}
