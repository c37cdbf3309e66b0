//! The eigenaxis slew: the usual baseline, and a starting guess.
//!
//! Bang-coast-bang about a fixed axis with the wheels allocated by the pseudo-inverse and their
//! null-space momentum constant. Without total momentum its limits are constant in time; with it
//! they vary, and the slew is slowed down until all of them hold everywhere.

use crate::leg::profile::Profile;
use crate::math::bang_coast_bang::BangCoastBang;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use nalgebra::{DVector, Vector3};

/// Points at which limits are tested when momentum makes them vary.
const SAMPLES: usize = 65;
/// Halvings of the slow-down factor's interval: six digits of the duration.
const BISECTIONS: usize = 24;
/// Smallest slow-down factor that is tried.
const SLOWEST: f64 = 1e-3;

/// Intervals of a ramp in a starting guess.
const RAMP_INTERVALS: usize = 2;
/// Share of the duration below which a coast has no nodes of its own.
const MIN_COAST: f64 = 1e-3;
/// Perturbation of a starting guess across the axis, as a share of the peak rate.
const PERTURBATION: f64 = 0.1;

/// The side of the eigenaxis to which a guess is perturbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Perturbation {
    /// One side.
    Near,
    /// The opposite side.
    Far,
}

impl Perturbation {
    fn sign(self) -> f64 {
        match self {
            Self::Near => 1.0,
            Self::Far => -1.0,
        }
    }
}

/// A slew about the eigenaxis between two attitudes with given signs.
#[derive(Debug, Clone)]
pub(crate) struct EigenaxisSlew {
    from: Attitude,
    axis: Vector3<f64>,
    null: DVector<f64>,
    /// Angle and rate over time.
    pub(crate) course: BangCoastBang,
    /// Whether all limits hold.
    pub(crate) flyable: bool,
}

impl EigenaxisSlew {
    /// The fastest rest-to-rest slew of this kind; `null` is the wheels' null-space momentum.
    pub(crate) fn fastest(
        dynamics: &Dynamics,
        from: &Attitude,
        to: &Attitude,
        null: &DVector<f64>,
    ) -> Self {
        let turn = from.signed_turn_to(to);
        let angle = turn.norm();
        let axis = if angle > 0.0 {
            turn / angle
        } else {
            Vector3::x()
        };
        let acceleration = dynamics.axis_acceleration(&axis);
        let rate = dynamics.axis_rate(&axis);
        let at_factor = |factor: f64| Self {
            from: *from,
            axis,
            null: null.clone(),
            course: BangCoastBang::fastest(angle, acceleration * factor * factor, rate * factor),
            flyable: true,
        };
        let full = at_factor(1.0);
        if full.usage(dynamics) <= 1.0 + 1e-9 {
            return full;
        }
        let (mut slow, mut fast) = (SLOWEST, 1.0);
        if at_factor(slow).usage(dynamics) > 1.0 {
            return Self {
                flyable: false,
                ..at_factor(0.5)
            };
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (slow + fast);
            if at_factor(middle).usage(dynamics) <= 1.0 {
                slow = middle;
            } else {
                fast = middle;
            }
        }
        at_factor(slow)
    }

    /// The same slew, slower where it takes less than a time, s, that is not zero.
    pub(crate) fn lasting(self, least: f64) -> Self {
        if self.course.duration() >= least {
            return self;
        }
        Self {
            course: BangCoastBang::lasting(self.course.angle(), least),
            ..self
        }
    }

    fn state(&self, dynamics: &Dynamics, time: f64) -> (Attitude, Vector3<f64>, DVector<f64>) {
        let (angle, rate, _) = self.course.at(time);
        let attitude = self.from.retract(self.axis * angle);
        let rate = self.axis * rate;
        let wheels = dynamics.wheels_at(&attitude, &rate, &self.null);
        (attitude, rate, wheels)
    }

    /// Greatest share of any torque, speed or rate limit during the slew.
    fn usage(&self, dynamics: &Dynamics) -> f64 {
        let mut worst = 0.0_f64;
        for sample in 0..SAMPLES {
            let time = self.course.duration() * sample as f64 / (SAMPLES - 1) as f64;
            let (attitude, rate, wheels) = self.state(dynamics, time);
            let (_, _, acceleration) = self.course.at(time);
            let body = attitude.to_body(dynamics.momentum);
            let change = -rate.cross(&body) - dynamics.inertia * self.axis * acceleration;
            let torque = &dynamics.axes_inverse * change;
            worst = worst
                .max(dynamics.speed_usage(&rate, &wheels))
                .max(dynamics.torque_usage(&torque));
        }
        worst
    }

