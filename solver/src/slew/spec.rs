//! Descriptions of slews, and slews that are valid by construction.

use super::choices;
use super::cost_weights::CostWeights;
use super::flow::{Followers, Vehicle};
use super::motion::SlewMotion;
use super::shape::{Course, Lengths, Shape};
use crate::leg::solve::arrival::Arrival;
use crate::model::attitude::Attitude;
use crate::model::drive::{Drive, DriveSpec};
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::{
    AttitudeEquivalence, OptionsSpec, ScenarioSpec, SpacecraftSpec, StateSpec,
};
use crate::model::waypoint::{Waypoint, WheelCondition};
use nalgebra::{DVector, Vector3};

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
    /// Duration plus `weight`, 1/(N m)², times the integral of the squared torques.
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

/// How torque on the body is shared out among the wheels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum WheelAllocation {
    /// Any way within the limits: the wheels' torques are free of each other.
    #[default]
    Free,
    /// By the pseudo-inverse, as most flight software does: `u = A^+ A u`. Null-space momentum stays
    /// what it is at the start, and less than the [full envelope](crate::wheels::array) is within reach.
    PseudoInverse,
}

impl WheelAllocation {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Free, Self::PseudoInverse];

    /// The stable text of the allocation.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::PseudoInverse => "pseudo_inverse",
        }
    }
}

/// A slew as a caller describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct SlewSpec {
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
    /// How torque is shared out among the wheels.
    pub allocation: WheelAllocation,
    /// Meaning of equal attitudes.
    pub attitude_equivalence: AttitudeEquivalence,
    /// Share of every torque limit that may be used.
    pub torque_authority: f64,
    /// Share of every wheel speed limit that may be used.
    pub momentum_authority: f64,
}

impl Default for SlewSpec {
    fn default() -> Self {
        Self {
            spacecraft: SpacecraftSpec::default(),
            drives: Vec::new(),
            start: StateSpec::default(),
            end: StateSpec::default(),
            final_wheels: FinalWheels::default(),
            objective: Objective::MinimumTime,
            command: Command::Free { intervals: 24 },
            allocation: WheelAllocation::default(),
            attitude_equivalence: AttitudeEquivalence::default(),
            torque_authority: 1.0,
            momentum_authority: 1.0,
        }
    }
}

/// A valid slew.
#[derive(Debug, Clone)]
pub struct Slew {
    scenario: Scenario,
    drives: Vec<Drive>,
    vehicle: Vehicle,
    ends: [Waypoint; 2],
    start_momenta: DVector<f64>,
    arrival: Arrival,
    objective: Objective,
    command: Command,
}

/// A valid slew with what the caller should know about it.
#[derive(Debug, Clone)]
pub struct Validated {
    /// The slew.
    pub slew: Slew,
    /// Doubts that do not stand in the way.
    pub warnings: Vec<Problem>,
}

impl Slew {
    /// Validates a description and collects every problem. Pointers are those of the fields:
    /// `/spacecraft`, `/drives`, `/start`, `/end`, `/objective`, `/command`, `/allocation`, `/options`.
    ///
    /// # Errors
    ///
    /// All problems at once.
    pub fn try_new(spec: &SlewSpec) -> Result<Validated, Vec<Problem>> {
        let mut problems = Vec::new();
        let scenario = Scenario::try_new(&scenario_spec(spec));
        let wheels = spec.spacecraft.wheels.len();
        let drives = Drive::read_all(&spec.drives, wheels, "/drives");
        let mut findings = Findings::default();
        let choices = choices::check(spec, &mut findings);
        if let Err(found) = findings.conclude(choices.then_some(())) {
            problems.extend(found);
        }
        let scenario = scenario.map_err(|found| problems.splice(0..0, found).for_each(drop));
        let drives = drives.map_err(|found| problems.extend(found));
        let (Ok(scenario), Ok(drives), true) = (scenario, drives, problems.is_empty()) else {
            return Err(problems);
        };
        Ok(Validated {
            slew: Self::assemble(spec, scenario.scenario, drives),
            warnings: scenario.warnings,
        })
    }

