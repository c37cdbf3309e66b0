//! Descriptions of manoeuvres, and manoeuvres that are valid by construction.

use super::flow::{Followers, Vehicle};
use super::ingredients::Ingredients;
use super::motion::Motion;
use super::shape::{Course, Lengths, Shape};
use crate::attitude::Attitude;
use crate::drive::{Drive, DriveSpec};
use crate::dynamics::Dynamics;
use crate::findings::Findings;
use crate::nlp::MAX_CONTROLS;
use crate::problem::{Code, Problem};
use crate::scenario::{RateCondition, Scenario};
use crate::slew::arrival::Arrival;
use crate::spec::{AttitudeEquivalence, OptionsSpec, ScenarioSpec, SpacecraftSpec, StateSpec};
use crate::transcription::{Waypoint, WheelCondition};
use nalgebra::{DVector, Vector3};

/// Most intervals of a manoeuvre.
const MOST_INTERVALS: usize = 2000;
/// Relative error of a duration as a multiple of the sampling period that is rounding.
const MULTIPLE_TOLERANCE: f64 = 1e-9;
/// States of a program beyond those that the engine admits per control.
const STATES_ABOVE: usize = 2;

/// How energy is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The integral of the power, which is smooth but counts what a braking wheel returns.
    Proxy,
    /// What the supply gives: nothing is fed back.
    Bill,
}

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// The duration.
    MinimumTime,
    /// Duration plus `weight`, s/(N m)² per s, times the integral of the squared torques.
    TimeAndEffort {
        /// `rho`.
        weight: f64,
    },
    /// The motors' energy in a given time.
    Energy {
        /// The time, s.
        duration_s: f64,
        /// How energy is counted.
        measure: Measure,
    },
    /// The duration with no more than a given bill. With [`Measure::Bill`] over all motions; with
    /// [`Measure::Proxy`] over the motions that minimise the proxy in their time, as the energy
    /// thesis has it.
    MinimumTimeAtEnergy {
        /// The bill, J.
        energy_j: f64,
        /// What the motions minimise.
        measure: Measure,
    },
}

/// How torque runs between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// It is constant.
    Constant,
    /// It is linear, and continuous across samples.
    Linear,
}

/// Which torques can be commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Constant on intervals of any length.
    Free {
        /// Their number.
        intervals: usize,
    },
    /// Constant on intervals of equal length.
    Uniform {
        /// Their number.
        intervals: usize,
    },
    /// Held on the samples of a clock; the duration is a multiple of the period.
    Sampled {
        /// The period, s.
        period_s: f64,
        /// How torque is held.
        hold: Hold,
    },
    /// Continuous, linear on intervals of equal length.
    Smooth {
        /// Their number.
        intervals: usize,
    },
}

/// What the wheels must hold at the end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FinalWheels {
    /// What attitude and rate leave free is free.
    #[default]
    Free,
    /// The speeds of the end's state.
    Given,
    /// The null-space momentum of the start.
    NullSpaceOfStart,
}

/// A manoeuvre as a caller describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct ManoeuvreSpec {
    /// The spacecraft.
    pub spacecraft: SpacecraftSpec,
    /// One drive per wheel, or none for ideal ones.
    pub drives: Vec<DriveSpec>,
    /// State at the start.
    pub start: StateSpec,
    /// State at the end; its wheel speeds count with [`FinalWheels::Given`] only.
    pub end: StateSpec,
    /// The wheels at the end.
    pub final_wheels: FinalWheels,
    /// What is minimised.
    pub objective: Objective,
    /// What can be commanded.
    pub command: Command,
    /// Meaning of equal attitudes.
    pub attitude_equivalence: AttitudeEquivalence,
    /// Share of every torque limit that may be used.
    pub torque_authority: f64,
    /// Share of every wheel speed limit that may be used.
    pub momentum_authority: f64,
}

impl Default for ManoeuvreSpec {
    fn default() -> Self {
        Self {
            spacecraft: SpacecraftSpec::default(),
            drives: Vec::new(),
            start: StateSpec::default(),
            end: StateSpec::default(),
            final_wheels: FinalWheels::default(),
            objective: Objective::MinimumTime,
            command: Command::Free { intervals: 24 },
            attitude_equivalence: AttitudeEquivalence::default(),
            torque_authority: 1.0,
            momentum_authority: 1.0,
        }
    }
}

