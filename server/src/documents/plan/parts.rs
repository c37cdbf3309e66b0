//! The parts of a plan document.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::{
    ConeClearance, Control, Intrusion, Leg, Margins, Passage, State, Verification,
};
use utoipa::ToSchema;

/// A unit quaternion, scalar part `w`.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = UnitQuaternion)]
pub(crate) struct QuaternionDocument {
    x: Number,
    y: Number,
    z: Number,
    w: Number,
}

impl From<&Attitude> for QuaternionDocument {
    fn from(attitude: &Attitude) -> Self {
        attitude.xyzw().into()
    }
}

impl From<[f64; 4]> for QuaternionDocument {
    fn from(xyzw: [f64; 4]) -> Self {
        let [x, y, z, w] = xyzw.map(Number);
        Self { x, y, z, w }
    }
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Leg)]
pub(super) struct LegDocument<'a> {
    from: &'a str,
    to: &'a str,
    start_s: Number,
    duration_s: Number,
    /// No slew takes less, s, between these two places under the conditions that the scenario sets
    /// there, proved, as part of whatever tour: rates that the plan chose where they are free are not
    /// used. `null` where nothing is proved: without limits of speed.
    certified_lower_bound_s: Option<Number>,
    /// The slew about the eigenaxis, rest to rest; `null` where that cannot be flown.
    eigenaxis_duration_s: Option<Number>,
    /// The fastest slew from rest to rest between the same attitudes; `null` where it was not solved,
    /// as in plans of searches that were stopped or go on. What `duration_s` saves against it comes
    /// of rates that the conditions leave free.
    rest_to_rest_duration_s: Option<Number>,
    solver_status: &'a str,
}

impl<'a> From<&'a Leg> for LegDocument<'a> {
    fn from(leg: &'a Leg) -> Self {
        Self {
            from: &leg.from,
            to: &leg.to,
            start_s: Number(leg.start_s),
            duration_s: Number(leg.duration_s),
            certified_lower_bound_s: leg.certified_lower_bound_s.map(Number),
            eigenaxis_duration_s: leg.eigenaxis_duration_s.map(Number),
            rest_to_rest_duration_s: leg.rest_to_rest_duration_s.map(Number),
            solver_status: &leg.solver_status,
        }
    }
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PassageAttitude)]
struct AttitudeDocument {
    quaternion: QuaternionDocument,
}

impl From<&Attitude> for AttitudeDocument {
    fn from(attitude: &Attitude) -> Self {
        Self {
            quaternion: attitude.into(),
        }
    }
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Passage)]
pub(super) struct PassageDocument<'a> {
    target: &'a str,
    time_s: Number,
    departure_s: Number,
    attitude: AttitudeDocument,
    /// Where a boresight is pointed: the roll about it, degrees, in the convention of `ra_dec_roll_deg`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    roll_deg: Option<Number>,
    body_rate_rad_s: [Number; 3],
    wheel_speed_rad_s: Vec<Number>,
}

impl<'a> PassageDocument<'a> {
    /// A passage with the state at its arrival, and its roll, degrees.
    pub(super) fn new(passage: &'a Passage, state: &State, roll_deg: Option<f64>) -> Self {
        Self {
            target: &passage.target,
            time_s: Number(passage.time_s),
            departure_s: Number(passage.departure_s),
            attitude: (&state.attitude).into(),
            roll_deg: roll_deg.map(Number),
            body_rate_rad_s: <[f64; 3]>::from(state.body_rate_rad_s).map(Number),
            wheel_speed_rad_s: Number::all(&state.wheel_speed_rad_s),
        }
    }
}

/// The end where a boresight is pointed.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PlanEnd)]
pub(super) struct EndDocument {
    time_s: Number,
    attitude: AttitudeDocument,
    /// Roll about the boresight, degrees, in the convention of `ra_dec_roll_deg`.
    roll_deg: Number,
}

impl EndDocument {
    /// The last state with its roll, degrees.
    pub(super) fn new(state: &State, roll_deg: f64) -> Self {
        Self {
            time_s: Number(state.time_s),
            attitude: (&state.attitude).into(),
            roll_deg: Number(roll_deg),
        }
    }
}

/// Constant motor torques, N m.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Control)]
pub(crate) struct ControlDocument {
    start_s: Number,
    duration_s: Number,
    wheel_torque_nm: Vec<Number>,
}

impl From<&Control> for ControlDocument {
    fn from(control: &Control) -> Self {
        Self::new(
            control.start_s,
            control.duration_s,
            &control.wheel_torque_nm,
        )
    }
}

impl ControlDocument {
    /// Constant torques, N m, from a time on for so long, s.
    pub(crate) fn new(start_s: f64, duration_s: f64, torque_nm: &[f64]) -> Self {
        Self {
            start_s: Number(start_s),
            duration_s: Number(duration_s),
            wheel_torque_nm: Number::all(torque_nm),
        }
    }
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = State)]
pub(crate) struct StateDocument {
    time_s: Number,
    quaternion: QuaternionDocument,
    body_rate_rad_s: [Number; 3],
    wheel_speed_rad_s: Vec<Number>,
}

