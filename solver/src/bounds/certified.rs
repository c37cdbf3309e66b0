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
//! these axes a turn has the components of its rotation vector in the frame. Tried are up to nine
//! frames whose first axis is across a facet of what the wheels reach ([`Facets`]), those that promise
//! most for the turn, body axes, and the axes nearest to those of the wheels. Each gives a proved
//! bound, and the largest one is used.
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
//! rotation, which may be the shorter way round, and by its angle at the largest rate.

mod momentum;
mod norms;
mod rolls;

use crate::bounds::kinematic::certificate::{Certificate, DriftCertificate};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::kinematic::ramps::SlewBound;
use crate::bounds::kinematic::rate_envelope::RateEnvelope;
use crate::bounds::kinematic::strongest::{Alternatives, GivenAway};
use crate::model::attitude::Attitude;
use crate::model::dynamics::facets::{Facets, FrameKey};
use crate::model::dynamics::{Dynamics, along, component};
use crate::model::scenario::RateCondition;
use crate::model::tolerances::{ATTITUDE_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE};
use crate::model::waypoint::Waypoint;
use momentum::{HeldSlew, MomentumBounds};
use nalgebra::{Matrix3, Vector3};
pub(crate) use norms::NormBound;
use norms::Norms;
use rolls::{given_away, least_over_rolls};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Version of the mathematics of the bounds. A stored bound of another version is not used: raise it
/// whenever a bound that was given before could be above one that is given now.
pub const VERSION: u32 = 5;

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
/// Largest number of frames with end rates whose boxes are cached, some 0.1 MB for each box that was
/// needed; others are prepared again for every leg.
const MAX_PREPARED: usize = 512;

/// Lower bounds on the slews of one spacecraft. The boxes of a frame for a combination of end rates
/// are prepared when they are first needed, and shared between threads.
#[derive(Debug)]
pub(crate) struct CertifiedBounds {
    /// The frames that every leg tries; with momentum, those of legs with a free roll.
    frames: Vec<BodyFrame>,
    /// Gives further ones.
    spacecraft: Dynamics,
    facets: Facets,
    /// Bounds with momentum, used in place of the frames where both attitudes are given.
    momentum: Option<MomentumBounds>,
    /// Norm of the body rate that no motion exceeds, rad/s; infinite without limits of speed.
    largest_rate: f64,
    prepared: Mutex<HashMap<(Frame, EndKey), Arc<PreparedFrame>>>,
    norms: Mutex<HashMap<EndKey, Arc<Norms>>>,
}

/// A frame by its number among those that every leg tries, or by its facets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Frame {
    Fixed(usize),
    Fitted(FrameKey),
}

/// A frame with its bound for some end rates.
#[derive(Debug)]
struct PreparedFrame {
    axes: Matrix3<f64>,
    bound: Option<SlewBound>,
}

/// A bound on the slews between the rolls around those of two waypoints.
struct BoundAround {
    bound_s: f64,
    /// The frame and the number of the box that give it.
    frame: Arc<PreparedFrame>,
    tried: usize,
}

impl BoundAround {
    /// What the same box gives between other rolls, s; `None` where the turn is no number.
    fn between(&self, ends: [&Waypoint; 2], halves: [f64; 2]) -> Option<f64> {
        let turn = ends[0].attitude.turn_to(&ends[1].attitude);
        let frame = std::slice::from_ref(&self.frame);
        let (alternatives, _) = seen(&turn, frame, |axes| given_away(ends, halves, axes));
        alternatives.of_box(0, self.tried, TOLERANCE)
    }
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
        let frames: Vec<_> = match &momentum {
            Some(bounds) => bounds.without_drift().collect(),
            None => axes
                .iter()
                .map(|axes| BodyFrame::of(dynamics, *axes))
                .collect(),
        };
        let norms = frames.iter().map(BodyFrame::largest_rate);
        Self {
            largest_rate: norms.fold(f64::INFINITY, f64::min),
            facets: Facets::of(dynamics),
            spacecraft: dynamics.clone(),
            frames,
            momentum,
            prepared: Mutex::default(),
            norms: Mutex::default(),
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
        let ends = [from, to];
        if from.roll.is_some() || to.roll.is_some() {
            return least_over_rolls(ends, |ends, halves| self.around_rolls(ends, halves));
        }
        if self.momentum.is_some() {
            return Some(self.drift_certificate(from, to, momentum)?.duration_s);
        }
        Some(self.around_rolls(ends, [0.0; 2])?.bound_s)
    }