/// A valid manoeuvre.
#[derive(Debug, Clone)]
pub struct Manoeuvre {
    scenario: Scenario,
    drives: Vec<Drive>,
    vehicle: Vehicle,
    ends: [Waypoint; 2],
    start_momenta: DVector<f64>,
    arrival: Arrival,
    objective: Objective,
    command: Command,
}

/// A valid manoeuvre with what the caller should know about it.
#[derive(Debug, Clone)]
pub struct Validated {
    /// The manoeuvre.
    pub manoeuvre: Manoeuvre,
    /// Doubts that do not stand in the way.
    pub warnings: Vec<Problem>,
}

impl Manoeuvre {
    /// Validates a description and collects every problem. Pointers are those of the fields:
    /// `/spacecraft`, `/drives`, `/start`, `/end`, `/objective`, `/command`, `/options`.
    ///
    /// # Errors
    ///
    /// All problems at once.
    pub fn try_new(spec: &ManoeuvreSpec) -> Result<Validated, Vec<Problem>> {
        let mut problems = Vec::new();
        let scenario = Scenario::try_new(&scenario_spec(spec));
        let wheels = spec.spacecraft.wheels.len();
        let drives = Drive::read_all(&spec.drives, wheels, "/drives");
        let mut findings = Findings::default();
        let choices = check_choices(spec, &mut findings);
        if let Err(found) = findings.conclude(choices.then_some(())) {
            problems.extend(found);
        }
        let scenario = scenario.map_err(|found| problems.splice(0..0, found).for_each(drop));
        let drives = drives.map_err(|found| problems.extend(found));
        let (Ok(scenario), Ok(drives), true) = (scenario, drives, problems.is_empty()) else {
            return Err(problems);
        };
        Ok(Validated {
            manoeuvre: Self::assemble(spec, scenario.scenario, drives),
            warnings: scenario.warnings,
        })
    }

    fn assemble(spec: &ManoeuvreSpec, scenario: Scenario, drives: Vec<Drive>) -> Self {
        let dynamics = Dynamics::of(&scenario);
        let start = scenario.start();
        let mut followers = Followers::default();
        let wheels = scenario.spacecraft().wheels().iter();
        for ((wheel, drive), speed) in wheels.zip(&drives).zip(&start.wheel_speed) {
            if let Some(law) = drive.speed_law {
                followers.add(wheel.axis * wheel.inertia, law, *speed);
            }
        }
        let start_momenta = dynamics.wheels_of_speeds(&start.rate, &start.wheel_speed);
        let begin = Waypoint {
            attitude: start.attitude,
            rate: fixed(&start.rate),
            wheels: WheelCondition::Fixed(start_momenta.clone()),
            price: None,
        };
        let arrival = match spec.attitude_equivalence {
            AttitudeEquivalence::Rotation => Arrival::Rotation,
            AttitudeEquivalence::Quaternion => Arrival::Quaternion,
        };
        let target = scenario.end().map_or(start.attitude, |end| end.attitude);
        let rate = scenario.end().map_or(start.rate, |end| end.rate);
        let speeds = scenario.end().and_then(|end| end.wheel_speed.clone());
        let wheels = match (spec.final_wheels, speeds) {
            (FinalWheels::Given, Some(speeds)) => {
                WheelCondition::Fixed(dynamics.wheels_of_speeds(&rate, &speeds))
            }
            (FinalWheels::NullSpaceOfStart, _) => {
                WheelCondition::NullSpace(dynamics.null_component(&start_momenta))
            }
            _ => WheelCondition::Free,
        };
        let end = Waypoint {
            attitude: arrival.signed(&target, &start.attitude),
            rate: fixed(&rate),
            wheels,
            price: None,
        };
        let commanded = dynamics.actuators.iter().map(|wheel| drives[wheel.index]);
        Self {
            vehicle: Vehicle {
                drives: commanded.collect(),
                dynamics,
                followers,
            },
            ends: [begin, end],
            start_momenta,
            arrival,
            objective: spec.objective,
            command: spec.command,
            scenario,
            drives,
        }
    }

    /// What is minimised.
    #[must_use]
    pub fn objective(&self) -> Objective {
        self.objective
    }

    /// What can be commanded.
    #[must_use]
    pub fn command(&self) -> Command {
        self.command
    }

    /// The spacecraft with start and end, as a scenario without targets.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The drives of all wheels.
    #[must_use]
    pub fn all_drives(&self) -> &[Drive] {
        &self.drives
    }