impl From<&State> for StateDocument {
    fn from(state: &State) -> Self {
        Self {
            time_s: Number(state.time_s),
            quaternion: (&state.attitude).into(),
            body_rate_rad_s: <[f64; 3]>::from(state.body_rate_rad_s).map(Number),
            wheel_speed_rad_s: Number::all(&state.wheel_speed_rad_s),
        }
    }
}

/// What is left of every limit. `null` where there is no limit, and where it could not be computed:
/// then the verification has not passed.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Margins)]
pub(crate) struct MarginsDocument {
    #[schema(required)]
    torque: Option<Number>,
    wheel_speed: Option<Number>,
    body_rate: Option<Number>,
    wheel_zero_crossings: Vec<u32>,
    /// The closest approach to each cone of `keep_out` and `keep_in` that applied at some time.
    keep_out_clearance_deg: Vec<ClearanceDocument>,
    /// Every time span on the wrong side of a cone while it applied; empty where the plan keeps all
    /// cones.
    keep_out_intrusions: Vec<IntrusionDocument>,
}

/// The closest approach of a boresight to the surface of a cone.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ConeClearance)]
pub(crate) struct ClearanceDocument {
    boresight: String,
    /// JSON pointer of the cone in the input, such as `/keep_out/0`.
    cone: String,
    /// Unit vector along the cone's axis in the reference frame: where the Sun was taken to be.
    direction: [Number; 3],
    /// Least angle between boresight and surface while the cone applied (from arrival to departure at
    /// targets, or all along), negative on the wrong side.
    #[schema(required)]
    clearance_deg: Option<Number>,
    time_s: Number,
}

impl From<&ConeClearance> for ClearanceDocument {
    fn from(nearest: &ConeClearance) -> Self {
        Self {
            boresight: nearest.boresight.clone(),
            cone: nearest.cone.clone(),
            direction: <[f64; 3]>::from(nearest.direction).map(Number),
            clearance_deg: Number::computed(nearest.clearance_deg),
            time_s: Number(nearest.time_s),
        }
    }
}

/// A boresight inside a keep-out cone, or outside a keep-in cone.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = KeepOutIntrusion)]
pub(crate) struct IntrusionDocument {
    boresight: String,
    /// JSON pointer of the cone in the input, such as `/keep_out/0`.
    cone: String,
    from_s: Number,
    to_s: Number,
    /// Largest angle to the cone's surface.
    depth_deg: Number,
}

impl From<&Intrusion> for IntrusionDocument {
    fn from(intrusion: &Intrusion) -> Self {
        Self {
            boresight: intrusion.boresight.clone(),
            cone: intrusion.cone.clone(),
            from_s: Number(intrusion.from_s),
            to_s: Number(intrusion.to_s),
            depth_deg: Number(intrusion.depth_rad.to_degrees()),
        }
    }
}

impl From<&Margins> for MarginsDocument {
    fn from(margins: &Margins) -> Self {
        Self {
            torque: Number::computed(margins.torque),
            wheel_speed: margins.wheel_speed.and_then(Number::computed),
            body_rate: margins.body_rate.and_then(Number::computed),
            wheel_zero_crossings: margins.wheel_zero_crossings.clone(),
            keep_out_clearance_deg: margins
                .keep_out_clearance_deg
                .iter()
                .map(ClearanceDocument::from)
                .collect(),
            keep_out_intrusions: margins
                .keep_out_intrusions
                .iter()
                .map(IntrusionDocument::from)
                .collect(),
        }
    }
}

/// The re-integration. Figures that could not be computed are `null`: then `passed` is false, which
/// alone says whether all of them are within the tolerances.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Verification)]
pub(crate) struct VerificationDocument<'a> {
    passed: bool,
    #[schema(required)]
    max_attitude_error_rad: Option<Number>,
    #[schema(required)]
    max_rate_error_rad_s: Option<Number>,
    #[schema(required)]
    max_wheel_speed_excess: Option<Number>,
    #[schema(required)]
    max_torque_excess: Option<Number>,
    #[schema(required)]
    max_rate_excess: Option<Number>,
    integrator: &'a str,
    failures: &'a [String],
}

impl<'a> From<&'a Verification> for VerificationDocument<'a> {
    fn from(found: &'a Verification) -> Self {
        Self {
            passed: found.passed,
            max_attitude_error_rad: Number::computed(found.max_attitude_error_rad),
            max_rate_error_rad_s: Number::computed(found.max_rate_error_rad_s),
            max_wheel_speed_excess: Number::computed(found.max_wheel_speed_excess),
            max_torque_excess: Number::computed(found.max_torque_excess),
            max_rate_excess: Number::computed(found.max_rate_excess),
            integrator: &found.integrator,
            failures: &found.failures,
        }
    }
}
