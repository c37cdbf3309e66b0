//! Propagation of a solution with the checker's integrator: end errors, excesses over limits, energies.

use super::motion::SlewMotion;
use super::spec::EnergyMeasure;
use super::validated::Slew;
use crate::checker::{
    ATTITUDE_TOLERANCE, END_SPEED_TOLERANCE, LIMIT_TOLERANCE, MOMENTUM_TOLERANCE, RATE_TOLERANCE,
    StepPart, TorqueRamp, propagate_ramps,
};
use crate::model::attitude::Attitude;
use crate::model::drive::Drive;
use crate::model::plan::{ConeClearance, Intrusion, State};
use crate::model::problem::Problem;
use crate::model::roll::Pointing;
use crate::model::waypoint::WheelCondition;

/// Bisections for the time at which the power of a wheel changes its sign.
const HALVINGS: usize = 40;
/// Parts of an integration step at whose ends the sign of the power is evaluated.
const PARTS: usize = 4;
/// Gauss's rule with three points.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Commanded torques over a time, linear from its beginning to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct TorquePiece {
    /// Time at the beginning, s.
    pub start_s: f64,
    /// Length, s.
    pub duration_s: f64,
    /// Torque of each wheel at the beginning, N m; zero for wheels that are not commanded.
    pub torque_begin_nm: Vec<f64>,
    /// The same at the end.
    pub torque_end_nm: Vec<f64>,
}

/// Energies of all motors together, J.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MotorEnergies {
    /// Integral of the power; power that a braking wheel returns counts as negative.
    pub proxy_j: f64,
    /// Energy drawn from the supply: the integral of the positive part of the power over the
    /// efficiency, plus the energy of the electronics.
    pub bill_j: f64,
}

impl MotorEnergies {
    /// The energy in one of the two measures, J.
    #[must_use]
    pub fn by(&self, measure: EnergyMeasure) -> f64 {
        match measure {
            EnergyMeasure::Proxy => self.proxy_j,
            EnergyMeasure::Bill => self.bill_j,
        }
    }
}

/// A solution, and the result of its integration by the checker.
#[derive(Debug, Clone)]
pub struct PropagatedSlew {
    /// The commanded torques, without gaps from zero to the end.
    pub pieces: Vec<TorquePiece>,
    /// States at the beginning of every piece of positive duration, and at the end.
    pub states: Vec<State>,
    /// The motors' energies.
    pub energies: MotorEnergies,
    /// Roll about the boresight that is pointed at the start, rad; `None` where an attitude is given.
    pub start_roll_rad: Option<f64>,
    /// The same at the end.
    pub end_roll_rad: Option<f64>,
    /// Angle between the attitude at the end and the nearest admissible one, rad.
    pub attitude_error_rad: f64,
    /// Norm of the error of the body rate at the end, rad/s.
    pub rate_error_rad_s: f64,
    /// Greatest excess over a motor torque limit, relative.
    pub torque_excess: f64,
    /// Greatest excess over a wheel speed limit, relative.
    pub wheel_speed_excess: f64,
    /// Greatest excess over a body rate limit, relative.
    pub rate_excess: f64,
    /// Greatest error of a prescribed final wheel speed, rad/s; zero where none is.
    pub wheel_speed_error_rad_s: f64,
    /// Closest approach to every cone, also to those that are only reported.
    pub clearances: Vec<ConeClearance>,
    /// Times on the wrong side of cones.
    pub intrusions: Vec<Intrusion>,
    /// Warnings about cones that are only reported.
    pub warnings: Vec<Problem>,
    /// Every limit, cone or end condition that is violated, as a sentence; empty when there is none.
    pub failures: Vec<String>,
}

/// Integral of the squared torques, (N m)² s.
pub(super) fn effort(motion: &SlewMotion) -> f64 {
    let torques = motion.begin.iter().zip(&motion.end);
    torques
        .zip(&motion.lengths)
        .map(|((u, v), tau)| tau * (u.norm_squared() + u.dot(v) + v.norm_squared()) / 3.0)
        .sum()
}