    pub(super) fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    pub(super) fn arrival(&self) -> Arrival {
        self.arrival
    }

    /// Momenta of the commanded wheels at the start, N m s.
    pub(super) fn start_momenta(&self) -> &DVector<f64> {
        &self.start_momenta
    }

    pub(super) fn ends(&self) -> &[Waypoint; 2] {
        &self.ends
    }

    /// Both ends, the second with the sign at which a motion arrives.
    pub(super) fn ends_towards(&self, motion: &Motion) -> [Waypoint; 2] {
        let mut ends = self.ends.clone();
        if let Some(last) = motion.attitudes.last() {
            ends[1].attitude = self.arrival.signed(&ends[1].attitude, last);
        }
        ends
    }

    /// Angle between an attitude and the wanted one, rad.
    pub(super) fn missed_by(&self, attitude: &Attitude) -> f64 {
        self.arrival.turn(attitude, &self.ends[1].attitude)
    }

    /// The program's ingredients in continuous time.
    pub(super) fn ingredients(&self) -> Ingredients {
        match self.objective {
            Objective::MinimumTime => Ingredients::TIME,
            Objective::TimeAndEffort { weight } => Ingredients {
                effort: weight,
                ..Ingredients::TIME
            },
            Objective::Energy {
                duration_s,
                measure,
            } => Ingredients::energy_in(duration_s, measure),
            Objective::MinimumTimeAtEnergy { energy_j, measure } => Ingredients {
                measure,
                budget: Some(energy_j),
                ..Ingredients::TIME
            },
        }
    }

    /// The variables of a program for it.
    pub(super) fn shape(&self, course: Course, lengths: Lengths, of: &Ingredients) -> Shape {
        Shape {
            wheels: self.vehicle.dynamics.wheel_count(),
            course,
            clock: of.duration.is_some() && lengths == Lengths::Own,
            lengths,
            account: of.budget.is_some(),
            slacks: of.bills(),
        }
    }

    /// The same manoeuvre at every point of a sweep.
    pub(super) fn along(&self, sweep: &super::Sweep) -> Result<Vec<Self>, Vec<Problem>> {
        let mut findings = Findings::default();
        let (values, field) = match sweep {
            super::Sweep::Durations(values) => (values, "durations_s"),
            super::Sweep::Weights(values) => (values, "weights"),
            super::Sweep::Energies(values) => (values, "energies_j"),
        };
        let points: Vec<_> = values
            .iter()
            .enumerate()
            .map(|(i, value)| {
                let pointer = format!("/sweep/{field}/{i}");
                let value = findings.positive(&pointer, *value)?;
                let objective = match (sweep, self.objective) {
                    (super::Sweep::Durations(_), Objective::Energy { measure, .. }) => {
                        Some(Objective::Energy {
                            duration_s: value,
                            measure,
                        })
                    }
                    (super::Sweep::Weights(_), Objective::TimeAndEffort { .. }) => {
                        Some(Objective::TimeAndEffort { weight: value })
                    }
                    (super::Sweep::Energies(_), Objective::MinimumTimeAtEnergy { measure, .. }) => {
                        Some(Objective::MinimumTimeAtEnergy {
                            energy_j: value,
                            measure,
                        })
                    }
                    _ => None,
                };
                if objective.is_none() {
                    findings.refuse(
                        "/sweep",
                        Code::ConflictingFields,
                        format!("the objective has no {field} to sweep"),
                        "sweep durations of energy, weights of effort, or energies of time",
                    );
                }
                let objective = objective?;
                check_multiple(&objective, &self.command, &pointer, &mut findings)
                    .then(|| Self { objective, ..self.clone() })
            })
            .collect();
        let points = points.into_iter().collect();
        findings.conclude(points).map(|(points, _)| points)
    }
}

fn fixed(rate: &Vector3<f64>) -> [RateCondition; 3] {
    [0, 1, 2].map(|axis| RateCondition::Fixed(rate[axis]))
}

