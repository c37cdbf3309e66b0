//! Valid settings of a simulated flight.

use super::allocation::TorqueAllocation;
use super::gains::{GeometricPidGains, QuaternionGains};
use super::spec::{ControllerSpec, ErrorsSpec, FeedForwardMode, SimulationSpec};
use crate::model::drive::Drive;
use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};
use crate::model::spacecraft::Spacecraft;
use nalgebra::Vector3;
use std::ops::RangeInclusive;

/// Rate of the on-board computer, 1/s, where none is given.
const ON_BOARD_RATE: f64 = 10.0;
/// Rate of the wheel loop, 1/s, where none is given (BIROS, section 3.1).
const WHEEL_LOOP_RATE: f64 = 100.0;
/// Longest step of the integration, s, where none is given.
const MAX_STEP: f64 = 0.01;
/// Attitude error, degrees, up to which a flight is a success where no tolerance is given.
const TOLERANCE_DEG: f64 = 0.1;
/// Number of flights of a Monte-Carlo run where none is given, and the greatest number.
const RUNS: usize = 1000;
const MAX_RUNS: usize = 100_000;
/// Least and greatest rate of on-board computer and wheel loop, 1/s.
const RATES: (f64, f64) = (1e-3, 1e4);
/// Greatest delay of feedback, in samples.
const MAX_DELAY: usize = 100;
/// Longest time to settle after the end of the plan, s.
const MAX_SETTLING: f64 = 1e6;

/// Valid settings of simulated flights.
#[derive(Debug, Clone)]
pub(super) struct SimulationSettings {
    pub(super) law: ControlLaw,
    /// Whether the final attitude is commanded at once instead of the plan.
    pub(super) step_input: bool,
    pub(super) feed_forward: FeedForwardMode,
    /// Time between two samples of the on-board computer, s.
    pub(super) sample_s: f64,
    /// Cycles of the wheel loop per sample.
    pub(super) cycles: usize,
    pub(super) delay: usize,
    pub(super) settle_s: f64,
    pub(super) max_step_s: f64,
    /// Nominal drives, one per wheel.
    pub(super) drives: Vec<Drive>,
    pub(super) errors: ErrorModel,
    pub(super) seed: u64,
    pub(super) runs: usize,
    /// rad.
    pub(super) tolerance: f64,
}

/// A valid control law.
#[derive(Debug, Clone)]
pub(super) enum ControlLaw {
    /// No feedback.
    Open,
    /// Quaternion feedback.
    Quaternion {
        gains: QuaternionGains,
        gyroscopic: bool,
        allocation: TorqueAllocation,
    },
    /// The geometric PID.
    Pid {
        gains: Box<GeometricPidGains>,
        anti_windup: bool,
        allocation: TorqueAllocation,
    },
}

/// Standard deviations of the errors, and the constant external torque.
#[derive(Debug, Clone, Copy)]
pub(super) struct ErrorModel {
    /// Share.
    pub(super) inertia: f64,
    /// rad.
    pub(super) alignment: f64,
    /// Share.
    pub(super) friction: f64,
    /// rad.
    pub(super) initial_attitude: f64,
    /// rad.
    pub(super) attitude_noise: f64,
    /// rad/s.
    pub(super) rate_noise: f64,
    /// Body axes, N m.
    pub(super) disturbance: Vector3<f64>,
}

/// All problems of a description for a spacecraft, as far as they do not depend on the plan; JSON
/// pointers begin with `pointer`.
#[must_use]
pub fn check(spec: &SimulationSpec, spacecraft: &Spacecraft, pointer: &str) -> Vec<Problem> {
    let mut findings = Findings::default();
    let settings = SimulationSettings::read(spec, spacecraft, pointer, &mut findings);
    findings.conclude(settings).err().unwrap_or_default()
}