    /// Lower bound on the duration of any slew between rolls that differ from those of two waypoints by so
    /// much at most, rad.
    fn around_rolls(&self, ends: [&Waypoint; 2], halves: [f64; 2]) -> Option<BoundAround> {
        let turn = ends[0].attitude.turn_to(&ends[1].attitude);
        let prepared = self.prepared_for(&turn, ends.map(rate_limits))?;
        let (alternatives, frames) = seen(&turn, &prepared, |axes| given_away(ends, halves, axes));
        let strongest = alternatives.strongest(TOLERANCE)?;
        Some(BoundAround {
            bound_s: strongest.bound_s,
            frame: Arc::clone(frames[strongest.alternative]),
            tried: strongest.tried,
        })
    }

    /// A smaller bound that is known at once, s: the angle of the turn, rad, at the largest rate of all
    /// motions. 0 without limits of speed.
    pub(crate) fn at_largest_rate(&self, angle: f64) -> f64 {
        ((angle - 2.0 * MISSED_ATTITUDE) / self.largest_rate).max(0.0)
    }

    /// The certificate of the bound [`Self::leg`] and the axes in which it is expressed; `None`
    /// where nothing is proved, and with momentum or a free roll, for which there is no verification.
    pub(crate) fn certificate(
        &self,
        from: &Waypoint,
        to: &Waypoint,
    ) -> Option<(Matrix3<f64>, Certificate)> {
        if self.momentum.is_some() || from.roll.is_some() || to.roll.is_some() {
            return None;
        }
        let turn = from.attitude.turn_to(&to.attitude);
        let prepared = self.prepared_for(&turn, [rate_limits(from), rate_limits(to)])?;
        let (alternatives, frames) = seen(&turn, &prepared, |_| GivenAway::default());
        let strongest = alternatives.strongest(TOLERANCE)?;
        let certificate = alternatives.certificate(&strongest, TOLERANCE);
        Some((frames[strongest.alternative].axes, certificate))
    }

    /// The certificate of the bound [`Self::leg`] with momentum, N m s, in the frame of the two attitudes; `None`
    /// without, where nothing is proved, and with a free roll, for which there is no verification.
    pub(crate) fn drift_certificate(
        &self,
        from: &Waypoint,
        to: &Waypoint,
        momentum: &Vector3<f64>,
    ) -> Option<DriftCertificate> {
        if from.roll.is_some() || to.roll.is_some() {
            return None;
        }
        let ends = [from, to];
        let slew = HeldSlew {
            turn: from.attitude.turn_to(&to.attitude),
            held: ends.map(|end| end.attitude.to_body(*momentum)),
            ends: ends.map(rate_limits),
        };
        self.momentum.as_ref()?.leg(&slew, TOLERANCE)
    }

    /// The largest bound that norms prove on slews between two waypoints that turn by an angle, rad, as far as signs
    /// count, if it exceeds the one that [`Self::leg`] gives. Takes milliseconds. `None` with a free roll too, for
    /// which there are no such bounds, and mostly with momentum, for which there is that of the Euclidean norm alone.
    pub(crate) fn beyond(
        &self,
        [from, to]: [&Waypoint; 2],
        angle: f64,
        known_s: f64,
    ) -> Option<NormBound> {
        if from.roll.is_some() || to.roll.is_some() {
            return None;
        }
        let rates = self.frames.first()?.limits.rates_rad_s;
        let ends = [from, to].map(|end| rate_limits(end).zip_map(&rates, rounded_up));
        let turn = from.attitude.turn_to(&to.attitude);
        let norms = self.norms_for(&ends);
        norms.beyond((&turn, angle), MISSED_ATTITUDE, known_s, TOLERANCE)
    }

    fn norms_for(&self, ends: &[Vector3<f64>; 2]) -> Arc<Norms> {
        let lock = || self.norms.lock().unwrap_or_else(PoisonError::into_inner);
        let kind = end_key(ends);
        if let Some(known) = lock().get(&kind) {
            return Arc::clone(known);
        }
        let facets = self.facets.normals();
        let fresh = Arc::new(Norms::new(&self.spacecraft, &self.frames, &facets, ends));
        let mut known = lock();
        if known.len() < MAX_PREPARED {
            known.insert(kind, Arc::clone(&fresh));
        }
        fresh
    }

