//! The states at the start and at the end.

use super::limits::{Limits, exceeds};
use super::pointing::Surroundings;
use super::{End, Start};
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spacecraft::Spacecraft;
use crate::model::spec::StateSpec;
use nalgebra::Vector3;

/// Difference between the momentum at the end and the conserved one, relative to the terms, that is
/// attributed to rounding of the wheel speeds.
const MOMENTUM_TOLERANCE: f64 = 1e-6;
/// The same relative to the capacity of the wheels, for momenta that are zero up to rounding.
const CAPACITY_TOLERANCE: f64 = 1e-9;
/// Relative difference of momenta that is attributed to rounding.
const SAME_MOMENTUM: f64 = 1e-12;

pub(super) fn read_start(
    spec: &StateSpec,
    surroundings: Surroundings<'_>,
    limits: &Limits,
    findings: &mut Findings,
) -> Option<Start> {
    let pointing = spec.pointing.as_ref();
    let orientation = surroundings.orientation(&spec.attitude, pointing, "/start", findings);
    let rate = read_rate(spec, "/start", limits, findings);
    let wheel_speed = match &spec.wheel_speed_rad_s {
        None => Some(vec![0.0; limits.wheels.len()]),
        Some(speeds) => read_speeds(speeds, "/start", limits, findings),
    };
    let orientation = orientation?;
    Some(Start {
        attitude: orientation.attitude,
        roll: orientation.roll,
        pointing: orientation.pointing,
        rate: rate?,
        wheel_speed: wheel_speed?,
    })
}

pub(super) fn read_end(
    spec: &StateSpec,
    start: &StateSpec,
    surroundings: Surroundings<'_>,
    limits: &Limits,
    findings: &mut Findings,
) -> Option<End> {
    let pointing = spec.pointing.as_ref();
    let orientation = surroundings.orientation(&spec.attitude, pointing, "/end", findings);
    let rate = read_rate(spec, "/end", limits, findings);
    let wheel_speed = match &spec.wheel_speed_rad_s {
        None => Some(None),
        Some(speeds) => read_speeds(speeds, "/end", limits, findings)
            .filter(|speeds| keeps_locked_wheels(speeds, start, limits, findings))
            .map(Some),
    };
    let orientation = orientation?;
    Some(End {
        attitude: orientation.attitude,
        roll: orientation.roll,
        pointing: orientation.pointing,
        rate: rate?,
        wheel_speed: wheel_speed?,
    })
}

fn read_rate(
    spec: &StateSpec,
    pointer: &str,
    limits: &Limits,
    findings: &mut Findings,
) -> Option<Vector3<f64>> {
    let pointer = format!("{pointer}/body_rate_rad_s");
    let rate = findings.vector(&pointer, spec.body_rate_rad_s.unwrap_or_default())?;
    limits.allow_rate(&rate, &pointer, findings).then_some(rate)
}

fn read_speeds(
    speeds: &[f64],
    pointer: &str,
    limits: &Limits,
    findings: &mut Findings,
) -> Option<Vec<f64>> {
    let pointer = format!("{pointer}/wheel_speed_rad_s");
    let mut valid = speeds.len() == limits.wheels.len();
    if !valid {
        findings.refuse(
            &pointer,
            Code::WrongLength,
            format!("{} speeds for {} wheels", speeds.len(), limits.wheels.len()),
            "give one speed per wheel, in the order of spacecraft.wheels, disabled ones included",
        );
    }
    for (i, &speed) in speeds.iter().enumerate() {
        valid &= findings.finite(&format!("{pointer}/{i}"), speed).is_some();
    }
    (valid && limits.allow_speeds(speeds, &pointer, findings)).then(|| speeds.to_vec())
}

/// A disabled wheel cannot end at another speed than it starts with.
fn keeps_locked_wheels(
    speeds: &[f64],
    start: &StateSpec,
    limits: &Limits,
    findings: &mut Findings,
) -> bool {
    let start_speed = |i| {
        start
            .wheel_speed_rad_s
            .as_ref()
            .map_or(Some(0.0), |s| s.get(i).copied())
    };
    let mut kept = true;
    for (i, (&speed, wheel)) in speeds.iter().zip(&limits.wheels).enumerate() {
        let Some(locked_at) = start_speed(i).filter(|_| wheel.locked) else {
            continue;
        };
        if exceeds(speed - locked_at, MOMENTUM_TOLERANCE * locked_at.abs()) {
            kept = false;
            findings.refuse(
                format!("/end/wheel_speed_rad_s/{i}"),
                Code::ConflictingFields,
                format!(
                    "the wheel is disabled and locked at {locked_at} rad/s, but {speed} rad/s is \
                     asked for"
                ),
                "repeat the start speed of a disabled wheel, or enable it",
            );
        }
    }
    kept
}

