//! Limits of torque, wheel speed and body rate along the whole flight.

use super::extremum::critical_points;
use super::integrator::IntegrationStep;
use super::number_format::figure;
use super::{LIMIT_TOLERANCE, NOT_COMPUTED};
use crate::model::plan::Flight;
use crate::model::scenario::Scenario;
use crate::model::spacecraft::Spacecraft;

/// Wheel speeds up to this share of the wheel's limit or, without one, of the fastest wheel's speed
/// have no sign: otherwise a wheel at rest would cross zero by rounding.
const ZERO_SPEED: f64 = 1e-6;

/// The closest approach to a limit.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Peak {
    /// Largest share of the limit; 1 is at the limit.
    pub(super) usage: f64,
    time_s: f64,
}

impl Peak {
    fn raise(&mut self, usage: f64, time_s: f64) {
        if usage > self.usage {
            *self = Self { usage, time_s };
        }
    }

    /// A sentence when the limit is exceeded by more than the tolerance.
    fn failure(&self, what: &str, limit: f64, unit: &str) -> Option<String> {
        (self.usage - 1.0 > LIMIT_TOLERANCE).then(|| {
            format!(
                "{what} reaches {} {unit} at {} s where {} {unit} is allowed",
                figure(self.usage * limit),
                figure(self.time_s),
                figure(limit)
            )
        })
    }
}

/// The excess of a usage over 1, or 0; finite for any limit.
pub(super) fn excess(usage: f64) -> f64 {
    (usage - 1.0).clamp(0.0, NOT_COMPUTED)
}

/// The margin to a hardware limit, for the usage of the share `authority` of it that a plan may use.
pub(super) fn margin(usage: f64, authority: f64) -> f64 {
    (1.0 - usage * authority).max(-NOT_COMPUTED)
}

/// The largest share of the allowed torque, with sentences about wheels that exceed it.
pub(super) fn torque(scenario: &Scenario, flight: &Flight) -> (f64, Vec<String>) {
    let authority = scenario.options().torque_authority;
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for (index, wheel) in scenario.spacecraft().enabled_wheels() {
        let mut peak = Peak::default();
        let mut allowed = 0.0;
        for control in &flight.controls {
            let torque = control.wheel_torque_nm[index];
            let limit = if torque < 0.0 {
                wheel.min_torque
            } else {
                wheel.max_torque
            } * authority;
            if torque / limit > peak.usage {
                peak.raise(torque / limit, control.start_s);
                allowed = limit;
            }
        }
        worst = worst.max(peak.usage);
        failures.extend(peak.failure(&format!("the torque on wheel {index}"), allowed, "N m"));
    }
    (worst, failures)
}

/// Observer of wheel speeds and body rates.
#[derive(Debug)]
pub(super) struct LimitObserver<'a> {
    spacecraft: &'a Spacecraft,
    momentum_authority: f64,
    wheels: Vec<Peak>,
    axes: [Peak; 3],
    norm: Peak,
    runs: Vec<SignedRuns>,
}

impl<'a> LimitObserver<'a> {
    pub(super) fn new(scenario: &'a Scenario) -> Self {
        let spacecraft = scenario.spacecraft();
        let count = spacecraft.wheels().len();
        Self {
            spacecraft,
            momentum_authority: scenario.options().momentum_authority,
            wheels: vec![Peak::default(); count],
            axes: [Peak::default(); 3],
            norm: Peak::default(),
            runs: vec![SignedRuns::default(); count],
        }
    }

    pub(super) fn observe(&mut self, step: &IntegrationStep<'_>) {
        self.observe_wheels(step);
        self.observe_rates(step);
    }

    fn observe_wheels(&mut self, step: &IntegrationStep<'_>) {
        for (index, wheel) in self.spacecraft.enabled_wheels() {
            let allowed = wheel.max_speed * self.momentum_authority;
            let (peak, runs) = (&mut self.wheels[index], &mut self.runs[index]);
            let slope = |s| step.motion.wheel_slope(index, s);
            critical_points(step.grid, slope, |s| {
                let speed = step.motion.wheel_speed(index, s);
                peak.raise(speed.abs() / allowed, step.begin_s + s);
                runs.push(speed);
            });
        }
    }

