//! Descriptions as a caller writes them: plain, unvalidated, with units in the field names.
//!
//! Every value may be invalid. [`crate::model::scenario::Scenario::try_new`] turns a
//! [`ScenarioSpec`] into a scenario that is valid by construction, or lists all that is wrong.
//! Optional fields are `None` when the caller left them out or wrote `null`.

/// A whole planning problem as written by the caller.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ScenarioSpec {
    /// Free text that names the scenario.
    pub name: Option<String>,
    /// Epoch of time zero, ISO 8601; only labels exports.
    pub epoch: Option<String>,
    /// Time system of the epoch (`UTC`, `TAI`, ...); only labels exports.
    pub time_system: Option<String>,
    /// Name of the reference frame; only labels exports.
    pub reference_frame: Option<String>,
    /// The spacecraft.
    pub spacecraft: SpacecraftSpec,
    /// State at time zero.
    pub start: StateSpec,
    /// State at the end of the tour; `None` finishes at the last target.
    pub end: Option<StateSpec>,
    /// The targets; their sequence here does not matter.
    pub targets: Vec<TargetSpec>,
    /// Cones in which a boresight must not point.
    pub keep_out: Vec<KeepOutSpec>,
    /// Options of the solve.
    pub options: OptionsSpec,
}

/// A rigid body with reaction wheels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpacecraftSpec {
    /// Inertia of the whole spacecraft with its wheels locked, body axes, kg m².
    pub inertia_kg_m2: [[f64; 3]; 3],
    /// Limit of each body rate component, rad/s.
    pub max_body_rate_rad_s: [Option<f64>; 3],
    /// Limit of the norm of the body rate, rad/s.
    pub max_body_rate_norm_rad_s: Option<f64>,
    /// The wheels; every per-wheel array has this order.
    pub wheels: Vec<WheelSpec>,
    /// Named instrument axes.
    pub boresights: Vec<BoresightSpec>,
}

/// One reaction wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelSpec {
    /// Spin axis in body axes.
    pub axis: [f64; 3],
    /// Whether `axis` is scaled to unit length (the default) or enters as given, between 0.001 and
    /// 1000 long.
    pub normalize_axis: bool,
    /// Inertia about the spin axis, kg m².
    pub inertia_kg_m2: f64,
    /// Largest motor torque on the wheel, N m.
    pub max_torque_nm: f64,
    /// Smallest motor torque on the wheel, N m; minus the largest when absent.
    pub min_torque_nm: Option<f64>,
    /// Limit of the speed relative to the body, rad/s; `None` is unlimited.
    pub max_speed_rad_s: Option<f64>,
    /// Whether the wheel may be commanded; a disabled wheel is locked at its start speed.
    pub enabled: bool,
}

/// A named body-fixed direction.
#[derive(Debug, Clone, PartialEq)]
pub struct BoresightSpec {
    /// Name by which keep-out cones refer to it.
    pub name: String,
    /// Direction in body axes, any length.
    pub axis: [f64; 3],
}

/// One of the input forms of an attitude.
#[derive(Debug, Clone, PartialEq)]
pub enum AttitudeSpec {
    /// Scalar-last components `[x, y, z, w]`, rotating body vectors into the reference frame.
    Quaternion([f64; 4]),
    /// Roll, pitch and yaw of the z-y-x sequence, degrees.
    RollPitchYawDeg([f64; 3]),
    /// Modified Rodrigues parameters.
    Mrp([f64; 3]),
    /// Rows of the rotation matrix whose columns are the body axes in the reference frame.
    Matrix([[f64; 3]; 3]),
    /// Right ascension, declination and roll of a body axis, degrees.
    RaDecRollDeg {
        /// Right ascension, declination and roll, degrees.
        angles: [f64; 3],
        /// The body axis that is pointed.
        boresight: [f64; 3],
    },
}

impl Default for AttitudeSpec {
    fn default() -> Self {
        Self::Quaternion([0.0, 0.0, 0.0, 1.0])
    }
}

/// An attitude with the rates and wheel speeds there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StateSpec {
    /// The attitude.
    pub attitude: AttitudeSpec,
    /// Body rate in body axes, rad/s; zero when absent.
    pub body_rate_rad_s: Option<[f64; 3]>,
    /// Wheel speeds relative to the body, rad/s; zero at the start and free at the end when absent.
    pub wheel_speed_rad_s: Option<Vec<f64>>,
}

/// An attitude to visit once.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TargetSpec {
    /// Name of the target, unique in the scenario.
    pub id: String,
    /// The attitude to pass through.
    pub attitude: AttitudeSpec,
    /// Which of the x, y, z rate components must vanish there; all when absent.
    pub zero_rate_axes: Option<[bool; 3]>,
    /// Lower bounds of the rate components there, rad/s.
    pub rate_min_rad_s: Option<[Option<f64>; 3]>,
    /// Upper bounds of the rate components there, rad/s.
    pub rate_max_rad_s: Option<[Option<f64>; 3]>,
    /// Time to stay at rest after settling, s.
    pub dwell_s: f64,
    /// Time to settle at rest after arrival, s.
    pub settle_s: f64,
    /// Place among the targets in the order of visits, counted from 1; any when absent.
    pub position: Option<usize>,
    /// Identifiers of targets that must have been visited before.
    pub after: Vec<String>,
}

/// A cone around a reference direction that a boresight must avoid.
#[derive(Debug, Clone, PartialEq)]
pub struct KeepOutSpec {
    /// Name of the boresight.
    pub boresight: String,
    /// Direction in the reference frame, any length.
    pub direction: [f64; 3],
    /// Half angle of the cone, degrees.
    pub half_angle_deg: f64,
}

/// Whether q and -q are the same attitude.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum AttitudeEquivalence {
    /// Attitudes are rotations: q and -q are the same.
    #[default]
    Rotation,
    /// The continuous quaternion trajectory passes through each quaternion with its sign as given.
    Quaternion,
}

/// Distance of durations from the minimum over all torque histories.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Accuracy {
    /// Within 0.05 % of the converged minimum.
    #[default]
    Standard,
    /// Twice the intervals, no penalty on their lengths: durations agree to 1e-6 relative between
    /// different units and axes of the same problem. Several times slower.
    Tight,
}

/// Options of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct OptionsSpec {
    /// Accuracy of the durations.
    pub accuracy: Accuracy,
    /// Meaning of equal attitudes.
    pub attitude_equivalence: AttitudeEquivalence,
    /// Wall-clock limit, s.
    pub time_limit_s: Option<f64>,
    /// Limit on explored search nodes.
    pub node_limit: Option<u64>,
    /// Gap at which the search may stop.
    pub relative_gap: f64,
    /// Number of further orders to prove and list.
    pub alternatives: usize,
    /// Share of every torque limit that the plan may use.
    pub torque_authority: f64,
    /// Share of every wheel speed limit that the plan may use.
    pub momentum_authority: f64,
    /// Seed of everything random.
    pub seed: u64,
}

impl Default for OptionsSpec {
    fn default() -> Self {
        Self {
            accuracy: Accuracy::Standard,
            attitude_equivalence: AttitudeEquivalence::Rotation,
            time_limit_s: Some(60.0),
            node_limit: None,
            relative_gap: 0.0,
            alternatives: 1,
            torque_authority: 1.0,
            momentum_authority: 1.0,
            seed: 0,
        }
    }
}