    fn assemble(spec: &SlewSpec, scenario: Scenario, drives: Vec<Drive>) -> Self {
        let start = scenario.start();
        let authority = Authority::of(scenario.options());
        let dynamics = Dynamics::of(scenario.spacecraft(), start, authority);
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
            costates: None,
        };
        let arrival = match spec.attitude_equivalence {
            AttitudeEquivalence::Rotation => Arrival::Rotation,
            AttitudeEquivalence::Quaternion => Arrival::Quaternion,
        };
        let target = scenario.end().map_or(start.attitude, |end| end.attitude);
        let rate = scenario.end().map_or(start.rate, |end| end.rate);
        let speeds = scenario.end().and_then(|end| end.wheel_speed.clone());
        let null = dynamics.null_component(&start_momenta);
        let kept = (spec.allocation == WheelAllocation::PseudoInverse).then(|| null.clone());
        let wheels = match (spec.final_wheels, speeds) {
            (FinalWheels::Given, Some(speeds)) => {
                WheelCondition::Fixed(dynamics.wheels_of_speeds(&rate, &speeds))
            }
            (FinalWheels::NullSpaceOfStart, _) => WheelCondition::NullSpace(null),
            _ if kept.is_some() => WheelCondition::NullSpace(null),
            _ => WheelCondition::Free,
        };
        let end = Waypoint {
            attitude: arrival.signed(&target, &start.attitude),
            rate: fixed(&rate),
            wheels,
            costates: None,
        };
        let commanded = dynamics.actuators.iter().map(|wheel| drives[wheel.index]);
        Self {
            vehicle: Vehicle {
                drives: commanded.collect(),
                dynamics,
                followers,
                kept,
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

    /// How torque is shared out among the wheels.
    #[must_use]
    pub fn allocation(&self) -> WheelAllocation {
        match self.vehicle.kept {
            Some(_) => WheelAllocation::PseudoInverse,
            None => WheelAllocation::Free,
        }
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
    pub(super) fn ends_towards(&self, motion: &SlewMotion) -> [Waypoint; 2] {
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

    /// The program's cost_weights in continuous time.
    pub(super) fn cost_weights(&self) -> CostWeights {
        match self.objective {
            Objective::MinimumTime => CostWeights::TIME,
            Objective::TimeAndEffort { weight } => CostWeights {
                effort: weight,
                ..CostWeights::TIME
            },
            Objective::Energy {
                duration_s,
                measure,
            } => CostWeights::energy_in(duration_s, measure),
            Objective::MinimumTimeAtEnergy { energy_j, measure } => CostWeights {
                measure,
                budget: Some(energy_j),
                ..CostWeights::TIME
            },
        }
    }

    /// The variables of a program for it.
    pub(super) fn shape(&self, course: Course, lengths: Lengths, of: &CostWeights) -> Shape {
        Shape {
            wheels: self.vehicle.dynamics.wheel_count(),
            course,
            clock: self.vehicle.followers.move_at_all()
                || of.duration.is_some() && lengths == Lengths::Own,
            lengths,
            account: of.budget.is_some(),
            slacks: of.bills(),
        }
    }

    /// The same slew at every point of a sweep.
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
                choices::check_multiple(&objective, &self.command, &pointer, &mut findings).then(
                    || Self {
                        objective,
                        ..self.clone()
                    },
                )
            })
            .collect();
        let points = points.into_iter().collect();
        findings.conclude(points).map(|(points, _)| points)
    }
}

fn fixed(rate: &Vector3<f64>) -> [RateCondition; 3] {
    [0, 1, 2].map(|axis| RateCondition::Fixed(rate[axis]))
}

/// The slew as a scenario without targets; wheels with a law of their own are no actuators.
fn scenario_spec(spec: &SlewSpec) -> ScenarioSpec {
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