    /// The slew itself: nodes where its ramps end, and evenly between them.
    pub(crate) fn exact(&self, dynamics: &Dynamics, intervals: usize) -> Profile {
        let ramp = intervals / 3;
        let coast = intervals - 2 * ramp;
        let (ramping, duration) = (self.course.ramp(), self.course.duration());
        let coasting = (duration - 2.0 * ramping).max(0.0);
        let mut profile = Profile::empty();
        let mut push = |time: f64| {
            let (attitude, _, wheels) = self.state(dynamics, time);
            profile.attitudes.push(attitude);
            profile.wheels.push(wheels);
        };
        for node in 0..ramp {
            push(ramping * node as f64 / ramp as f64);
        }
        for node in 0..coast {
            push(ramping + coasting * node as f64 / coast as f64);
        }
        for node in (0..=ramp).rev() {
            push(duration - ramping * node as f64 / ramp as f64);
        }
        profile.lengths = [(ramp, ramping), (coast, coasting), (ramp, ramping)]
            .into_iter()
            .flat_map(|(count, time)| std::iter::repeat_n(time / count as f64, count))
            .collect();
        profile
    }

    /// A direction perpendicular to the axis that does not depend on the body frame: across the
    /// wheel axis that is least along the eigenaxis, the first of equal ones.
    fn across(&self, dynamics: &Dynamics) -> Vector3<f64> {
        let (mut across, mut least) = (Vector3::zeros(), f64::INFINITY);
        for wheel in &dynamics.actuators {
            let axis = wheel.axis.normalize();
            let along = axis.dot(&self.axis).abs();
            if along < least - 1e-6 {
                (across, least) = (self.axis.cross(&axis), along);
            }
        }
        // Wheel axes span space, so not all of them are parallel to the eigenaxis.
        across.normalize()
    }

    /// The direction across the axis to one side of which guesses are moved, oblique to that of
    /// [`Self::across`].
    fn aside(&self, dynamics: &Dynamics) -> Vector3<f64> {
        let across = self.across(dynamics);
        (across + across.cross(&self.axis)).normalize()
    }

    /// The turn, rad, and the direction across it to one side.
    pub(super) fn geometry(&self, dynamics: &Dynamics) -> (Vector3<f64>, Vector3<f64>) {
        let turn = self.axis * self.course.angle();
        (turn, self.aside(dynamics))
    }

    /// The slew sampled at its nodes, as a starting guess; it has to take some time.
    ///
    /// The exact slew is a stationary point whenever it lies in a plane of symmetry, and a local
    /// solver then stays on it; a small rate across the axis breaks the symmetry.
    pub(crate) fn guess(
        &self,
        dynamics: &Dynamics,
        intervals: usize,
        side: Perturbation,
    ) -> Profile {
        let times = node_times(&self.course, intervals);
        let peak = self.course.rate();
        let direction = self.aside(dynamics);
        let most = 0.5 * dynamics.axis_rate(&direction);
        let across = direction * (side.sign() * (PERTURBATION * peak).min(most));
        let mut profile = Profile::empty();
        for (node, time) in times.iter().enumerate() {
            let (attitude, rate, _) = self.state(dynamics, *time);
            let phase = std::f64::consts::PI * time / self.course.duration();
            // Exactly zero at both ends, where the rates are given.
            let perturbed = rate
                + if node < intervals {
                    across * phase.sin()
                } else {
                    Vector3::zeros()
                };
            let wheels = dynamics.wheels_at(&attitude, &perturbed, &self.null);
            profile.wheels.push(wheels);
            profile.attitudes.push(attitude);
        }
        profile.lengths = times.windows(2).map(|t| t[1] - t[0]).collect();
        profile
    }
}

/// Times of the nodes of a course, s: each ramp has [`RAMP_INTERVALS`] where equal intervals would
/// be longer.
fn node_times(course: &BangCoastBang, intervals: usize) -> Vec<f64> {
    let even = |begin: f64, end: f64, count: usize| {
        (0..count).map(move |i| begin + (end - begin) * i as f64 / count as f64)
    };
    let (ramp, end) = (course.ramp(), course.duration());
    let equal = end / intervals as f64;
    let finer = ramp < equal * RAMP_INTERVALS as f64 && end - 2.0 * ramp > MIN_COAST * end;
    let mut times: Vec<f64> = if finer && intervals > 2 * RAMP_INTERVALS {
        even(0.0, ramp, RAMP_INTERVALS)
            .chain(even(ramp, end - ramp, intervals - 2 * RAMP_INTERVALS))
            .chain(even(end - ramp, end, RAMP_INTERVALS))
            .collect()
    } else {
        even(0.0, end, intervals).collect()
    };
    times.push(end);
    times
}
