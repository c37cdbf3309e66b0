//! Slews that are valid by construction.

use super::choices;
use super::cost_weights::CostWeights;
use super::motion::SlewMotion;
use super::shape::{IntervalLengths, ProgramShape, TorqueCourse};
use super::spec::{FinalWheels, Objective, SlewSpec, TorqueCommand, WheelAllocation};
use super::vehicle::{SpeedLawWheels, Vehicle};
use crate::leg::solve::arrival::Arrival;
use crate::model::attitude::Attitude;
use crate::model::cone::forbidden_always;
use crate::model::drive::Drive;
use crate::model::dynamics::{Authority, Dynamics};
use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};
use crate::model::scenario::{RateCondition, Scenario, cone_problems};
use crate::model::spec::{AttitudeEquivalence, OptionsSpec, ScenarioSpec};
use crate::model::waypoint::{Waypoint, WheelCondition, nearest_rolls};
use nalgebra::{DVector, Vector3};

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
    command: TorqueCommand,
}

/// A valid slew, and warnings about it.
#[derive(Debug, Clone)]
pub struct ValidatedSlew {
    /// The slew.
    pub slew: Slew,
    /// Remarks that do not keep the slew from being solved.
    pub warnings: Vec<Problem>,
}

impl Slew {
    /// Validates a description and collects every problem. Pointers are those of the fields:
    /// `/spacecraft`, `/drives`, `/start`, `/end`, `/keep_out`, `/keep_in`, `/objective`, `/command`,
    /// `/allocation`, `/options`.
    ///
    /// # Errors
    ///
    /// All problems at once.
    pub fn try_new(spec: &SlewSpec) -> Result<ValidatedSlew, Vec<Problem>> {
        let mut problems = Vec::new();
        let scenario = Scenario::of_one_slew(&scenario_spec(spec));
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
        let enclosed = cone_problems(&scenario.scenario);
        if !enclosed.is_empty() {
            return Err(enclosed);
        }
        let mut warnings = scenario.warnings;
        // A slew never has any.
        warnings.retain(|warning| warning.code != Code::NoTargets);
        Ok(ValidatedSlew {
            slew: Self::assemble(spec, scenario.scenario, drives),
            warnings,
        })
    }

