//! The documents that callers write.

use serde::Serialize;
use utoipa::openapi::schema::ArrayBuilder;
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

/// A planning problem. Numbers are SI with the unit in the field name; unknown fields are refused.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct Scenario {
    /// Free text that names the scenario.
    #[schema(required = false)]
    name: Option<String>,
    /// Epoch of time zero, ISO 8601; only labels exports.
    #[schema(required = false)]
    epoch: Option<String>,
    /// Time system of the epoch; only labels exports.
    #[schema(required = false)]
    time_system: Option<String>,
    /// Name of the reference frame; only labels exports.
    #[schema(required = false)]
    reference_frame: Option<String>,
    spacecraft: SpacecraftOrReference,
    start: State,
    /// Finish at the last target without it.
    #[schema(required = false)]
    end: Option<State>,
    /// Visited each once, in any order that keeps their `position` and `after`.
    targets: Vec<Target>,
    #[schema(required = false, max_items = 1000)]
    keep_out: Option<Vec<KeepOut>>,
    #[schema(required = false)]
    options: Option<Options>,
}

/// A spacecraft, or the name of a stored one.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only describes the input")]
pub(in crate::api) enum SpacecraftOrReference {
    /// Written out.
    Spacecraft(Spacecraft),
    /// Stored before.
    Reference(SpacecraftReference),
}

/// A stored spacecraft.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct SpacecraftReference {
    /// Its name.
    r#ref: String,
    /// Its version; the newest without it.
    #[schema(required = false, minimum = 1)]
    version: Option<u32>,
}

/// A rigid body with reaction wheels.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct Spacecraft {
    /// Inertia of the whole spacecraft with its wheels locked, body axes.
    inertia_kg_m2: Matrix,
    /// Limit of each body rate component; `null` is none.
    #[schema(required = false, min_items = 3, max_items = 3)]
    max_body_rate_rad_s: Option<Vec<Option<f64>>>,
    /// Limit of the norm of the body rate.
    #[schema(required = false, exclusive_minimum = 0)]
    max_body_rate_norm_rad_s: Option<f64>,
    /// At least three enabled ones that span space.
    #[schema(min_items = 3, max_items = 100)]
    wheels: Vec<Wheel>,
    #[schema(required = false, max_items = 100)]
    boresights: Option<Vec<Boresight>>,
}

/// A reaction wheel.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Wheel {
    /// Spin axis in body axes.
    axis: Vector,
    /// Whether the axis is scaled to unit length; else it enters as given, 0.001 to 1000 long.
    #[schema(required = false, default = true)]
    normalize_axis: Option<bool>,
    /// Inertia about the spin axis.
    #[schema(exclusive_minimum = 0)]
    inertia_kg_m2: f64,
    /// Largest motor torque on the wheel.
    #[schema(exclusive_minimum = 0)]
    max_torque_nm: f64,
    /// Smallest motor torque on the wheel; minus the largest without it.
    #[schema(required = false, exclusive_maximum = 0)]
    min_torque_nm: Option<f64>,
    /// Limit of the speed relative to the body; none without it.
    #[schema(required = false, exclusive_minimum = 0)]
    max_speed_rad_s: Option<f64>,
    /// A disabled wheel is locked at its start speed.
    #[schema(required = false, default = true)]
    enabled: Option<bool>,
}

/// A named body-fixed direction.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Boresight {
    name: String,
    /// Direction in body axes, any length.
    axis: Vector,
}

/// An attitude with rates and wheel speeds.
#[derive(Serialize, ToSchema)]
#[schema(as = BoundaryState)]
#[serde(deny_unknown_fields)]
pub(super) struct State {
    attitude: Attitude,
    /// Body rate in body axes; zero without it.
    #[schema(required = false)]
    body_rate_rad_s: Option<Vector>,
    /// Wheel speeds relative to the body, one per wheel; zero at the start and free at the end
    /// without it.
    #[schema(required = false)]
    wheel_speed_rad_s: Option<Vec<f64>>,
}

