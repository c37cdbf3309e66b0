//! Bounds with stored momentum.
//!
//! `J w = R^T H - h_locked - sum a_i I_i W_i`: the momentum alone turns the body at the rate
//! `J^-1 R^T H`. With a spherical inertia, `J^-1 = k`, this is the constant rate `k H` in space. So
//! the rate relative to axes that turn with this *drift*,
//!
//! ```text
//!   v = w - k R^T H = J^-1 (- h_locked - sum a_i I_i W_i) + (J^-1 - k) R^T H,
//! ```
//!
//! has a box that the momentum widens only through the difference of the inertia from a sphere:
//! along a direction `d` by `|(J^-1 - k) d| |H|`, as `R^T H` may have any direction. As
//! `(R^T H)' = -w x R^T H` and `J_eff w' = -w x R^T H - A u`,
//!
//! ```text
//!   v' = -J_eff^-1 A u - (J_eff^-1 - k) (w x R^T H),
//! ```
//!
//! whose second term along `d` is at most `|H| max_w |(J_eff^-1 d - k d) x w|`; this is convex in
//! `w`, so its maximum is at a corner of the box of rates. It vanishes at rest, so slews that begin and
//! end at rest have gentler ramps ([`growth`]). Limits on `w` hold for `v` up to
//! `k |H|`. Rest at an end means `v = -k R^T H`, which is known there. Slews with a drift are
//! bounded in [`crate::bounds::kinematic`]. The tolerances are given away as without momentum. Any
//! `k` is valid. The middle of the eigenvalues of `J^-1` makes the box narrow; zero, with the box of
//! all rates, is better where rates have limits of their own.
//!
//! As without momentum a box fits best across the facet that limits the turn, so frames across facets are tried
//! beside the body axes and those of the wheels, each with both values of `k`.

mod growth;
#[cfg(test)]
mod tests;

use super::{BodyFrame, MAX_PREPARED, MISSED_ATTITUDE, MISSED_RATE, exceeded};
use crate::bounds::kinematic::certificate::{DriftCertificate, ExcludedDurations};
use crate::bounds::kinematic::drift::{DriftingSlew, Exclusion, drifting_bound};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use crate::model::attitude::Attitude;
use crate::model::dynamics::facets::{Facets, FrameKey};
use crate::model::dynamics::{Dynamics, along};
use growth::RateGrowth;
use nalgebra::{Matrix3, Vector3};
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

/// Least times that are computed for a first bound, and for the last one.
const FIRST_TRIED: usize = 3;
const MAX_TRIED: usize = 32;

/// Bounds on the slews of a spacecraft with momentum.
#[derive(Debug)]
pub(super) struct MomentumBounds {
    spacecraft: Dynamics,
    facets: Facets,
    growth: RateGrowth,
    /// The values of `k`, 1/(kg m²).
    shares: [f64; 2],
    /// The frames that every leg tries.
    frames: Vec<DriftingFrame>,
    /// Those across facets, with each share, as they were first needed.
    fitted: Mutex<HashMap<FrameKey, Arc<[Option<DriftingFrame>; 2]>>>,
}

/// Limits of all motions relative to a drift, with their bound.
#[derive(Debug)]
struct DriftingFrame {
    frame: BodyFrame,
    /// `k`, 1/(kg m²).
    share: f64,
    /// The limits of slews that begin and end at rest.
    from_rest: SlewLimits,
    bound: SlewBound,
}

/// A slew.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeldSlew {
    /// The turn that it makes.
    pub(super) turn: Attitude,
    /// The momentum at begin and end, N m s, body axes there.
    pub(super) held: [Vector3<f64>; 2],
    /// Limits of the rates there, rad/s, body axes.
    pub(super) ends: [Vector3<f64>; 2],
}

impl MomentumBounds {
    /// The bounds in some orthonormal frames, given as columns in body axes, and in others that fit.
    pub(super) fn of(dynamics: &Dynamics, frames: &[Matrix3<f64>]) -> Self {
        let shares = [0.0, dynamics.mean_inverse_inertia()];
        let growth = RateGrowth::of(dynamics);
        let all = frames
            .iter()
            .flat_map(|axes| shares.map(|share| (*axes, share)));
        Self {
            frames: all
                .filter_map(|(axes, share)| DriftingFrame::of(dynamics, &growth, axes, share))
                .collect(),
            facets: Facets::of(dynamics),
            growth,
            spacecraft: dynamics.clone(),
            shares,
            fitted: Mutex::default(),
        }
    }

    /// The frames whose limits are those of the body rate itself.
    pub(super) fn without_drift(&self) -> impl Iterator<Item = BodyFrame> {
        let without_drift = self.frames.iter().filter(|drifting| drifting.share == 0.0);
        without_drift.map(|drifting| drifting.frame)
    }