impl SimulationSettings {
    pub(super) fn read(
        spec: &SimulationSpec,
        spacecraft: &Spacecraft,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Self> {
        let drives = Drive::read_all(
            &spec.drives,
            spacecraft.wheels().len(),
            &format!("{pointer}/drives"),
        )
        .map_err(|problems| findings.include(problems))
        .ok();
        let law = law(
            &spec.controller,
            spacecraft,
            drives.as_deref(),
            pointer,
            findings,
        );
        let timing = Timing::read(spec, pointer, findings);
        let errors = ErrorModel::read(&spec.errors, &format!("{pointer}/errors"), findings);
        let runs = count(
            "runs",
            spec.runs.unwrap_or(RUNS),
            1..=MAX_RUNS,
            pointer,
            findings,
        );
        let tolerance = findings.positive(
            &format!("{pointer}/tolerance_deg"),
            spec.tolerance_deg.unwrap_or(TOLERANCE_DEG),
        );
        let timing = timing?;
        Some(Self {
            law: law?,
            step_input: matches!(spec.controller, ControllerSpec::StepInput { .. }),
            feed_forward: spec.feed_forward.unwrap_or_default(),
            sample_s: timing.sample_s,
            cycles: timing.cycles,
            delay: timing.delay,
            settle_s: timing.settle_s,
            max_step_s: timing.max_step_s,
            drives: drives?,
            errors: errors?,
            seed: spec.seed.unwrap_or(0),
            runs: runs?,
            tolerance: tolerance?.to_radians(),
        })
    }
}

/// Times and rates of the settings.
struct Timing {
    sample_s: f64,
    cycles: usize,
    delay: usize,
    settle_s: f64,
    max_step_s: f64,
}

impl Timing {
    fn read(spec: &SimulationSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let rate = rate(
            "on_board_rate_hz",
            spec.on_board_rate_hz.unwrap_or(ON_BOARD_RATE),
            pointer,
            findings,
        );
        let cycles = rate.and_then(|rate| cycles(spec, rate, pointer, findings));
        let delay = count(
            "delay_samples",
            spec.delay_samples.unwrap_or(0),
            0..=MAX_DELAY,
            pointer,
            findings,
        );
        let settle =
            findings.not_negative(&format!("{pointer}/settle_s"), spec.settle_s.unwrap_or(0.0));
        let settle = settle.and_then(|s| at_most("settle_s", s, MAX_SETTLING, pointer, findings));
        let step = findings.positive(
            &format!("{pointer}/max_step_s"),
            spec.max_step_s.unwrap_or(MAX_STEP),
        );
        Some(Self {
            sample_s: 1.0 / rate?,
            cycles: cycles?,
            delay: delay?,
            settle_s: settle?,
            max_step_s: step?,
        })
    }
}

fn law(
    spec: &ControllerSpec,
    spacecraft: &Spacecraft,
    drives: Option<&[Drive]>,
    pointer: &str,
    findings: &mut Findings,
) -> Option<ControlLaw> {
    let at = format!("{pointer}/controller/gains");
    let allocation = |findings: &mut Findings| {
        let allocation = TorqueAllocation::new(spacecraft.wheels(), drives?);
        if allocation.is_none() {
            findings.refuse(
                format!("{pointer}/drives"),
                Code::WheelAxesCoplanar,
                "the wheels that take commands cannot make a torque about every axis",
                "enable three wheels without a speed law whose axes span space, or use no feedback",
            );
        }
        allocation
    };
    match spec {
        ControllerSpec::FeedForward => Some(ControlLaw::Open),
        ControllerSpec::Quaternion { gains, gyroscopic }
        | ControllerSpec::StepInput { gains, gyroscopic } => {
            let gains = QuaternionGains::read(gains, &at, findings);
            let allocation = allocation(findings);
            Some(ControlLaw::Quaternion {
                gains: gains?,
                gyroscopic: *gyroscopic,
                allocation: allocation?,
            })
        }
        ControllerSpec::GeometricPid { gains, anti_windup } => {
            let gains = GeometricPidGains::read(gains, spacecraft.inertia(), &at, findings);
            let allocation = allocation(findings);
            Some(ControlLaw::Pid {
                gains: Box::new(gains?),
                anti_windup: *anti_windup,
                allocation: allocation?,
            })
        }
    }
}

impl ErrorModel {
    fn read(spec: &ErrorsSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let mut deviation = |name: &str, value: Option<f64>, most: f64| {
            let value =
                findings.not_negative(&format!("{pointer}/{name}"), value.unwrap_or(0.0))?;
            at_most(name, value, most, pointer, findings)
        };
        let inertia = deviation("inertia_3_sigma", spec.inertia_3_sigma, 1.0);
        let alignment = deviation("alignment_3_sigma_rad", spec.alignment_3_sigma_rad, 1.0);
        let friction = deviation("friction_3_sigma", spec.friction_3_sigma, 10.0);
        let initial = deviation(
            "initial_attitude_3_sigma_rad",
            spec.initial_attitude_3_sigma_rad,
            std::f64::consts::PI,
        );
        let attitude = deviation("attitude_noise_rad", spec.attitude_noise_rad, 1.0);
        let rate = deviation("rate_noise_rad_s", spec.rate_noise_rad_s, 1.0);
        let disturbance = findings.vector(
            &format!("{pointer}/disturbance_torque_nm"),
            spec.disturbance_torque_nm.unwrap_or_default(),
        );
        Some(Self {
            inertia: inertia? / 3.0,
            alignment: alignment? / 3.0,
            friction: friction? / 3.0,
            initial_attitude: initial? / 3.0,
            attitude_noise: attitude?,
            rate_noise: rate?,
            disturbance: disturbance?,
        })
    }
}

fn rate(name: &str, value: f64, pointer: &str, findings: &mut Findings) -> Option<f64> {
    let at = format!("{pointer}/{name}");
    let value = findings.positive(&at, value)?;
    let (least, most) = RATES;
    if (least..=most).contains(&value) {
        return Some(value);
    }
    findings.refuse(
        at,
        Code::OutOfRange,
        format!("the rate is {value} per second, it must be between {least} and {most}"),
        "give the rate in samples per second",
    );
    None
}

/// Cycles of the wheel loop per sample of the on-board computer, rounded up.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a ratio of two rates within their bounds"
)]
fn cycles(
    spec: &SimulationSpec,
    on_board: f64,
    pointer: &str,
    findings: &mut Findings,
) -> Option<usize> {
    let name = "wheel_loop_rate_hz";
    let loop_rate = spec
        .wheel_loop_rate_hz
        .unwrap_or(WHEEL_LOOP_RATE.max(on_board));
    let loop_rate = rate(name, loop_rate, pointer, findings)?;
    if loop_rate < on_board {
        findings.refuse(
            format!("{pointer}/{name}"),
            Code::OutOfRange,
            format!(
                "the wheel loop runs at {loop_rate} Hz, the on-board computer at {on_board} Hz"
            ),
            "make the wheel loop at least as fast as the on-board computer",
        );
        return None;
    }
    // A ratio that exceeds a whole number only by rounding is not rounded up.
    Some((loop_rate / on_board - 1e-9).ceil().max(1.0) as usize)
}

fn count(
    name: &str,
    value: usize,
    allowed: RangeInclusive<usize>,
    pointer: &str,
    findings: &mut Findings,
) -> Option<usize> {
    let (least, most) = (*allowed.start(), *allowed.end());
    if allowed.contains(&value) {
        return Some(value);
    }
    findings.refuse(
        format!("{pointer}/{name}"),
        Code::OutOfRange,
        format!("{name} is {value}, it must be from {least} to {most}"),
        format!("give a number from {least} to {most}"),
    );
    None
}

fn at_most(
    name: &str,
    value: f64,
    most: f64,
    pointer: &str,
    findings: &mut Findings,
) -> Option<f64> {
    if value <= most {
        return Some(value);
    }
    findings.refuse(
        format!("{pointer}/{name}"),
        Code::OutOfRange,
        format!("{name} is {value}, it must be at most {most:.4}"),
        "check the unit, which the name of the field ends with",
    );
    None
}
