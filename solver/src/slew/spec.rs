//! What a caller may ask of a slew: plain descriptions, not yet validated.

use crate::model::drive::DriveSpec;
use crate::model::spec::{AttitudeEquivalence, SpacecraftSpec, StateSpec};

/// How energy is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnergyMeasure {
    /// The integral of the power, which is smooth but counts what a braking wheel returns.
    Proxy,
    /// The energy drawn from the supply: braking returns nothing.
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
        measure: EnergyMeasure,
    },
    /// The duration with no more than a given bill. With [`EnergyMeasure::Bill`] over all motions; with
    /// [`EnergyMeasure::Proxy`] over the motions that minimise the proxy in their time, as the energy
    /// thesis has it.
    MinimumTimeAtEnergy {
        /// The bill, J.
        energy_j: f64,
        /// What the motions minimise.
        measure: EnergyMeasure,
    },
}

/// Torque as a function of time between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleHold {
    /// Constant.
    Constant,
    /// Linear, and continuous across samples.
    Linear,
}

/// Which torques can be commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TorqueCommand {
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
        hold: SampleHold,
    },
    /// Continuous, linear on intervals of equal length.
    Smooth {
        /// Their number.
        intervals: usize,
    },
}

/// Condition on the wheels at the end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FinalWheels {
    /// None besides conservation of momentum at the final attitude and rate.
    #[default]
    Free,
    /// The speeds of the end's state.
    Given,
    /// The null-space momentum of the start.
    NullSpaceOfStart,
}

/// How torque on the body is allocated to the wheels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum WheelAllocation {
    /// Every wheel's torque is chosen by itself, within its limits.
    #[default]
    Free,
    /// By the pseudo-inverse, as in most flight software: `u = A^+ A u`. Null-space momentum stays
    /// that of the start, and less than the [full envelope](crate::wheels::array) can be reached.
    PseudoInverse,
}

impl WheelAllocation {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Free, Self::PseudoInverse];
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
    pub command: TorqueCommand,
    /// How torque is allocated to the wheels.
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
            command: TorqueCommand::Free { intervals: 24 },
            allocation: WheelAllocation::default(),
            attitude_equivalence: AttitudeEquivalence::default(),
            torque_authority: 1.0,
            momentum_authority: 1.0,
        }
    }
}