/// The manoeuvre as a scenario without targets; wheels with a law of their own are no actuators.
fn scenario_spec(spec: &ManoeuvreSpec) -> ScenarioSpec {
    let mut spacecraft = spec.spacecraft.clone();
    for (wheel, drive) in spacecraft.wheels.iter_mut().zip(&spec.drives) {
        wheel.enabled &= drive.speed_law.is_none();
    }
    let mut end = spec.end.clone();
    if spec.final_wheels != FinalWheels::Given {
        end.wheel_speed_rad_s = None;
    }
    ScenarioSpec {
        spacecraft,
        start: spec.start.clone(),
        end: Some(end),
        options: OptionsSpec {
            attitude_equivalence: spec.attitude_equivalence,
            torque_authority: spec.torque_authority,
            momentum_authority: spec.momentum_authority,
            ..OptionsSpec::default()
        },
        ..ScenarioSpec::default()
    }
}

/// Checks objective, command and how they go with the wheels; `false` after a fault.
fn check_choices(spec: &ManoeuvreSpec, findings: &mut Findings) -> bool {
    let checks = [
        check_objective(&spec.objective, findings),
        check_command(&spec.command, findings),
        check_multiple(&spec.objective, &spec.command, "/objective/duration_s", findings),
        check_motors(spec, findings),
        check_size(spec, findings),
        check_final_wheels(spec, findings),
        check_laws(spec, findings),
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

fn check_command(command: &Command, findings: &mut Findings) -> bool {
    match *command {
        Command::Sampled { period_s, .. } => {
            findings.positive("/command/period_s", period_s).is_some()
        }
        Command::Free { intervals }
        | Command::Uniform { intervals }
        | Command::Smooth { intervals } => {
            let valid = (2..=MOST_INTERVALS).contains(&intervals);
            if !valid {
                findings.refuse(
                    "/command/intervals",
                    Code::OutOfRange,
                    format!("there are {intervals} intervals"),
                    format!("give 2 to {MOST_INTERVALS} intervals"),
                );
            }
            valid
        }
    }
}

/// A prescribed duration must be a multiple of the period, and not of too many of them.
fn check_multiple(
    objective: &Objective,
    command: &Command,
    pointer: &str,
    findings: &mut Findings,
) -> bool {
    let (Objective::Energy { duration_s, .. }, Command::Sampled { period_s, .. }) =
        (objective, command)
    else {
        return true;
    };
    let samples = duration_s / period_s;
    let valid = (samples - samples.round()).abs() <= MULTIPLE_TOLERANCE * samples
        && (2.0..=MOST_INTERVALS as f64).contains(&samples.round());
    if !valid {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("{duration_s} s are {samples} samples of {period_s} s"),
            format!("give a duration of 2 to {MOST_INTERVALS} whole samples"),
        );
    }
    valid
}

/// Energy needs the motors of all commanded wheels.
fn check_motors(spec: &ManoeuvreSpec, findings: &mut Findings) -> bool {
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

/// The engine is built for so many variables per interval.
fn check_size(spec: &ManoeuvreSpec, findings: &mut Findings) -> bool {
    let lawful = |i: usize| spec.drives.get(i).is_some_and(|drive| drive.speed_law.is_some());
    let wheels = spec.spacecraft.wheels.iter().enumerate();
    let wheels = wheels.filter(|(i, wheel)| wheel.enabled && !lawful(*i)).count();
    let billed = matches!(
        spec.objective,
        Objective::Energy { measure: Measure::Bill, .. }
            | Objective::MinimumTimeAtEnergy { measure: Measure::Bill, .. }
    );
    let ramps = matches!(
        spec.command,
        Command::Smooth { .. } | Command::Sampled { hold: Hold::Linear, .. }
    );
    let controls = wheels * (1 + usize::from(billed)) + 1;
    let states = 3 + wheels * (1 + usize::from(ramps)) + 2;
    let valid = controls <= MAX_CONTROLS && states <= MAX_CONTROLS + STATES_ABOVE;
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

fn check_final_wheels(spec: &ManoeuvreSpec, findings: &mut Findings) -> bool {
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
    let start = spec.start.wheel_speed_rad_s.as_deref().unwrap_or(&[]);
    let moving = spec.drives.iter().enumerate().any(|(i, drive)| {
        drive.speed_law.as_ref().is_some_and(|law| {
            let speed = start.get(i).copied().unwrap_or(0.0);
            law.rate_per_s > 0.0 && law.speed_rad_s != speed
        })
    });
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

/// A wheel that is out of order follows no law.
fn check_laws(spec: &ManoeuvreSpec, findings: &mut Findings) -> bool {
    let mut valid = true;
    for (i, wheel) in spec.spacecraft.wheels.iter().enumerate() {
        let lawful = spec.drives.get(i).is_some_and(|drive| drive.speed_law.is_some());
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
