//! The limits for the states at start and end.

use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::ScenarioSpec;
use nalgebra::Vector3;

/// Relative excess over a limit that is attributed to the conversion of units.
const ROUNDING: f64 = 1e-9;

/// Limits read from the description, so that they are known even if the spacecraft is invalid. A
/// limit that is absent or invalid is infinite here.
pub(super) struct Limits {
    /// Largest rate about each body axis, rad/s.
    pub(super) rate: [f64; 3],
    /// Largest norm of the rate, rad/s.
    pub(super) rate_norm: f64,
    /// The limits of each wheel.
    pub(super) wheels: Vec<WheelLimit>,
}

/// The limit of a wheel's speed.
pub(super) struct WheelLimit {
    /// Largest speed relative to the body, rad/s: the share that a plan may use, or all of it for a
    /// locked wheel, which no plan uses.
    pub(super) speed: f64,
    /// Whether the wheel is locked at its start speed.
    pub(super) locked: bool,
}

impl Limits {
    pub(super) fn of(spec: &ScenarioSpec) -> Self {
        let authority = spec.options.momentum_authority;
        let share = if authority > 0.0 && authority <= 1.0 {
            authority
        } else {
            1.0
        };
        let wheels = spec.spacecraft.wheels.iter().map(|wheel| WheelLimit {
            speed: usable(wheel.max_speed_rad_s) * if wheel.enabled { share } else { 1.0 },
            locked: !wheel.enabled,
        });
        Self {
            rate: spec.spacecraft.max_body_rate_rad_s.map(usable),
            rate_norm: usable(spec.spacecraft.max_body_rate_norm_rad_s),
            wheels: wheels.collect(),
        }
    }

    /// Checks a body rate against the limits of components and norm.
    pub(super) fn allow_rate(
        &self,
        rate: &Vector3<f64>,
        pointer: &str,
        findings: &mut Findings,
    ) -> bool {
        let mut allowed = true;
        for (i, (value, limit)) in rate.iter().zip(self.rate).enumerate() {
            if exceeds(*value, limit) {
                allowed = false;
                findings.refuse(
                    format!("{pointer}/{i}"),
                    Code::BodyRateLimit,
                    format!("the rate {value} rad/s is beyond the limit of {limit} rad/s"),
                    "lower the rate or raise spacecraft.max_body_rate_rad_s",
                );
            }
        }
        if exceeds(rate.norm(), self.rate_norm) {
            allowed = false;
            findings.refuse(
                pointer,
                Code::BodyRateLimit,
                format!(
                    "the norm {} rad/s of the rate is beyond the limit of {} rad/s",
                    rate.norm(),
                    self.rate_norm
                ),
                "lower the rate or raise spacecraft.max_body_rate_norm_rad_s",
            );
        }
        allowed
    }

    /// Checks wheel speeds, one per wheel, against the limits.
    pub(super) fn allow_speeds(
        &self,
        speeds: &[f64],
        pointer: &str,
        findings: &mut Findings,
    ) -> bool {
        let mut allowed = true;
        for (i, (speed, wheel)) in speeds.iter().zip(&self.wheels).enumerate() {
            if exceeds(*speed, wheel.speed) {
                allowed = false;
                findings.refuse(
                    format!("{pointer}/{i}"),
                    Code::WheelSpeedLimit,
                    format!(
                        "the wheel speed {speed} rad/s is beyond the usable limit of {} rad/s",
                        wheel.speed
                    ),
                    "lower the speed; the usable limit is max_speed_rad_s times \
                     options.momentum_authority",
                );
            }
        }
        allowed
    }
}

/// Whether the absolute value exceeds a limit by more than rounding.
pub(super) fn exceeds(value: f64, limit: f64) -> bool {
    value.abs() > limit * (1.0 + ROUNDING)
}

fn usable(limit: Option<f64>) -> f64 {
    limit.filter(|&limit| limit > 0.0).unwrap_or(f64::INFINITY)
}