/// What may be left open of the attitude at a start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StartRoll {
    /// Nothing: the state is one in which the spacecraft is.
    Known,
    /// The roll about a boresight, which the one slew from there chooses.
    Chosen,
}

impl StartRoll {
    /// Whether a start leaves no more open than that.
    pub(super) fn admits(
        self,
        start: &Start,
        spacecraft: &Spacecraft,
        findings: &mut Findings,
    ) -> bool {
        let Some(free) = &start.roll else {
            return true;
        };
        let momentum = spacecraft.body_momentum(start.rate, &start.wheel_speed);
        let turns = free.axis.cross(&momentum).norm() > SAME_MOMENTUM * momentum.norm();
        let (code, reason) = match self {
            Self::Known => (
                Code::ConflictingFields,
                "a direction does not tell the attitude at the start, which is known",
            ),
            Self::Chosen if turns => (
                Code::RollNotFree,
                "a free roll at the start would turn the momentum that is stored there",
            ),
            Self::Chosen => return true,
        };
        findings.refuse(
            "/start/pointing",
            code,
            reason,
            "give the attitude at the start, or equal roll_min_deg and roll_max_deg",
        );
        false
    }
}

/// Refuses rates and speeds whose momentum is outside the number range.
pub(super) fn momentum_is_finite(
    momentum: &Vector3<f64>,
    pointer: &str,
    findings: &mut Findings,
) -> bool {
    let finite = momentum.norm_squared().is_finite();
    if !finite {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!(
                "the angular momentum {} N m s is beyond all bounds",
                triple(momentum)
            ),
            "lower body_rate_rad_s and wheel_speed_rad_s; both are in rad/s",
        );
    }
    finite
}

/// Whether wheel speeds given at the end carry the conserved momentum at that attitude and rate.
///
/// These are three equations for the speeds of all wheels; three wheels have no other speeds.
/// Without speeds only the size of the rate is checked.
pub(super) fn end_conserves_momentum(
    spacecraft: &Spacecraft,
    start: &Start,
    end: &End,
    findings: &mut Findings,
) -> bool {
    let Some(speeds) = &end.wheel_speed else {
        return momentum_is_finite(&(spacecraft.inertia() * end.rate), "/end", findings);
    };
    let conserved = end.attitude.to_body(start.momentum(spacecraft));
    let given = spacecraft.body_momentum(end.rate, speeds);
    let terms = spacecraft.wheels().iter().zip(speeds);
    let stored: f64 = terms
        .map(|(w, speed)| w.axis.norm() * w.inertia * speed.abs())
        .sum();
    let scale = conserved
        .norm()
        .max(stored)
        .max((spacecraft.inertia() * end.rate).norm());
    let limited = spacecraft
        .wheels()
        .iter()
        .filter(|w| w.max_speed.is_finite());
    let capacity: f64 = limited
        .map(|w| w.axis.norm() * w.inertia * w.max_speed)
        .sum();
    let tolerance = (MOMENTUM_TOLERANCE * scale).max(CAPACITY_TOLERANCE * capacity);
    let turning = end
        .roll
        .map_or(0.0, |free| free.axis.cross(&conserved).norm());
    if turning > tolerance {
        findings.refuse(
            "/end/wheel_speed_rad_s",
            Code::EndMomentumInconsistent,
            format!(
                "wheel speeds at the end fix the roll there: of the conserved momentum {turning:.6e} \
                 N m s turn with it in body axes"
            ),
            "leave the wheel speeds at the end out, or give the attitude there",
        );
        return false;
    }
    if (given - conserved).norm() <= tolerance {
        return true;
    }
    findings.refuse(
        "/end/wheel_speed_rad_s",
        Code::EndMomentumInconsistent,
        format!(
            "with these speeds the momentum in body axes is {} N m s, but the start fixes it at {} \
             N m s",
            triple(&given),
            triple(&conserved)
        ),
        "leave the wheel speeds at the end out, or change them to carry the conserved momentum",
    );
    false
}

fn triple(vector: &Vector3<f64>) -> String {
    format!("({:.6e}, {:.6e}, {:.6e})", vector.x, vector.y, vector.z)
}