/// An attitude to visit.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Target {
    /// Unique in the scenario.
    #[schema(min_length = 1)]
    id: String,
    attitude: Attitude,
    /// Which rate components must vanish there; all without it.
    #[schema(required = false)]
    zero_rate_axes: Option<Vec<Axis>>,
    /// Lower bounds of the rate components there instead; `null` is none.
    #[schema(required = false, min_items = 3, max_items = 3)]
    rate_min_rad_s: Option<Vec<Option<f64>>>,
    /// Upper bounds of the rate components there; `null` is none.
    #[schema(required = false, min_items = 3, max_items = 3)]
    rate_max_rad_s: Option<Vec<Option<f64>>>,
    /// Time to stay at rest after settling.
    #[schema(required = false, minimum = 0, default = 0.0)]
    dwell_s: Option<f64>,
    /// Time to settle at rest after arrival.
    #[schema(required = false, minimum = 0, default = 0.0)]
    settle_s: Option<f64>,
    /// Place in the order of visits, counted from 1; any without it. No two targets have the same.
    #[schema(required = false, minimum = 1)]
    position: Option<u64>,
    /// Identifiers of targets that must have been visited before. Some order has to keep all
    /// positions and precedences.
    #[schema(required = false)]
    after: Option<Vec<String>>,
}

/// A component of the body rate.
#[derive(Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
#[expect(dead_code, reason = "only describes the input")]
enum Axis {
    X,
    Y,
    Z,
}

/// One of the forms of an attitude; body axes to the reference frame.
#[derive(Serialize, ToSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only describes the input")]
enum Attitude {
    Quaternion(QuaternionForm),
    RollPitchYaw(RollPitchYawForm),
    Mrp(MrpForm),
    Matrix(MatrixForm),
    RaDecRoll(RaDecRollForm),
}

#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct QuaternionForm {
    quaternion: Quaternion,
}

/// A quaternion with scalar part `w`, of unit norm within 1e-3.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

/// Roll, pitch and yaw of the z-y-x sequence, degrees.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct RollPitchYawForm {
    roll_pitch_yaw_deg: Vector,
}

/// Modified Rodrigues parameters.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct MrpForm {
    mrp: Vector,
}

/// Rotation matrix whose columns are the body axes in the reference frame.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct MatrixForm {
    matrix: Matrix,
}

/// Right ascension, declination and roll of a body axis, degrees.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct RaDecRollForm {
    ra_dec_roll_deg: Vector,
    boresight: Vector,
}

/// A cone that a boresight should avoid.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct KeepOut {
    /// Name of the boresight.
    boresight: String,
    /// Axis of the cone in the reference frame, any length.
    direction: Vector,
    #[schema(exclusive_minimum = 0, exclusive_maximum = 180)]
    half_angle_deg: f64,
}

/// Options of a solve.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Options {
    /// How closely durations come to the minimum.
    #[schema(required = false)]
    accuracy: Option<Accuracy>,
    /// Whether q and -q are the same place to be.
    #[schema(required = false)]
    attitude_equivalence: Option<Equivalence>,
    /// Wall-clock limit; 60 without it, none with `null`.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1e9)]
    time_limit_s: Option<f64>,
    /// Limit on explored search nodes.
    #[schema(required = false, minimum = 1, format = "uint64")]
    node_limit: Option<u64>,
    /// Gap at which the search may stop.
    #[schema(required = false, minimum = 0, exclusive_maximum = 1, default = 0.0)]
    relative_gap: Option<f64>,
    /// How many further orders to prove and list.
    #[schema(required = false, maximum = 100, default = 1)]
    alternatives: Option<u8>,
    /// Share of every torque limit that the plan may use.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    torque_authority: Option<f64>,
    /// Share of every wheel speed limit that the plan may use.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    momentum_authority: Option<f64>,
    /// Seed of everything random.
    #[schema(required = false, default = 0, format = "uint64")]
    seed: Option<u64>,
}

