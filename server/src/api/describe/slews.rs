//! The documents that describe a slew.

use super::inputs::{Equivalence, SpacecraftOrReference, State};
use serde::Serialize;
use utoipa::ToSchema;

/// One slew, or the same along a sweep. Numbers are SI with the unit in the field name.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct SlewBody {
    /// Free text.
    #[schema(required = false)]
    name: Option<String>,
    spacecraft: SpacecraftOrReference,
    /// One for each wheel, in the order of the wheels; ideal drives without it.
    #[schema(required = false)]
    drives: Option<Vec<Drive>>,
    start: State,
    /// Wheel speeds count only where `final_wheels` is `given`.
    end: State,
    /// What the wheels hold at the end; `free` without it.
    #[schema(required = false)]
    final_wheels: Option<FinalWheels>,
    /// Minimum time without it.
    #[schema(required = false)]
    objective: Option<SlewObjective>,
    /// Constant torques on 24 intervals of any length without it.
    #[schema(required = false)]
    command: Option<SlewCommand>,
    /// How torque is shared out among the wheels; `free` without it.
    #[schema(required = false)]
    allocation: Option<Allocation>,
    /// Values for which the slew is solved one after the other; the objective's own is not used.
    #[schema(required = false)]
    sweep: Option<Sweep>,
    /// Whether costates, Hamiltonian and switching functions are wanted; not with a sweep.
    #[schema(required = false, default = false)]
    evidence: Option<bool>,
    #[schema(required = false)]
    options: Option<SlewOptions>,
}

/// How a wheel is driven.
#[derive(Serialize, ToSchema)]
#[schema(as = WheelDrive)]
#[serde(deny_unknown_fields)]
pub(super) struct Drive {
    #[schema(required = false, minimum = 0, default = 0.0)]
    viscous_friction_nms: Option<f64>,
    #[schema(required = false, minimum = 0, default = 0.0)]
    coulomb_friction_nm: Option<f64>,
    /// Whether an inner loop makes up for friction: the torque limits are then the motor's.
    #[schema(required = false, default = true)]
    friction_compensated: Option<bool>,
    /// What the motor consumes.
    #[schema(required = false)]
    motor: Option<Motor>,
    /// The wheel follows this by itself and is not commanded.
    #[schema(required = false)]
    speed_law: Option<SpeedLaw>,
}

/// Power is `resistance (torque / torque constant)^2 + torque speed`.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Motor {
    #[schema(exclusive_minimum = 0)]
    resistance_ohm: f64,
    #[schema(exclusive_minimum = 0)]
    torque_constant_nm_a: f64,
    /// Share of the supplied power that reaches the motor.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    efficiency: Option<f64>,
    /// What the electronics take without any torque.
    #[schema(required = false, minimum = 0, default = 0.0)]
    quiescent_power_w: Option<f64>,
}

/// The speed `W` relative to the body follows `W' = -rate (W - speed)`.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct SpeedLaw {
    /// Zero leaves the wheel idle.
    #[schema(minimum = 0)]
    rate_per_s: f64,
    speed_rad_s: f64,
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum FinalWheels {
    Free,
    Given,
    NullSpaceOfStart,
}

/// `free`: in any way within the limits. `pseudo_inverse`: by the pseudo-inverse of the wheel axes, so
/// that null-space momentum stays what it is at the start; not with `given` final wheels.
#[derive(Serialize, ToSchema)]
#[schema(as = SlewAllocation)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum Allocation {
    Free,
    PseudoInverse,
}

/// What is minimised.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum SlewObjective {
    /// The duration.
    MinimumTime,
    /// Duration plus weight times the integral of the squared torques.
    TimeAndEffort {
        /// s per (N m)² s.
        #[schema(minimum = 0)]
        weight: f64,
    },
    /// The motors' energy in a given time.
    Energy {
        #[schema(exclusive_minimum = 0)]
        duration_s: f64,
        #[schema(required = false)]
        measure: Option<Measure>,
    },
    /// The duration with no more than a given bill.
    MinimumTimeAtEnergy {
        #[schema(exclusive_minimum = 0)]
        energy_j: f64,
        #[schema(required = false)]
        measure: Option<Measure>,
    },
}

/// `bill`: nothing is fed back (the default). `proxy`: the smooth integral of the power.
#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum Measure {
    Bill,
    Proxy,
}

/// Which torques can be commanded.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum SlewCommand {
    /// Constant on intervals of any length; more of them where momentum turns under a rate limit.
    Free {
        #[schema(required = false, minimum = 2)]
        intervals: Option<u32>,
    },
    /// Constant on intervals of equal length.
    Uniform {
        #[schema(required = false, minimum = 2)]
        intervals: Option<u32>,
    },
    /// Continuous, linear on intervals of equal length.
    Smooth {
        #[schema(required = false, minimum = 2)]
        intervals: Option<u32>,
    },
    /// Held on the samples of a clock; the duration is a multiple of the period.
    Sampled {
        #[schema(exclusive_minimum = 0)]
        period_s: f64,
        #[schema(required = false)]
        hold: Option<Hold>,
    },
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum Hold {
    Constant,
    Linear,
}

/// Exactly one list.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Sweep {
    /// Of the objective `energy`.
    #[schema(required = false, min_items = 1, max_items = 200)]
    durations_s: Option<Vec<f64>>,
    /// Of the objective `time_and_effort`.
    #[schema(required = false, min_items = 1, max_items = 200)]
    weights: Option<Vec<f64>>,
    /// Of the objective `minimum_time_at_energy`.
    #[schema(required = false, min_items = 1, max_items = 200)]
    energies_j: Option<Vec<f64>>,
}

/// Options of a slew.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct SlewOptions {
    #[schema(required = false)]
    attitude_equivalence: Option<Equivalence>,
    /// Share of every torque limit that may be used.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    torque_authority: Option<f64>,
    /// Share of every wheel speed limit that may be used.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    momentum_authority: Option<f64>,
    /// Wall-clock limit; 60 without it, none but the service's own with `null`.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1e9)]
    time_limit_s: Option<f64>,
}