/// Integrates a motion's torques from the start.
pub(super) fn propagate(slew: &Slew, motion: &SlewMotion) -> PropagatedSlew {
    let scenario = slew.scenario();
    let ramps = ramps(slew, motion);
    let drives = slew.all_drives();
    let mut energies = MotorEnergies::default();
    let from = slew.ends_towards(motion)[0].attitude;
    let rolled = scenario.start().roll.map(|_| scenario.starting_in(from));
    let flight = propagate_ramps(
        rolled.as_ref().unwrap_or(scenario),
        drives,
        &ramps,
        |moment| {
            for actuator in &slew.vehicle().dynamics.actuators {
                let spent = spent(&drives[actuator.index], actuator.index, moment);
                energies.proxy_j += spent.proxy_j;
                energies.bill_j += spent.bill_j;
            }
        },
    );
    let mut propagated = PropagatedSlew {
        pieces: ramps.iter().map(piece).collect(),
        states: Vec::new(),
        energies,
        start_roll_rad: None,
        end_roll_rad: None,
        attitude_error_rad: f64::MAX,
        rate_error_rad_s: f64::MAX,
        torque_excess: f64::MAX,
        wheel_speed_excess: f64::MAX,
        rate_excess: f64::MAX,
        wheel_speed_error_rad_s: f64::MAX,
        clearances: Vec::new(),
        intrusions: Vec::new(),
        warnings: Vec::new(),
        failures: Vec::new(),
    };
    let flight = match flight {
        Ok(flight) => flight,
        Err(sentence) => {
            propagated.failures.push(sentence);
            return propagated;
        }
    };
    if let (Some(end), Some(wanted)) = (flight.states.last(), scenario.end()) {
        let roll = |of: &Option<Pointing>, at: &Attitude| Some(of.as_ref()?.roll_of(at));
        propagated.start_roll_rad = roll(&scenario.start().pointing, &from);
        propagated.end_roll_rad = roll(&wanted.pointing, &end.attitude);
        propagated.attitude_error_rad = slew.missed_by(&end.attitude);
        propagated.rate_error_rad_s = (end.body_rate_rad_s - wanted.rate).norm();
        propagated.wheel_speed_error_rad_s = speed_error(slew, end);
    }
    propagated.torque_excess = excess(flight.torque_usage);
    propagated.wheel_speed_excess = excess(flight.wheel_usage.unwrap_or(0.0));
    propagated.rate_excess = excess(flight.rate_usage.unwrap_or(0.0));
    propagated.clearances = flight.clearances;
    propagated.intrusions = flight.intrusions;
    propagated.warnings = flight.warnings;
    propagated.failures = flight.failures;
    propagated
        .failures
        .extend(faults(&propagated, flight.momentum_drift));
    propagated.states = flight.states;
    propagated.failures.extend(speed_fault(slew, &propagated));
    propagated
}

/// The excess of a usage over 1, or 0. It is finite for any limit, and `f64::MAX` for a usage that is
/// not a number.
fn excess(usage: f64) -> f64 {
    if usage.is_nan() {
        f64::MAX
    } else {
        (usage - 1.0).clamp(0.0, f64::MAX)
    }
}

/// Sentences about attitude, rate and torques that are out of tolerance; [`propagate_ramps`] reports
/// those about speeds, rates and cones.
fn faults(propagated: &PropagatedSlew, momentum_drift: f64) -> Vec<String> {
    let too_large = [
        (
            propagated.attitude_error_rad,
            ATTITUDE_TOLERANCE,
            "the end is missed by",
            "rad",
        ),
        (
            propagated.rate_error_rad_s,
            RATE_TOLERANCE,
            "the rate at the end is off by",
            "rad/s",
        ),
        (
            propagated.torque_excess,
            LIMIT_TOLERANCE,
            "a motor torque exceeds its limit by a share of",
            "",
        ),
        (
            momentum_drift,
            MOMENTUM_TOLERANCE,
            "the integration lost momentum, a share of",
            "",
        ),
    ];
    too_large
        .into_iter()
        // A value that is not a number is out of tolerance.
        .filter(|(value, tolerance, ..)| value.is_nan() || value > tolerance)
        .map(|(value, _, what, unit)| format!("{what} {value:.3e} {unit}").trim_end().to_owned())
        .collect()
}

