//! The documents that describe a study.

mod comparison;
mod flight;

pub(in crate::api) use comparison::ComparisonBody;
pub(in crate::api) use flight::FlightBody;

use super::inputs::{PairBody, Scenario, SpacecraftOrReference, Vector};
use super::slews::Drive;
use serde::Serialize;
use utoipa::ToSchema;

/// How much of the wheels a plan should leave to feedback.
#[derive(Serialize, ToSchema)]
#[schema(as = AuthorityStudy)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct AuthorityBody {
    scenario: Scenario,
    /// How the plans are flown.
    #[schema(required = false)]
    simulation: Option<Simulation>,
    /// The pairs of shares to compare.
    #[schema(min_items = 1, max_items = 200)]
    authorities: Vec<Authorities>,
}

#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Authorities {
    #[schema(exclusive_minimum = 0, maximum = 1)]
    torque_authority: f64,
    #[schema(exclusive_minimum = 0, maximum = 1)]
    momentum_authority: f64,
}

/// What the wheels of a spacecraft can do together.
#[derive(Serialize, ToSchema)]
#[schema(as = EnvelopeStudy)]
#[serde(deny_unknown_fields)]
pub(in crate::api) struct EnvelopeBody {
    /// Free text.
    #[schema(required = false)]
    name: Option<String>,
    spacecraft: SpacecraftOrReference,
    /// From rest to rest, the shorter way round.
    #[schema(required = false, max_items = 100)]
    turns: Option<Vec<PairBody>>,
    /// Torques that the wheels are to take up together, body axes; the body gets the opposite.
    #[schema(required = false, max_items = 1000)]
    demands_nm: Option<Vec<Vector>>,
    /// Whether the turns are wanted in minimum time too.
    #[schema(required = false, default = false)]
    time_optimal: Option<bool>,
    #[schema(required = false)]
    options: Option<EnvelopeOptions>,
}

#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct EnvelopeOptions {
    /// Share of every torque limit that may be used.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    torque_authority: Option<f64>,
    /// Share of every wheel speed limit that may be used.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1, default = 1.0)]
    momentum_authority: Option<f64>,
}

/// A flight in closed loop, many times over.
#[derive(Serialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Simulation {
    /// Quaternion feedback of 0.1 rad/s without it.
    #[schema(required = false)]
    controller: Option<Controller>,
    /// How the plan's torques reach the wheels: `averaged` over each sample (the default), or
    /// `time_tagged`, switching at their times.
    #[schema(required = false)]
    feed_forward: Option<FeedForward>,
    /// Samples of the on-board computer per second.
    #[schema(required = false, exclusive_minimum = 0, default = 10.0)]
    on_board_rate_hz: Option<f64>,
    /// Cycles of the loop at the wheels per second.
    #[schema(required = false, exclusive_minimum = 0, default = 100.0)]
    wheel_loop_rate_hz: Option<f64>,
    /// Samples after which feedback is applied.
    #[schema(required = false, minimum = 0, default = 0)]
    delay_samples: Option<u32>,
    /// Time under control after the end of the plan.
    #[schema(required = false, minimum = 0, default = 0.0)]
    settle_s: Option<f64>,
    /// Longest step of the integration.
    #[schema(required = false, exclusive_minimum = 0, default = 0.01)]
    max_step_s: Option<f64>,
    /// What the drives are believed to be, one for each wheel.
    #[schema(required = false)]
    drives: Option<Vec<Drive>>,
    #[schema(required = false)]
    errors: Option<Errors>,
    #[schema(required = false, default = 0, format = "uint64")]
    seed: Option<u64>,
    /// Number of flights.
    #[schema(required = false, minimum = 1, default = 1000)]
    runs: Option<u32>,
    /// Attitude error up to which a flight counts as a success.
    #[schema(required = false, exclusive_minimum = 0, default = 0.1)]
    tolerance_deg: Option<f64>,
}

#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
#[expect(dead_code, reason = "only describes the input")]
enum FeedForward {
    Averaged,
    TimeTagged,
}

/// A control law.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum Controller {
    /// The plan's torques and nothing else.
    FeedForward,
    /// With quaternion and rate feedback.
    Quaternion {
        gains: Gains,
        #[schema(required = false, default = false)]
        gyroscopic: Option<bool>,
    },
    /// The final attitude commanded at once, without the plan's torques.
    StepInput {
        gains: Gains,
        #[schema(required = false, default = false)]
        gyroscopic: Option<bool>,
    },
    /// With the geometric PID on rotations.
    GeometricPid {
        gains: PidGains,
        /// Whether the integral leaves out what would ask more of a wheel that is at a limit.
        #[schema(required = false, default = true)]
        anti_windup: Option<bool>,
    },
}

/// Gains of quaternion feedback `-k J q_e - c J w_e`.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum Gains {
    /// Natural frequency and damping of small errors.
    Bandwidth {
        #[schema(exclusive_minimum = 0)]
        bandwidth_rad_s: f64,
        #[schema(required = false, exclusive_minimum = 0, default = 0.7)]
        damping: Option<f64>,
    },
    /// Settling time and damping.
    SettlingTime {
        #[schema(exclusive_minimum = 0)]
        settling_time_s: f64,
        #[schema(required = false, exclusive_minimum = 0, default = 0.7)]
        damping: Option<f64>,
    },
    /// `k` and `c`.
    Given {
        attitude_per_s2: f64,
        rate_per_s: f64,
    },
}

/// Gains of the geometric PID.
#[derive(Serialize, ToSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[expect(dead_code, reason = "only describes the input")]
enum PidGains {
    /// A pair of poles and a real one, of small errors.
    Bandwidth {
        #[schema(exclusive_minimum = 0)]
        bandwidth_rad_s: f64,
        #[schema(required = false, exclusive_minimum = 0, default = 0.7)]
        damping: Option<f64>,
        #[schema(required = false, minimum = 0, default = 0.0)]
        integral_rad_s: Option<f64>,
    },
    /// As they are.
    Given {
        attitude_nm: f64,
        rate_nms: f64,
        integral_nm: f64,
        attitude_weight_per_s: f64,
    },
}

/// How the truth differs from what is believed; none without it.
#[derive(Serialize, ToSchema)]
#[schema(as = SimulationErrors)]
#[serde(deny_unknown_fields)]
struct Errors {
    /// Three standard deviations of the inertia, as a share of it.
    #[schema(required = false, minimum = 0)]
    inertia_3_sigma: Option<f64>,
    /// Three standard deviations of the tilt of a wheel's axis.
    #[schema(required = false, minimum = 0)]
    alignment_3_sigma_rad: Option<f64>,
    /// Three standard deviations of friction, as a share of it.
    #[schema(required = false, minimum = 0)]
    friction_3_sigma: Option<f64>,
    /// Three standard deviations of the initial attitude about each axis.
    #[schema(required = false, minimum = 0)]
    initial_attitude_3_sigma_rad: Option<f64>,
    /// Standard deviation of a measured attitude, new at every sample.
    #[schema(required = false, minimum = 0)]
    attitude_noise_rad: Option<f64>,
    /// Standard deviation of a measured body rate, new at every sample.
    #[schema(required = false, minimum = 0)]
    rate_noise_rad_s: Option<f64>,
    /// Constant external torque in body axes.
    #[schema(required = false)]
    disturbance_torque_nm: Option<Vector>,
}
