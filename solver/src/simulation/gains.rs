//! Gains of the control laws, given directly or by the poles of small errors.

use super::spec::{GainsSpec, PidGainsSpec};
use crate::model::findings::Findings;
use nalgebra::Matrix3;

/// Settling time to 2 % in time constants of a damped pair of poles: `exp(-4) = 0.018`.
const SETTLING_TIME_CONSTANTS: f64 = 4.0;

/// Gains `k`, `c` of quaternion feedback `-k J q_e - c J w_e`, with `q_e` the vector part of the
/// error quaternion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuaternionGains {
    /// `k`, 1/s².
    pub attitude: f64,
    /// `c`, 1/s.
    pub rate: f64,
}

impl QuaternionGains {
    /// Gains for a natural frequency, rad/s, and a damping ratio of small attitude errors.
    ///
    /// The vector part of a quaternion is half the angle, so that `k = 2 w_n^2`.
    #[must_use]
    pub fn from_bandwidth(bandwidth: f64, damping: f64) -> Self {
        Self {
            attitude: 2.0 * bandwidth * bandwidth,
            rate: 2.0 * damping * bandwidth,
        }
    }

    /// The published gains of a settling time, s, and a damping (RW/CMG thesis, equations 39 and
    /// 42): `w_n = 4 / (damping time)`, `k = w_n^2`, `c = 2 damping w_n`.
    ///
    /// The published equations take the vector part of the quaternion for the angle, of which it is
    /// half: the natural frequency of a small error is `w_n / sqrt(2)`, its damping ratio `sqrt(2)`
    /// times the given one.
    #[must_use]
    pub fn from_settling_time(settling_time: f64, damping: f64) -> Self {
        let frequency = SETTLING_TIME_CONSTANTS / (damping * settling_time);
        Self {
            attitude: frequency * frequency,
            rate: 2.0 * damping * frequency,
        }
    }

    pub(super) fn read(spec: &GainsSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        match *spec {
            GainsSpec::Bandwidth {
                bandwidth_rad_s,
                damping,
            } => {
                let bandwidth =
                    findings.positive(&format!("{pointer}/bandwidth_rad_s"), bandwidth_rad_s);
                let damping = findings.positive(&format!("{pointer}/damping"), damping);
                Some(Self::from_bandwidth(bandwidth?, damping?))
            }
            GainsSpec::SettlingTime {
                settling_time_s,
                damping,
            } => {
                let time =
                    findings.positive(&format!("{pointer}/settling_time_s"), settling_time_s);
                let damping = findings.positive(&format!("{pointer}/damping"), damping);
                Some(Self::from_settling_time(time?, damping?))
            }
            GainsSpec::Given {
                attitude_per_s2,
                rate_per_s,
            } => {
                let attitude =
                    findings.not_negative(&format!("{pointer}/attitude_per_s2"), attitude_per_s2);
                let rate = findings.not_negative(&format!("{pointer}/rate_per_s"), rate_per_s);
                Some(Self {
                    attitude: attitude?,
                    rate: rate?,
                })
            }
        }
    }
}

/// Gains of the geometric PID, `-k_R e_R - k_w e_w - k_I e_I` with `e_I` the integral of
/// `e_w + k_p e_R` (BIROS equations 23 and 24); matrices, in proportion to the inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GeometricPidGains {
    /// `k_R`, N m.
    pub(super) attitude: Matrix3<f64>,
    /// `k_w`, N m s.
    pub(super) rate: Matrix3<f64>,
    /// `k_I`, N m.
    pub(super) integral: Matrix3<f64>,
    /// `k_p`, 1/s.
    pub(super) attitude_weight: f64,
}

impl GeometricPidGains {
    /// Gains for which small attitude errors have the poles of
    /// `(s + p) (s^2 + 2 z w s + w^2)`.
    ///
    /// The error obeys `s^3 + k_w s^2 + (k_R + k_I) s + k_I k_p` per unit of inertia. One of the four
    /// gains is free: `k_R = w^2` is the proportional gain for `p = 0`.
    fn from_poles(inertia: &Matrix3<f64>, w: f64, z: f64, p: f64) -> Self {
        Self {
            attitude: inertia * (w * w),
            rate: inertia * (2.0 * z * w + p),
            integral: inertia * (2.0 * z * w * p),
            attitude_weight: w / (2.0 * z),
        }
    }

    pub(super) fn read(
        spec: &PidGainsSpec,
        inertia: &Matrix3<f64>,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Self> {
        match *spec {
            PidGainsSpec::Bandwidth {
                bandwidth_rad_s,
                damping,
                integral_rad_s,
            } => {
                let bandwidth =
                    findings.positive(&format!("{pointer}/bandwidth_rad_s"), bandwidth_rad_s);
                let damping = findings.positive(&format!("{pointer}/damping"), damping);
                let integral =
                    findings.not_negative(&format!("{pointer}/integral_rad_s"), integral_rad_s);
                Some(Self::from_poles(inertia, bandwidth?, damping?, integral?))
            }
            PidGainsSpec::Given {
                attitude_nm,
                rate_nms,
                integral_nm,
                attitude_weight_per_s,
            } => {
                let mut gain =
                    |name, value| findings.not_negative(&format!("{pointer}/{name}"), value);
                let attitude = gain("attitude_nm", attitude_nm);
                let rate = gain("rate_nms", rate_nms);
                let integral = gain("integral_nm", integral_nm);
                let weight = gain("attitude_weight_per_s", attitude_weight_per_s);
                Some(Self {
                    attitude: Matrix3::identity() * attitude?,
                    rate: Matrix3::identity() * rate?,
                    integral: Matrix3::identity() * integral?,
                    attitude_weight: weight?,
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_settling_time_gives_the_published_gains() {
        let gains = QuaternionGains::from_settling_time(0.1, 0.9);
        // Published as 1.97e3 (cut off, not rounded) and 80.
        assert!((gains.attitude - 1975.3).abs() < 0.05, "{gains:?}");
        assert!((gains.rate - 80.0).abs() < 1e-12, "{gains:?}");
    }

    #[test]
    fn poles_and_gains_of_the_pid_agree() {
        let (w, z, p) = (0.3, 0.8, 0.05);
        let gains = GeometricPidGains::from_poles(&Matrix3::identity(), w, z, p);
        let (r, i) = (gains.attitude.m11, gains.integral.m11);
        assert!((gains.rate.m11 - (2.0 * z * w + p)).abs() < 1e-15);
        assert!((r + i - (w * w + 2.0 * z * w * p)).abs() < 1e-15);
        assert!((i * gains.attitude_weight - w * w * p).abs() < 1e-15);
    }
}