/// `standard`: durations within 0.05 % of the converged minimum. `tight`: twice the intervals and
/// no bias on their lengths; durations repeat to 1e-6 relative whatever the units and axes in which
/// the problem is stated, at several times the work.
#[derive(Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
#[expect(dead_code, reason = "only describes the input")]
enum Accuracy {
    Standard,
    Tight,
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "lowercase")]
#[expect(dead_code, reason = "only describes the input")]
pub(super) enum Equivalence {
    Rotation,
    Quaternion,
}

/// Three numbers.
#[derive(Serialize)]
pub(super) struct Vector([f64; 3]);

impl PartialSchema for Vector {
    fn schema() -> RefOr<Schema> {
        triple(f64::schema())
    }
}

impl ToSchema for Vector {}

/// Three rows of three numbers.
#[derive(Serialize)]
struct Matrix([Vector; 3]);

impl PartialSchema for Matrix {
    fn schema() -> RefOr<Schema> {
        triple(Vector::schema())
    }
}

impl ToSchema for Matrix {}

fn triple(item: RefOr<Schema>) -> RefOr<Schema> {
    ArrayBuilder::new()
        .items(item)
        .min_items(Some(3))
        .max_items(Some(3))
        .into()
}

/// A query for leg times: of `attitudes` and `pairs` exactly one.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct LegQueryBody {
    spacecraft: SpacecraftOrReference,
    /// The legs between all of these, both directions.
    #[schema(required = false, min_items = 2)]
    attitudes: Option<Vec<Attitude>>,
    /// The legs of these pairs.
    #[schema(required = false, min_items = 1)]
    pairs: Option<Vec<PairBody>>,
    /// The conditions at the two ends; `rest_to_rest` without it. `certified` asks for proved bounds
    /// of the rest-to-rest times only: they are computed, in `compute`, without solving any slew, and
    /// not stored.
    #[schema(required = false)]
    kind: Option<Kind>,
    /// Whether unknown legs are solved; `cached_only` without it.
    #[schema(required = false)]
    mode: Option<Mode>,
    /// The state whose momentum is conserved; at rest without it.
    #[schema(required = false)]
    start: Option<State>,
    /// For `lower_bound`: which rate components vanish at both ends; all without it.
    #[schema(required = false)]
    zero_rate_axes: Option<Vec<Axis>>,
    /// Options of a scenario; those about the search do not matter.
    #[schema(required = false)]
    options: Option<Options>,
}

#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct PairBody {
    from: Attitude,
    to: Attitude,
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
pub(super) enum Kind {
    RestToRest,
    LowerBound,
    Certified,
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum Mode {
    CachedOnly,
    Compute,
}

/// A plan made by anyone, with the scenario that it is for.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct VerifyBody {
    scenario: Scenario,
    plan: ForeignPlan,
}

/// What is read of a plan; anything else in it is not looked at.
#[derive(Serialize, ToSchema)]
pub(super) struct ForeignPlan {
    total_time_s: f64,
    /// Identifiers in visiting order.
    sequence: Vec<String>,
    /// One for every target, in the same order.
    passages: Vec<ForeignPassage>,
    trajectory: ForeignTrajectory,
}

#[derive(Serialize, ToSchema)]
struct ForeignPassage {
    target: String,
    time_s: f64,
    /// The arrival without it.
    #[schema(required = false)]
    departure_s: Option<f64>,
}

#[derive(Serialize, ToSchema)]
struct ForeignTrajectory {
    controls: Vec<ForeignControl>,
}

#[derive(Serialize, ToSchema)]
struct ForeignControl {
    start_s: f64,
    duration_s: f64,
    /// One per wheel.
    wheel_torque_nm: Vec<f64>,
}
