//! Validation of a slew's objective, command and conditions against its wheels and drives.

use super::spec::{
    EnergyMeasure, FinalWheels, Objective, SampleHold, SlewSpec, TorqueCommand, WheelAllocation,
};
use crate::model::cone::{Applies, Side};
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::ConeSpec;
use crate::nlp::{MAX_CONTROLS, MAX_STATES};

/// Greatest number of intervals of a slew.
pub(super) const MAX_INTERVALS: usize = 2000;
/// Relative deviation of a duration from a multiple of the sampling period that counts as rounding.
const MULTIPLE_TOLERANCE: f64 = 1e-9;

/// Checks everything; `false` when anything was refused.
pub(super) fn check(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let checks = [
        check_objective(&spec.objective, findings),
        check_command(&spec.command, findings),
        check_multiple(
            &spec.objective,
            &spec.command,
            "/objective/duration_s",
            findings,
        ),
        check_motors(spec, findings),
        check_size(spec, findings),
        check_final_wheels(spec, findings),
        check_laws(spec, findings),
        check_allocation(spec, findings),
        check_cones(spec, findings),
    ];
    checks.iter().all(|passed| *passed)
}

fn check_objective(objective: &Objective, findings: &mut Findings) -> bool {
    match *objective {
        Objective::MinimumTime => true,
        Objective::TimeAndEffort { weight } => {
            findings.positive("/objective/weight", weight).is_some()
        }
        Objective::Energy { duration_s, .. } => findings
            .positive("/objective/duration_s", duration_s)
            .is_some(),
        Objective::MinimumTimeAtEnergy { energy_j, .. } => {
            findings.positive("/objective/energy_j", energy_j).is_some()
        }
    }
}

fn check_command(command: &TorqueCommand, findings: &mut Findings) -> bool {
    match *command {
        TorqueCommand::Sampled { period_s, .. } => {
            findings.positive("/command/period_s", period_s).is_some()
        }
        TorqueCommand::Free { intervals }
        | TorqueCommand::Uniform { intervals }
        | TorqueCommand::Smooth { intervals } => {
            let valid = (2..=MAX_INTERVALS).contains(&intervals);
            if !valid {
                findings.refuse(
                    "/command/intervals",
                    Code::OutOfRange,
                    format!("there are {intervals} intervals"),
                    format!("give 2 to {MAX_INTERVALS} intervals"),
                );
            }
            valid
        }
    }
}

/// A prescribed duration must be a multiple of the sampling period, with at least 2 and at most
/// [`MAX_INTERVALS`] samples.
pub(super) fn check_multiple(
    objective: &Objective,
    command: &TorqueCommand,
    pointer: &str,
    findings: &mut Findings,
) -> bool {
    let (Objective::Energy { duration_s, .. }, TorqueCommand::Sampled { period_s, .. }) =
        (objective, command)
    else {
        return true;
    };
    let samples = duration_s / period_s;
    let valid = (samples - samples.round()).abs() <= MULTIPLE_TOLERANCE * samples
        && (2.0..=MAX_INTERVALS as f64).contains(&samples.round());
    if !valid {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("{duration_s} s are {samples} samples of {period_s} s"),
            format!("give a duration of 2 to {MAX_INTERVALS} whole samples"),
        );
    }
    valid
}

/// Objectives with energy need the motor of every commanded wheel.
fn check_motors(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let needed = matches!(
        spec.objective,
        Objective::Energy { .. } | Objective::MinimumTimeAtEnergy { .. }
    );
    let mut known = true;
    for (i, wheel) in spec.spacecraft.wheels.iter().enumerate().filter(|_| needed) {
        let drive = spec.drives.get(i);
        let commanded = wheel.enabled && drive.is_none_or(|drive| drive.speed_law.is_none());
        if commanded && drive.is_none_or(|drive| drive.motor.is_none()) {
            known = false;
            findings.refuse(
                format!("/drives/{i}/motor"),
                Code::MissingField,
                "the objective is about energy, but nothing is known of this wheel's motor",
                "give resistance_ohm and torque_constant_nm_a, or another objective",
            );
        }
    }
    known
}