    /// Lower bound on the duration of a slew, with its premises; `None` without limits of speed.
    pub(super) fn leg(&self, slew: &HeldSlew, tolerance: f64) -> Option<DriftCertificate> {
        if self.frames.is_empty() {
            return None;
        }
        let view = |frame| DriftingFrame::see(frame, slew).map(|seen| (frame, seen));
        let (mut frames, mut seen): (Vec<_>, Vec<_>) = self.frames.iter().filter_map(view).unzip();
        let first = drifting_bound(&seen, 0.0, (FIRST_TRIED, tolerance));
        let keys = self.keys(slew, first.duration_s);
        let fitted: Vec<_> = keys.map(|key| self.fitted(key)).collect();
        let across = fitted.iter().flat_map(|frames| frames.iter().flatten());
        for (frame, slew) in across.filter_map(view) {
            frames.push(frame);
            seen.push(slew);
        }
        let last = drifting_bound(&seen, first.duration_s, (MAX_TRIED, tolerance));
        let steps = first.steps.iter().chain(&last.steps);
        let needed = steps.take_while(|step| step.range_s[0] < last.duration_s);
        Some(DriftCertificate {
            steps: needed
                .map(|step| frames[step.view].premises(&seen[step.view], step))
                .collect(),
            attitude_tolerance_rad: MISSED_ATTITUDE,
            duration_s: last.duration_s,
        })
    }

    /// Frames across the facets that a turn meets, and across those that what is left of it after a time, s,
    /// does relative to the drift.
    fn keys(&self, slew: &HeldSlew, time: f64) -> impl Iterator<Item = FrameKey> + use<> {
        let drift = slew.held[0] * self.shares[1];
        let left = Attitude::from_rotation_vector(-drift * time).then_in_body(&slew.turn);
        let identity = Attitude::identity();
        let keys = [slew.turn, left].map(|turn| {
            let vector = identity.signed_turn_to(&turn.nearest_sign(&identity));
            self.facets.frames(&vector)
        });
        let all: BTreeSet<FrameKey> = keys.concat().into_iter().collect();
        all.into_iter()
    }

    fn fitted(&self, key: FrameKey) -> Arc<[Option<DriftingFrame>; 2]> {
        let lock = || self.fitted.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key) {
            return Arc::clone(known);
        }
        // Computed without the lock: two threads may prepare the same, with the same result.
        let axes = self.facets.axes(key);
        let with = |share| DriftingFrame::of(&self.spacecraft, &self.growth, axes, share);
        let fresh = Arc::new(self.shares.map(with));
        let mut known = lock();
        if known.len() < MAX_PREPARED {
            known.insert(key, Arc::clone(&fresh));
        }
        fresh
    }
}

impl DriftingFrame {
    fn of(
        dynamics: &Dynamics,
        growth: &RateGrowth,
        axes: Matrix3<f64>,
        share: f64,
    ) -> Option<Self> {
        let drift = share * dynamics.momentum.norm();
        let rate = |axis: &Vector3<f64>| {
            dynamics
                .reachable_relative_rate(axis, share)
                .min(dynamics.allowed_rate(axis) + drift)
        };
        let acceleration = |axis: &Vector3<f64>| {
            dynamics.reachable_acceleration(axis) + dynamics.gyroscopic_acceleration(axis, share)
        };
        let reached = SlewLimits {
            rates_rad_s: along(&axes, rate),
            accelerations_rad_s2: along(&axes, acceleration),
        };
        let slopes = Vector3::from_fn(|axis, _| {
            let direction = axes.column(axis).into_owned();
            growth.slope(
                dynamics.reachable_acceleration(&direction),
                dynamics.gyroscopic_acceleration(&direction, share),
                reached.rates_rad_s[axis],
            )
        });
        let from_rest = exceeded(SlewLimits {
            accelerations_rad_s2: slopes,
            ..reached
        });
        Some(Self {
            frame: BodyFrame {
                axes,
                limits: exceeded(reached),
            },
            share,
            from_rest,
            bound: SlewBound::new(from_rest, EndRates::at_rest())?.missing(MISSED_ATTITUDE),
        })
    }

    /// What the exclusion of durations in these axes rests on.
    fn premises(&self, slew: &DriftingSlew<'_>, step: &Exclusion) -> ExcludedDurations {
        let [from_s, to_s] = step.range_s;
        ExcludedDurations {
            axes: self.frame.axes,
            share: self.share,
            drifts_rad_s: [slew.drift, slew.turn.to_body(slew.drift)],
            limits: slew.envelope.limits,
            ends: slew.envelope.ends,
            box_rad_s: step.box_rad_s,
            left: step.left,
            from_s,
            to_s,
        }
    }

    /// A slew in these axes; `None` where its turn is no number.
    fn see(&self, slew: &HeldSlew) -> Option<DriftingSlew<'_>> {
        let axes = &self.frame.axes;
        let drifts = slew.held.map(|held| axes.tr_mul(&held) * self.share);
        // Where the attitude is missed by an angle, so is the direction of the drift.
        let turned = drifts[0].norm() * MISSED_ATTITUDE;
        let ends = [0, 1].map(|end| {
            let most = self.frame.limits_in_axes(&slew.ends[end]) + drifts[end].abs();
            most.add_scalar(turned)
        });
        let envelope = RateEnvelope {
            limits: if slew.rests() {
                self.from_rest
            } else {
                self.frame.limits
            },
            ends: EndRates {
                begin_rad_s: ends[0],
                end_rad_s: ends[1],
            },
        };
        Some(DriftingSlew {
            bound: &self.bound,
            turn: slew.turn.seen_from(axes)?,
            drift: drifts[0],
            envelope,
        })
    }
}

impl HeldSlew {
    /// Whether both ends are at rest.
    fn rests(&self) -> bool {
        self.ends.iter().all(|end| end.max() <= MISSED_RATE)
    }
}
