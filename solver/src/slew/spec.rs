//! A slew as a caller describes it: plain, unvalidated.

use crate::model::drive::DriveSpec;
use crate::model::epoch;
use crate::model::input::{
    self, InputForm, InputPlace, MemberSchema, NamedSchema, Schema, UpTo, input_choice,
    input_object, input_union, nullable, optional, or, required, required_elsewhere, required_or,
};
use crate::model::problem::Code;
use crate::model::spec::{
    AttitudeEquivalence, ConeSpec, MAX_CONES, ReferenceFrame, SpacecraftOrReference,
    SpacecraftSpec, StateSpec, TimeSystem,
};

/// Number of intervals of a command that gives none.
pub const DEFAULT_INTERVALS: usize = 24;
/// Greatest number of points of a sweep.
pub const MAX_POINTS: usize = 200;

input_object! {
    /// One slew, or the same along a sweep. Numbers are SI with the unit in the field name.
    #[derive(Default)]
    pub struct SlewSpec as "SlewBody" {
        /// Free text.
        pub name: Option<String> = optional(),
        /// Epoch of time zero in the time system, which says where the Sun is.
        pub epoch: Option<String> = optional().pattern(epoch::PATTERN),
        /// Time system of the epoch, UTC without it.
        pub time_system: Option<TimeSystem> = optional(),
        /// Reference frame of all attitudes and directions, EME2000 without it.
        pub reference_frame: Option<ReferenceFrame> = optional(),
        /// Values for which the slew is solved one after the other; the objective's own is not used.
        pub sweep: Option<Sweep> = optional(),
        /// The spacecraft.
        pub spacecraft: SpacecraftSpec as SpacecraftOrReference
            = required_or(SpacecraftSpec::substitute()),
        /// One for each wheel, in the order of the wheels; ideal drives without it.
        pub drives: Vec<DriveSpec> = or(Vec::new()),
        /// State at the start.
        pub start: StateSpec = required_or(StateSpec::default()),
        /// State at the end; its wheel speeds count with `final_wheels` `given` only.
        pub end: StateSpec = required_or(StateSpec::default()),
        /// Cones in which a boresight must not point; `at_targets` is refused, as a slew has no targets.
        pub keep_out: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// Cones in which a boresight must point; likewise.
        pub keep_in: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// Condition on the wheels at the end; `free` without it.
        pub final_wheels: FinalWheels = or(FinalWheels::default()),
        /// What is minimised; `minimum_time` without it.
        pub objective: Objective = or(Objective::default()),
        /// What can be commanded; constant torques on 24 intervals of any length without it.
        pub command: TorqueCommand = or(TorqueCommand::default()),
        /// How torque is allocated to the wheels; `free` without it.
        pub allocation: WheelAllocation = or(WheelAllocation::default()),
        /// Options of the solve.
        pub options: SlewOptionsSpec = or(SlewOptionsSpec::default()),
        /// Whether costates, Hamiltonian and switching functions are wanted; not with a sweep.
        pub evidence: bool = or(false),
    }
}

input_object! {
    /// Options of a slew.
    pub struct SlewOptionsSpec as "SlewOptions" {
        /// Whether q and -q are the same attitude.
        pub attitude_equivalence: AttitudeEquivalence = or(AttitudeEquivalence::default()),
        /// Share of every torque limit that may be used.
        pub torque_authority: f64 = or(1.0).above(0.0).at_most(1.0),
        /// Share of every wheel speed limit that may be used.
        pub momentum_authority: f64 = or(1.0).above(0.0).at_most(1.0),
        /// Wall-clock limit; 60 without it, none but the service's own with `null`.
        pub time_limit_s: Option<f64> = nullable(60.0).above(0.0).at_most(1e9),
    }
}

impl Default for SlewOptionsSpec {
    fn default() -> Self {
        input::left_out::<Self>()
    }
}

input_union! {
    /// What is minimised. Along a sweep the value of the objective itself may be left out.
    #[derive(Copy)]
    pub enum Objective as "SlewObjective" {
        /// The duration.
        MinimumTime = "minimum_time",
        /// Duration plus weight times the integral of the squared torques.
        TimeAndEffort = "time_and_effort" {
            /// s per (N m)² s; not a number where it is left to a sweep.
            weight: f64 = required_elsewhere(f64::NAN).at_least(0.0),
        },
        /// The motors' energy in a given time.
        Energy = "energy" {
            /// How energy is counted; `bill` without it.
            measure: EnergyMeasure = or(EnergyMeasure::default()),
            /// The time; not a number where it is left to a sweep.
            duration_s: f64 = required_elsewhere(f64::NAN).above(0.0),
        },
        /// The duration with no more than a given bill. By the measure `bill` over all motions; by
        /// `proxy` over the motions that minimise the proxy in their time, as the energy thesis has it.
        MinimumTimeAtEnergy = "minimum_time_at_energy" {
            /// What the motions minimise; `bill` without it.
            measure: EnergyMeasure = or(EnergyMeasure::default()),
            /// The bill; not a number where it is left to a sweep.
            energy_j: f64 = required_elsewhere(f64::NAN).above(0.0),
        },
    }
}

#[expect(
    clippy::derivable_impls,
    reason = "a declaration has no attributes on variants"
)]
impl Default for Objective {
    fn default() -> Self {
        Self::MinimumTime
    }
}