    fn assemble(spec: &SlewSpec, scenario: Scenario, drives: Vec<Drive>) -> Self {
        let start = scenario.start();
        let authority = Authority::of(scenario.options());
        let dynamics = Dynamics::of(scenario.spacecraft(), start, authority);
        let dynamics = dynamics.with_cones(forbidden_always(scenario.cones()));
        let mut speed_law_wheels = SpeedLawWheels::default();
        let wheels = scenario.spacecraft().wheels().iter();
        for ((wheel, drive), speed) in wheels.zip(&drives).zip(&start.wheel_speed) {
            if let Some(law) = drive.speed_law {
                speed_law_wheels.add(wheel.axis * wheel.inertia, law, *speed);
            }
        }
        let start_momenta = dynamics.wheels_of_speeds(&start.rate, &start.wheel_speed);
        let begin = Waypoint {
            attitude: start.attitude,
            roll: scenario.clear_rolls(start.roll.as_ref(), &start.attitude, false),
            rate: fixed(&start.rate),
            wheels: WheelCondition::Fixed(start_momenta.clone()),
            costates: None,
        };
        let arrival = match spec.options.attitude_equivalence {
            AttitudeEquivalence::Rotation => Arrival::Rotation,
            AttitudeEquivalence::Quaternion => Arrival::Quaternion,
        };
        let target = scenario.end().map_or(start.attitude, |end| end.attitude);
        let end_rolls = scenario
            .end()
            .and_then(|end| scenario.clear_rolls(end.roll.as_ref(), &end.attitude, false));
        let rate = scenario.end().map_or(start.rate, |end| end.rate);
        let speeds = scenario.end().and_then(|end| end.wheel_speed.clone());
        let null = dynamics.null_component(&start_momenta);
        let pinned_null = (spec.allocation == WheelAllocation::PseudoInverse).then(|| null.clone());
        let wheels = match (spec.final_wheels, speeds) {
            (FinalWheels::Given, Some(speeds)) => {
                WheelCondition::Fixed(dynamics.wheels_of_speeds(&rate, &speeds))
            }
            (FinalWheels::NullSpaceOfStart, _) => WheelCondition::NullSpace(null),
            _ if pinned_null.is_some() => WheelCondition::NullSpace(null),
            _ => WheelCondition::Free,
        };
        let end = Waypoint {
            attitude: arrival.signed(&target, &start.attitude),
            roll: end_rolls,
            rate: fixed(&rate),
            wheels,
            costates: None,
        };
        let commanded = dynamics.actuators.iter().map(|wheel| drives[wheel.index]);
        Self {
            vehicle: Vehicle {
                drives: commanded.collect(),
                dynamics,
                speed_law_wheels,
                pinned_null,
            },
            ends: nearest_rolls(&begin, &end),
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
    pub fn command(&self) -> TorqueCommand {
        self.command
    }

    /// How torque is allocated to the wheels.
    #[must_use]
    pub fn allocation(&self) -> WheelAllocation {
        match self.vehicle.pinned_null {
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

    /// Both ends, described from the attitudes in which a motion passes them; the quaternion of the
    /// second has the sign with which the motion arrives.
    pub(super) fn ends_towards(&self, motion: &SlewMotion) -> [Waypoint; 2] {
        let mut ends = self.ends.clone();
        if let [first, .., last] = &motion.attitudes[..] {
            ends[0] = ends[0].rolled_towards(first);
            ends[1] = ends[1].rolled_towards(last);
            ends[1].attitude = self.arrival.signed(&ends[1].attitude, last);
        }
        ends
    }

    /// Angle between an attitude and the nearest one that is admissible at the end, rad.
    pub(super) fn missed_by(&self, attitude: &Attitude) -> f64 {
        let end = self.ends[1].rolled_towards(attitude);
        self.arrival.turn(attitude, &end.attitude)
    }

    /// The program's cost weights in continuous time.
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

    /// The variables of a program for the slew.
    pub(super) fn shape(
        &self,
        course: TorqueCourse,
        lengths: IntervalLengths,
        of: &CostWeights,
    ) -> ProgramShape {
        ProgramShape {
            wheels: self.vehicle.dynamics.wheel_count(),
            course,
            clock: self.vehicle.speed_law_wheels.any_drift()
                || of.duration.is_some() && lengths == IntervalLengths::Free,
            lengths,
            energy_account: of.budget.is_some(),
            slacks: of.uses_bill(),
        }
    }

    /// The same slew without cones, which its propagation still observes.
    pub(super) fn without_cones(&self) -> Self {
        let mut free = self.clone();
        free.vehicle.dynamics.cones.clear();
        free
    }

    /// The same slew with another objective.
    pub(super) fn with_objective(&self, objective: Objective) -> Self {
        Self {
            objective,
            ..self.clone()
        }
    }
}

fn fixed(rate: &Vector3<f64>) -> [RateCondition; 3] {
    [0, 1, 2].map(|axis| RateCondition::Fixed(rate[axis]))
}

/// The slew as a scenario without targets; wheels under a speed law are disabled in it.
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
        epoch: spec.epoch.clone(),
        time_system: spec.time_system,
        reference_frame: spec.reference_frame,
        keep_out: spec.keep_out.clone(),
        keep_in: spec.keep_in.clone(),
        spacecraft,
        start: spec.start.clone(),
        end: Some(end),
        options: OptionsSpec {
            attitude_equivalence: spec.options.attitude_equivalence,
            torque_authority: spec.options.torque_authority,
            momentum_authority: spec.options.momentum_authority,
            ..OptionsSpec::default()
        },
        ..ScenarioSpec::default()
    }
}
