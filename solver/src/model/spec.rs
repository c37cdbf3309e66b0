//! Descriptions as a caller writes them: plain, unvalidated, with units in the field names.
//!
//! Every value may be invalid. [`crate::model::scenario::Scenario::try_new`] turns a
//! [`ScenarioSpec`] into a scenario that is valid by construction, or lists all that is wrong.
//! Optional fields are `None` when the caller left them out or wrote `null`. Each declaration is also
//! that of the JSON document and of its description, see [`crate::model::input`].

mod attitude;
mod cones;
mod labels;
mod pointing;
mod spacecraft;
mod window;

pub use attitude::{AttitudeSpec, BoresightChoice, PairSpec};
pub use cones::{Applies, CelestialBody, ConeSpec, DirectionSpec};
pub use labels::{ReferenceFrame, TimeSystem};
pub use pointing::{OrientationSpec, PointingSpec};
pub use spacecraft::{BoresightSpec, SpacecraftOrReference, SpacecraftSpec, WheelSpec};
pub use window::WindowSpec;

use super::epoch;
use super::input::{
    self, InputForm, InputPlace, MemberRule, Schema, UpTo, input_choice, input_object, nullable,
    optional, or, required_or,
};

/// Limit of the targets of a scenario, far above what can be planned: legs between that many exceed
/// any disk.
pub const MAX_TARGETS: usize = 10_000;
/// Limit of the cones of a scenario, keep-out and keep-in together.
pub const MAX_CONES: usize = 1000;
/// Limit of the windows of a target: passes of a satellite over a year.
pub const MAX_WINDOWS: usize = 10_000;
/// Limit of times of a schedule, s, before and after time zero: some thirty years.
pub const MAX_TIME_S: f64 = 1e9;
/// Limit of the value of a target.
pub const MAX_VALUE: f64 = 1e12;

input_object! {
    /// A planning problem. Numbers are SI with the unit in the field name; unknown fields are refused.
    #[derive(Default)]
    pub struct ScenarioSpec as "Scenario" {
        /// Free text that names the scenario.
        pub name: Option<String> = optional(),
        /// Epoch of time zero in the time system, such as `2026-01-31T12:00:00.5Z`; labels exports, and
        /// says where the Sun is.
        pub epoch: Option<String> = optional().pattern(epoch::PATTERN),
        /// Time system of the epoch, UTC without it.
        pub time_system: Option<TimeSystem> = optional(),
        /// Reference frame of all attitudes and directions, EME2000 without it.
        pub reference_frame: Option<ReferenceFrame> = optional(),
        /// The spacecraft.
        pub spacecraft: SpacecraftSpec as SpacecraftOrReference
            = required_or(SpacecraftSpec::substitute()),
        /// State at time zero.
        pub start: StateSpec = required_or(StateSpec::default()),
        /// State at the end of the tour; finish at the last target without it.
        pub end: Option<StateSpec> = optional(),
        /// Visited once each, in an order that keeps their `position` and `after`; their sequence here does
        /// not matter.
        pub targets: Vec<TargetSpec> as UpTo<MAX_TARGETS, TargetSpec> = required_or(Vec::new()),
        /// The schedule ends by then, s from time zero, with the end's attitude reached; any time without
        /// it.
        pub latest_end_s: Option<f64> = optional().above(0.0).at_most(MAX_TIME_S),
        /// Cones in which a boresight must not point.
        pub keep_out: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// Cones in which a boresight must point, as a solar panel's normal around the Sun.
        pub keep_in: Vec<ConeSpec> as UpTo<MAX_CONES, ConeSpec> = or(Vec::new()),
        /// Options of the solve.
        pub options: OptionsSpec = or(OptionsSpec::default()),
    }
}

input_object! {
    /// An attitude with rates and wheel speeds. Exactly one of `attitude` and `pointing` is given.
    #[derive(Default)]
    pub struct StateSpec as "BoundaryState" {
        /// The attitude; not read where `pointing` is given.
        pub attitude: AttitudeSpec = required_or(AttitudeSpec::default()).unless("pointing"),
        /// Instead of the attitude where a boresight points. At an end the roll about it is left to the
        /// plan. What is known at a start is its attitude: only a single slew without stored momentum
        /// chooses the roll there too.
        pub pointing: Option<PointingSpec> = optional(),
        /// Body rate in body axes; zero without it.
        pub body_rate_rad_s: Option<[f64; 3]> = optional(),
        /// Wheel speeds relative to the body, one per wheel; zero at the start and free at the end
        /// without it.
        pub wheel_speed_rad_s: Option<Vec<f64>> = optional(),
    }
}