input_choice! {
    /// How energy is counted.
    pub enum EnergyMeasure as "Measure" {
        /// The energy drawn from the supply: braking returns nothing.
        Bill = "bill",
        /// The integral of the power, which is smooth but counts what a braking wheel returns.
        Proxy = "proxy",
    }
}

input_union! {
    /// Which torques can be commanded.
    #[derive(Copy)]
    pub enum TorqueCommand as "SlewCommand" {
        /// Constant on intervals of any length; more of them where momentum turns under a rate limit.
        Free = "free" {
            /// Their number.
            intervals: usize = or(DEFAULT_INTERVALS).at_least(2.0).format("int32"),
        },
        /// Constant on intervals of equal length.
        Uniform = "uniform" {
            /// Their number.
            intervals: usize = or(DEFAULT_INTERVALS).at_least(2.0).format("int32"),
        },
        /// Continuous, linear on intervals of equal length.
        Smooth = "smooth" {
            /// Their number.
            intervals: usize = or(DEFAULT_INTERVALS).at_least(2.0).format("int32"),
        },
        /// Held on the samples of a clock; the duration is a multiple of the period.
        Sampled = "sampled" {
            /// How torque is held; `constant` without it.
            hold: SampleHold = or(SampleHold::default()),
            /// The period.
            period_s: f64 = required().above(0.0),
        },
    }
}

impl Default for TorqueCommand {
    fn default() -> Self {
        Self::Free {
            intervals: DEFAULT_INTERVALS,
        }
    }
}

input_choice! {
    /// Torque as a function of time between two samples.
    pub enum SampleHold as "Hold" {
        /// Constant.
        Constant = "constant",
        /// Linear, and continuous across samples.
        Linear = "linear",
    }
}

input_choice! {
    /// Condition on the wheels at the end.
    pub enum FinalWheels as "FinalWheels" {
        /// None besides conservation of momentum at the final attitude and rate.
        Free = "free",
        /// The speeds of the end's state.
        Given = "given",
        /// The null-space momentum of the start.
        NullSpaceOfStart = "null_space_of_start",
    }
}

input_choice! {
    /// How torque on the body is allocated to the wheels.
    pub enum WheelAllocation as "SlewAllocation" {
        /// Every wheel's torque is chosen by itself, within its limits.
        Free = "free",
        /// By the pseudo-inverse of the wheel axes, as in most flight software: `u = A^+ A u`.
        /// Null-space momentum stays that of the start, and less than the full envelope can be reached;
        /// not with `given` final wheels.
        PseudoInverse = "pseudo_inverse",
    }
}

/// Values of one quantity of the objective, in the order in which they are solved.
#[derive(Debug, Clone, PartialEq)]
pub enum Sweep {
    /// Durations, s, of [`Objective::Energy`].
    Durations(Vec<f64>),
    /// Weights of [`Objective::TimeAndEffort`].
    Weights(Vec<f64>),
    /// Energies, J, of [`Objective::MinimumTimeAtEnergy`].
    Energies(Vec<f64>),
}

impl Sweep {
    /// The members of a document of which one is the list.
    const NAMES: [&'static str; 3] = ["durations_s", "weights", "energies_j"];

    /// Name of the member that is the list.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Durations(_) => Self::NAMES[0],
            Self::Weights(_) => Self::NAMES[1],
            Self::Energies(_) => Self::NAMES[2],
        }
    }

    /// The values in their order.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        let (Self::Durations(values) | Self::Weights(values) | Self::Energies(values)) = self;
        values
    }
}

/// Exactly one list, of at most [`MAX_POINTS`] values.
impl InputForm for Sweep {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        if !place.is_object(Some(&Self::NAMES)) {
            return None;
        }
        let list = |name| {
            let given = place.member(name).filter(|list| !list.is_null())?;
            Some(Vec::<f64>::read(&given))
        };
        let lists = Self::NAMES.map(list);
        let given = lists.iter().flatten().count();
        if given != 1 {
            place.report(
                Code::ConflictingFields,
                format!("{given} lists are given"),
                "give exactly one of durations_s, weights and energies_j",
            );
            return None;
        }
        let [durations, weights, energies] = lists.map(Option::flatten);
        let sweep = durations
            .map(Self::Durations)
            .or_else(|| weights.map(Self::Weights))
            .or_else(|| energies.map(Self::Energies))?;
        let count = sweep.values().len();
        if !(1..=MAX_POINTS).contains(&count) {
            place.report(
                Code::WrongLength,
                format!("the sweep has {count} values"),
                format!("give 1 to {MAX_POINTS} values"),
            );
            return None;
        }
        Some(sweep)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "Sweep",
            doc: "Exactly one list.",
            schema: || {
                let rule = optional().min_length(1).max_length(MAX_POINTS);
                let [durations, weights, energies] = Self::NAMES;
                let list = |name, doc| MemberSchema::of::<Option<Vec<f64>>>(name, doc, &rule);
                Schema::Object(vec![
                    list(durations, "Of the objective `energy`."),
                    list(weights, "Of the objective `time_and_effort`."),
                    list(energies, "Of the objective `minimum_time_at_energy`."),
                ])
            },
        })
    }
}