    /// The frames for a turn and their bounds for end rates within these limits, body axes.
    fn prepared_for(
        &self,
        turn: &Attitude,
        ends: [Vector3<f64>; 2],
    ) -> Option<Vec<Arc<PreparedFrame>>> {
        let rates = self.frames.first()?.limits.rates_rad_s;
        let ends = ends.map(|end| end.zip_map(&rates, rounded_up));
        let identity = Attitude::identity();
        let turn = identity.signed_turn_to(&turn.nearest_sign(&identity));
        let fixed = (0..self.frames.len()).map(Frame::Fixed);
        // Stored momentum changes what wheels reach across their facets.
        let fitted = match self.momentum {
            Some(_) => Vec::new(),
            None => self.facets.frames(&turn),
        };
        let fitted = fitted.into_iter().map(Frame::Fitted);
        let mut prepared: Vec<Arc<PreparedFrame>> = Vec::new();
        for frame in fixed.chain(fitted) {
            let frame = self.prepared(frame, &ends);
            if !prepared.iter().any(|known| known.has_axes_of(&frame)) {
                prepared.push(frame);
            }
        }
        Some(prepared)
    }

    fn prepared(&self, frame: Frame, ends: &[Vector3<f64>; 2]) -> Arc<PreparedFrame> {
        let kind = end_key(ends);
        let lock = || self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&(frame, kind)) {
            return Arc::clone(known);
        }
        // Computed without the lock: two threads may prepare the same, with the same result.
        let fitted = |key| BodyFrame::of(&self.spacecraft, self.facets.axes(key));
        let body_frame = match frame {
            Frame::Fixed(index) => self.frames[index],
            Frame::Fitted(key) => fitted(key),
        };
        let fresh = Arc::new(PreparedFrame {
            axes: body_frame.axes,
            bound: body_frame.bound(ends),
        });
        let mut known = lock();
        if known.len() < MAX_PREPARED {
            known.insert((frame, kind), Arc::clone(&fresh));
        }
        fresh
    }
}

impl PreparedFrame {
    /// Whether the axes are those of another frame, in any order and of any sign: the boxes are the
    /// same.
    fn has_axes_of(&self, other: &Self) -> bool {
        let along = self.axes.tr_mul(&other.axes).abs();
        along
            .column_iter()
            .all(|column| column.max() > 1.0 - SAME_AXES * SAME_AXES)
    }
}

/// The bounds of frames on a turn, with what is given away in the axes of each, and these frames.
fn seen<'p>(
    turn: &Attitude,
    prepared: &'p [Arc<PreparedFrame>],
    away: impl Fn(&Matrix3<f64>) -> GivenAway,
) -> (Alternatives<'p>, Vec<&'p Arc<PreparedFrame>>) {
    let (mut alternatives, mut frames) = (Alternatives::default(), Vec::new());
    for frame in prepared {
        if let Some((bound, turn)) = frame.bound.as_ref().zip(turn.seen_from(&frame.axes)) {
            alternatives.add(bound, turn, away(&frame.axes));
            frames.push(frame);
        }
    }
    (alternatives, frames)
}

impl BodyFrame {
    fn of(dynamics: &Dynamics, axes: Matrix3<f64>) -> Self {
        let rate = |axis: &Vector3<f64>| dynamics.greatest_rate(axis);
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
        let bound = SlewBound::new(self.limits, self.end_rates(ends))?;
        Some(bound.missing(MISSED_ATTITUDE))
    }

    /// The limits during slews with such end rates; `None` without limits of speed.
    fn envelope(&self, ends: &[Vector3<f64>; 2]) -> Option<RateEnvelope> {
        let is_limited = self.limits.rates_rad_s.iter().all(|rate| rate.is_finite());
        is_limited.then(|| RateEnvelope {
            limits: self.limits,
            ends: self.end_rates(ends),
        })
    }

    fn end_rates(&self, ends: &[Vector3<f64>; 2]) -> EndRates {
        EndRates {
            begin_rad_s: self.limits_in_axes(&ends[0]),
            end_rad_s: self.limits_in_axes(&ends[1]),
        }
    }

    /// Limits of the components along the frame's axes, from limits along the body axes.
    fn limits_in_axes(&self, limits: &Vector3<f64>) -> Vector3<f64> {
        along(&self.axes, |axis| component(axis, limits))
    }
}

fn end_key(ends: &[Vector3<f64>; 2]) -> EndKey {
    ends.map(|end| end.map(f64::to_bits).into())
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