    fn observe_rates(&mut self, step: &IntegrationStep<'_>) {
        let limits = self.spacecraft.max_rate();
        for (axis, peak) in self.axes.iter_mut().enumerate() {
            if limits[axis].is_finite() {
                let slope = |s| step.motion.rate_component_slope(axis, s);
                critical_points(step.grid, slope, |s| {
                    let rate = step.motion.rate_component(axis, s);
                    peak.raise(rate.abs() / limits[axis], step.begin_s + s);
                });
            }
        }
        let limit = self.spacecraft.max_rate_norm();
        if limit.is_finite() {
            let slope = |s| step.motion.rate(s).dot(&step.motion.rate_slope(s));
            critical_points(step.grid, slope, |s| {
                self.norm
                    .raise(step.motion.rate(s).norm() / limit, step.begin_s + s);
            });
        }
    }

    /// The largest share of an allowed wheel speed, when any is limited.
    pub(super) fn wheel_usage(&self) -> Option<f64> {
        self.spacecraft
            .enabled_wheels()
            .filter(|(_, wheel)| wheel.max_speed.is_finite())
            .map(|(index, _)| self.wheels[index].usage)
            .reduce(f64::max)
    }

    /// The largest share of a body rate limit, when any is set.
    pub(super) fn rate_usage(&self) -> Option<f64> {
        let limits = self.spacecraft.max_rate();
        let norm = self.spacecraft.max_rate_norm();
        let axes = (0..3).map(|axis| (limits[axis], self.axes[axis].usage));
        axes.chain([(norm, self.norm.usage)])
            .filter_map(|(limit, usage)| limit.is_finite().then_some(usage))
            .reduce(f64::max)
    }

    /// Sentences about every exceeded limit.
    pub(super) fn failures(&self) -> Vec<String> {
        let wheels = self
            .spacecraft
            .enabled_wheels()
            .filter_map(|(index, wheel)| {
                let what = format!("the speed of wheel {index}");
                let allowed = wheel.max_speed * self.momentum_authority;
                self.wheels[index].failure(&what, allowed, "rad/s")
            });
        let limits = self.spacecraft.max_rate();
        let axes = ["x", "y", "z"]
            .iter()
            .enumerate()
            .filter_map(|(axis, name)| {
                let what = format!("the body rate about {name}");
                self.axes[axis].failure(&what, limits[axis], "rad/s")
            });
        let norm = self.spacecraft.max_rate_norm();
        let norm = self
            .norm
            .failure("the norm of the body rate", norm, "rad/s");
        wheels.chain(axes).chain(norm).collect()
    }

    /// How often each wheel's speed changes its sign.
    pub(super) fn zero_crossings(&self) -> Vec<u32> {
        let fastest = self.runs.iter().map(SignedRuns::peak).fold(0.0, f64::max);
        self.runs
            .iter()
            .zip(self.spacecraft.wheels())
            .map(|(runs, wheel)| {
                let limited = wheel.max_speed.is_finite();
                runs.crossings(ZERO_SPEED * if limited { wheel.max_speed } else { fastest })
            })
            .collect()
    }
}

/// The signed peaks of all runs of values with the same sign.
#[derive(Debug, Clone, Default)]
struct SignedRuns(Vec<f64>);

impl SignedRuns {
    fn push(&mut self, value: f64) {
        match self.0.last_mut() {
            _ if value == 0.0 => {}
            Some(peak) if *peak * value.signum() > 0.0 => {
                if value.abs() > peak.abs() {
                    *peak = value;
                }
            }
            _ => self.0.push(value),
        }
    }

    fn peak(&self) -> f64 {
        self.0.iter().fold(0.0, |peak, v| peak.max(v.abs()))
    }

    fn crossings(&self, threshold: f64) -> u32 {
        let mut count = 0;
        let mut sign = 0.0;
        for value in self.0.iter().filter(|v| v.abs() > threshold) {
            if sign * value.signum() < 0.0 {
                count += 1;
            }
            sign = value.signum();
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::SignedRuns;

    #[test]
    fn zero_crossings_by_rounding_and_a_start_at_zero_do_not_count() {
        let mut runs = SignedRuns::default();
        for value in [0.0, 1.0, 3.0, -1e-12, 2.0, -2.0, 1e-13, -1.0, 0.0, 4.0] {
            runs.push(value);
        }
        assert_eq!(runs.crossings(1e-6), 2);
        assert!((runs.peak() - 4.0).abs() < 1e-15);
    }
}