/// The number of variables per interval must not exceed that of the interior-point solver.
fn check_size(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let lawful = |i: usize| {
        spec.drives
            .get(i)
            .is_some_and(|drive| drive.speed_law.is_some())
    };
    let wheels = spec.spacecraft.wheels.iter().enumerate();
    let wheels = wheels
        .filter(|(i, wheel)| wheel.enabled && !lawful(*i))
        .count();
    let billed = matches!(
        spec.objective,
        Objective::Energy {
            measure: EnergyMeasure::Bill,
            ..
        } | Objective::MinimumTimeAtEnergy {
            measure: EnergyMeasure::Bill,
            ..
        }
    );
    let ramps = matches!(
        spec.command,
        TorqueCommand::Smooth { .. }
            | TorqueCommand::Sampled {
                hold: SampleHold::Linear,
                ..
            }
    );
    let controls = wheels * (1 + usize::from(billed)) + 1;
    let states = 3 + wheels * (1 + usize::from(ramps)) + 2 + usize::from(drifts(spec));
    let valid = controls <= MAX_CONTROLS && states <= MAX_STATES;
    if !valid {
        findings.refuse(
            "/spacecraft/wheels",
            Code::TooManyWheels,
            format!("{wheels} commanded wheels are too many for this objective and command"),
            "disable wheels to spare, or choose constant torques or another objective",
        );
    }
    valid
}

fn check_final_wheels(spec: &SlewSpec, findings: &mut Findings) -> bool {
    if spec.final_wheels != FinalWheels::Given {
        return true;
    }
    if spec.end.wheel_speed_rad_s.is_none() {
        findings.refuse(
            "/end/wheel_speed_rad_s",
            Code::MissingField,
            "the wheels are to end at given speeds, but none are given",
            "give one speed per wheel, or leave the wheels free at the end",
        );
        return false;
    }
    let moving = drifts(spec);
    if moving {
        findings.refuse(
            "/end/wheel_speed_rad_s",
            Code::ConflictingFields,
            "speeds are given for the end while a speed law moves another wheel's momentum",
            "leave the wheels free at the end, or pin their null-space momentum",
        );
    }
    !moving
}

/// Whether a speed law changes the speed of any wheel.
fn drifts(spec: &SlewSpec) -> bool {
    let start = spec.start.wheel_speed_rad_s.as_deref().unwrap_or(&[]);
    spec.drives.iter().enumerate().any(|(i, drive)| {
        drive.speed_law.as_ref().is_some_and(|law| {
            let speed = start.get(i).copied().unwrap_or(0.0);
            law.rate_per_s > 0.0 && (law.speed_rad_s - speed).abs() > 0.0
        })
    })
}

/// A disabled wheel must not have a speed law.
fn check_laws(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let mut valid = true;
    for (i, wheel) in spec.spacecraft.wheels.iter().enumerate() {
        let lawful = spec
            .drives
            .get(i)
            .is_some_and(|drive| drive.speed_law.is_some());
        if lawful && !wheel.enabled {
            valid = false;
            findings.refuse(
                format!("/drives/{i}/speed_law"),
                Code::ConflictingFields,
                "the wheel is disabled, so it cannot follow a speed law",
                "enable the wheel, or remove the law: a disabled wheel keeps its speed",
            );
        }
    }
    valid
}

/// With the pseudo-inverse the null-space momentum stays constant, so that speeds at the end must not be
/// given.
fn check_allocation(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let valid = spec.allocation == WheelAllocation::Free || spec.final_wheels != FinalWheels::Given;
    if !valid {
        findings.refuse(
            "/allocation",
            Code::ConflictingFields,
            "the pseudo-inverse keeps the null-space momentum of the start, but speeds are given \
             for the end",
            "leave the wheels free at the end: attitude, rate and start settle their speeds",
        );
    }
    valid
}

/// A cone that holds at targets would never hold.
fn check_cones(spec: &SlewSpec, findings: &mut Findings) -> bool {
    let mut valid = true;
    for (side, cones) in [(Side::Out, &spec.keep_out), (Side::In, &spec.keep_in)] {
        let at_targets = |cone: &ConeSpec| cone.applies == Applies::AtTargets;
        for index in (0..cones.len()).filter(|index| at_targets(&cones[*index])) {
            valid = false;
            findings.refuse(
                format!("/{}/{index}/applies", side.list()),
                Code::ConflictingFields,
                "a slew has no targets at which the cone could hold",
                "write \"always\", or \"report\" for a cone that is not enforced",
            );
        }
    }
    valid
}