input_object! {
    /// An attitude, or a direction, to visit: exactly one of `attitude` and `pointing` says which.
    #[derive(Default)]
    pub struct TargetSpec as "Target" {
        /// Name of the target, unique in the scenario.
        pub id: String = MemberRule::required_or_pointer().min_length(1),
        /// The attitude to pass through; not read where `pointing` is given.
        pub attitude: AttitudeSpec = required_or(AttitudeSpec::default()).unless("pointing"),
        /// Instead of the attitude where a boresight points: the roll about it is left to the plan.
        pub pointing: Option<PointingSpec> = optional(),
        /// Which rate components must vanish there; all without it.
        pub zero_rate_axes: Option<[bool; 3]> as Option<RateAxes> = optional(),
        /// Lower bounds of the rate components there instead; `null` is none.
        pub rate_min_rad_s: Option<[Option<f64>; 3]> = optional(),
        /// Upper bounds of the rate components there; `null` is none.
        pub rate_max_rad_s: Option<[Option<f64>; 3]> = optional(),
        /// Time to stay at rest after settling.
        pub dwell_s: f64 = or(0.0).at_least(0.0),
        /// Time to settle at rest after arrival.
        pub settle_s: f64 = or(0.0).at_least(0.0),
        /// Place in the order of visits, counted from 1 among the targets that are visited; any without
        /// it. No two targets have the same.
        pub position: Option<usize> = optional().at_least(1.0),
        /// Identifiers of targets that must have been visited before, those aside that a plan leaves out.
        /// Some order has to keep all positions and precedences.
        pub after: Vec<String> = or(Vec::new()),
        /// When it may be visited: from arrival to departure a visit lies inside one of these. Any time
        /// without the list, never with an empty one.
        pub windows: Option<Vec<WindowSpec>> as Option<UpTo<MAX_WINDOWS, WindowSpec>> = optional(),
        /// What a visit is worth. A target with a value may be left out, one without is visited in every
        /// plan. The greatest sum of values comes first, the least total time second.
        pub value: Option<f64> = optional().above(0.0).at_most(MAX_VALUE),
    }
}

input_object! {
    /// Options of a solve.
    pub struct OptionsSpec as "Options" {
        /// Accuracy of the durations.
        pub accuracy: Accuracy = or(Accuracy::default()),
        /// Whether q and -q are the same attitude.
        pub attitude_equivalence: AttitudeEquivalence = or(AttitudeEquivalence::default()),
        /// Wall-clock limit; 60 without it, none with `null`.
        pub time_limit_s: Option<f64> = nullable(60.0).above(0.0).at_most(1e9),
        /// Limit on explored search nodes.
        pub node_limit: Option<u64> = optional().at_least(1.0),
        /// Gap at which the search may stop.
        pub relative_gap: f64 = or(0.0).at_least(0.0).below(1.0),
        /// Number of further orders to prove and list.
        pub alternatives: usize = or(1).at_most(100.0).format("int32"),
        /// Share of every torque limit that the plan may use.
        pub torque_authority: f64 = or(1.0).above(0.0).at_most(1.0),
        /// Share of every wheel speed limit that the plan may use.
        pub momentum_authority: f64 = or(1.0).above(0.0).at_most(1.0),
        /// Seed of everything random.
        pub seed: u64 = or(0),
    }
}

impl Default for OptionsSpec {
    fn default() -> Self {
        input::left_out::<Self>()
    }
}

input_choice! {
    /// Whether q and -q are the same attitude.
    pub enum AttitudeEquivalence as "Equivalence" {
        /// Attitudes are rotations: q and -q are the same.
        Rotation = "rotation",
        /// The continuous quaternion trajectory passes through each quaternion with its sign as given.
        Quaternion = "quaternion",
    }
}

input_choice! {
    /// Distance of durations from the minimum over all torque histories.
    pub enum Accuracy as "Accuracy" {
        /// Within 0.05 % of the converged minimum.
        Standard = "standard",
        /// Twice the intervals, no penalty on their lengths: durations agree to 1e-6 relative between
        /// different units and axes of the same problem. Several times slower.
        Tight = "tight",
    }
}

input_choice! {
    /// A component of the body rate.
    enum RateAxis as "Axis" {
        /// About body X.
        X = "x",
        /// About body Y.
        Y = "y",
        /// About body Z.
        Z = "z",
    }
}

/// A list of rate components, as whether each of x, y, z is in it.
#[derive(Debug)]
pub struct RateAxes;

impl InputForm for RateAxes {
    type Value = [bool; 3];

    fn read<P: InputPlace>(place: &P) -> Option<[bool; 3]> {
        let entries = 0..place.entries()?;
        let named: Vec<_> = entries
            .map(|index| RateAxis::read(&place.entry(index)?))
            .collect();
        Some([RateAxis::X, RateAxis::Y, RateAxis::Z].map(|axis| named.contains(&Some(axis))))
    }

    fn schema() -> Schema {
        Vec::<RateAxis>::schema()
    }
}