/// A sentence when the wheels miss their prescribed speeds; the tolerance is relative to the least
/// speed limit or, without limits, to the fastest wheel.
fn speed_fault(slew: &Slew, propagated: &PropagatedSlew) -> Option<String> {
    let actuators = slew.vehicle().dynamics.actuators.iter();
    let least = actuators
        .map(|wheel| wheel.max_speed)
        .fold(f64::INFINITY, f64::min);
    let speeds = propagated
        .states
        .iter()
        .flat_map(|state| &state.wheel_speed_rad_s);
    let fastest = speeds.fold(0.0_f64, |fastest, speed| fastest.max(speed.abs()));
    let unit = if least.is_finite() { least } else { fastest };
    let error = propagated.wheel_speed_error_rad_s;
    (error > END_SPEED_TOLERANCE * unit)
        .then(|| format!("a wheel misses its final speed by {error:.3e} rad/s"))
}

/// The greatest error of a prescribed final speed, rad/s; zero where none is prescribed.
fn speed_error(slew: &Slew, end: &State) -> f64 {
    let dynamics = &slew.vehicle().dynamics;
    let momenta = dynamics.wheels_of_speeds(&end.body_rate_rad_s, &end.wheel_speed_rad_s);
    let WheelCondition::Fixed(wanted) = &slew.ends()[1].wheels else {
        return 0.0;
    };
    let errors = dynamics
        .actuators
        .iter()
        .zip((momenta - wanted).iter().copied().collect::<Vec<_>>());
    errors
        .map(|(wheel, error)| (error / wheel.inertia).abs())
        .fold(0.0, f64::max)
}

fn piece(ramp: &TorqueRamp) -> TorquePiece {
    TorquePiece {
        start_s: ramp.start_s,
        duration_s: ramp.duration_s,
        torque_begin_nm: ramp.begin_nm.clone(),
        torque_end_nm: ramp.end_nm.clone(),
    }
}

fn ramps(slew: &Slew, motion: &SlewMotion) -> Vec<TorqueRamp> {
    let dynamics = &slew.vehicle().dynamics;
    let of_all = |torques: &nalgebra::DVector<f64>| {
        let mut all = vec![0.0; slew.all_drives().len()];
        for (wheel, torque) in dynamics.actuators.iter().zip(torques.iter()) {
            all[wheel.index] = *torque;
        }
        all
    };
    motion
        .times()
        .iter()
        .zip(&motion.lengths)
        .zip(motion.begin.iter().zip(&motion.end))
        .map(|((start, length), (begin, end))| TorqueRamp {
            start_s: *start,
            duration_s: *length,
            begin_nm: of_all(begin),
            end_nm: of_all(end),
        })
        .collect()
}

/// Energies of one wheel over an integration step. Quadrature is exact for power of degree five in
/// time; parts are cut where the power changes its sign.
fn spent(drive: &Drive, wheel: usize, moment: &StepPart<'_>) -> MotorEnergies {
    let Some(motor) = drive.motor else {
        return MotorEnergies::default();
    };
    let power = |s: f64| {
        let speed = moment.speed(wheel, s);
        motor.power(drive.motor_torque(moment.torque(wheel, s), speed), speed)
    };
    let mut energies = MotorEnergies {
        proxy_j: 0.0,
        bill_j: motor.quiescent_power * moment.length_s,
    };
    for part in 0..PARTS {
        let at = |i: usize| moment.length_s * i as f64 / PARTS as f64;
        let (begin, end) = (at(part), at(part + 1));
        let cut = sign_change(&power, begin, end);
        for (from, to) in [(begin, cut), (cut, end)] {
            let integral = |f: &dyn Fn(f64) -> f64| -> f64 {
                let points = GAUSS.iter();
                (to - from)
                    * points
                        .map(|(s, w)| w * f(from + (to - from) * s))
                        .sum::<f64>()
            };
            energies.proxy_j += integral(&power);
            energies.bill_j += integral(&|s| power(s).max(0.0)) / motor.efficiency;
        }
    }
    energies
}

/// Where a function changes its sign, or the end when it does not.
fn sign_change(f: &impl Fn(f64) -> f64, begin: f64, end: f64) -> f64 {
    let sign = f(begin) > 0.0;
    if (f(end) > 0.0) == sign {
        return end;
    }
    let (mut low, mut high) = (begin, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
