//! Natural units in which every variable of the transcription is of order one.

use crate::model::dynamics::Dynamics;
use nalgebra::Vector3;

/// Unit of time as a share of a leg's duration: roughly the length of an interval.
const INTERVAL_SHARE: f64 = 0.2;
/// Peak rate of a leg in units of its mean rate, between one (a long coast) and two (none).
const PEAK_SHARE: f64 = 1.5;

/// Smallest turn, rad, from which units are derived; smaller ones count as none.
pub(crate) const MIN_TURN: f64 = 1e-9;

/// Units of the scaled variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    /// Unit of attitude steps, rad.
    pub(crate) angle: f64,
    /// Unit of time, s.
    pub(crate) time: f64,
    /// Unit of wheel momentum, N m s.
    pub(crate) momentum: f64,
    /// Unit of body rates, rad/s.
    pub(crate) rate: f64,
}

impl Scales {
    /// Units for legs that turn by a typical angle, rad, in a typical duration, s.
    pub(crate) fn for_legs(dynamics: &Dynamics, angle: f64, duration: f64) -> Self {
        let angle = angle.clamp(MIN_TURN, std::f64::consts::PI);
        let rate = PEAK_SHARE * angle / duration;
        // Greatest momentum of a wheel per unit of rate about any axis.
        let per_rate = (&dynamics.axes_inverse * dynamics.inertia)
            .row_iter()
            .map(|row| row.norm())
            .fold(0.0, f64::max);
        Self {
            angle: angle.min(1.0),
            time: INTERVAL_SHARE * duration,
            momentum: per_rate * rate,
            rate,
        }
    }
}

impl Dynamics {
    /// Least duration of a guess, s: that of the smallest turn that counts.
    pub(crate) fn least_duration(&self) -> f64 {
        2.0 * (MIN_TURN / self.axis_acceleration(&Vector3::x())).sqrt()
    }

    /// The turn, rad, of a bang-bang motion in a time, s. It scales legs that change rates or
    /// momenta without a turn.
    pub(crate) fn turn_within(&self, duration: f64) -> f64 {
        0.25 * self.axis_acceleration(&Vector3::x()) * duration.powi(2)
    }

    /// Greatest acceleration about a body axis from zero momentum, rad/s², wheels allocated by
    /// the pseudo-inverse.
    pub(crate) fn axis_acceleration(&self, axis: &Vector3<f64>) -> f64 {
        let per_unit = &self.axes_inverse * (self.inertia * axis);
        self.actuators
            .iter()
            .zip(per_unit.iter())
            .map(|(wheel, share)| wheel.max_torque.min(-wheel.min_torque) / share.abs())
            .fold(f64::INFINITY, f64::min)
    }

    /// Greatest rate about a body axis with zero momentum, rad/s, wheels allocated by the
    /// pseudo-inverse; infinite when nothing limits it.
    pub(crate) fn axis_rate(&self, axis: &Vector3<f64>) -> f64 {
        let per_unit = &self.axes_inverse * (self.inertia * axis);
        let no_momentum = self
            .actuators
            .iter()
            .zip(per_unit.iter())
            .map(|(wheel, share)| {
                wheel.max_speed / (share / wheel.inertia + wheel.axis.dot(axis)).abs()
            });
        let per_axis = self
            .max_rate
            .iter()
            .zip(axis)
            .map(|(limit, part)| limit / part.abs());
        no_momentum
            .chain(per_axis)
            .fold(self.max_rate_norm / axis.norm(), f64::min)
    }
}
