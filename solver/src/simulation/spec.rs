//! Descriptions of simulated flights as a caller gives them, not yet validated.

use crate::model::drive::DriveSpec;

/// How a plan is to be simulated, and with which errors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SimulationSpec {
    /// The control law.
    pub controller: ControllerSpec,
    /// How the plan's torques reach the wheels; averaged when absent.
    pub feed_forward: Option<FeedForwardMode>,
    /// Samples of the on-board computer per second, 10 when absent. Its commands are held in between.
    pub on_board_rate_hz: Option<f64>,
    /// Cycles of the wheel loop per second, 100 when absent; rounded up to a whole multiple of the
    /// on-board rate.
    pub wheel_loop_rate_hz: Option<f64>,
    /// Samples after which feedback is applied, 0 when absent; 1 is `u_FB(k + 1)` of BIROS
    /// equation 23.
    pub delay_samples: Option<usize>,
    /// Time for which the end of the plan is held under control after it, s; 0 when absent.
    pub settle_s: Option<f64>,
    /// Longest step of the integration, s; 0.01 when absent.
    pub max_step_s: Option<f64>,
    /// Nominal drives, one per wheel, or none for ideal ones. They include speed laws; wheels with a
    /// speed law take no commands.
    pub drives: Vec<DriveSpec>,
    /// Errors of the true spacecraft relative to the nominal one.
    pub errors: ErrorsSpec,
    /// Seed of everything random, 0 when absent.
    pub seed: Option<u64>,
    /// Number of flights of a Monte-Carlo run, 1,000 when absent.
    pub runs: Option<usize>,
    /// Final attitude error up to which a flight counts as a success, degrees; 0.1 when absent.
    pub tolerance_deg: Option<f64>,
}

/// How the torques of a plan, which may switch at any time, become commands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FeedForwardMode {
    /// Each on-board sample commands their mean until the next sample: body rates at samples are those
    /// of the plan, the attitude differs by some microradians after a switch.
    #[default]
    Averaged,
    /// The wheels switch at the plan's times, from a stored table; only feedback is sampled.
    TimeTagged,
}

/// A control law.
#[derive(Debug, Clone, PartialEq)]
pub enum ControllerSpec {
    /// The plan's torques and nothing else.
    FeedForward,
    /// The plan's torques and quaternion feedback (RW/CMG thesis, equations 157 and 158):
    /// `-k J q_e - c J w_e`.
    Quaternion {
        /// `k` and `c`.
        gains: GainsSpec,
        /// Whether the gyroscopic torque `w x H` of body and wheels is compensated, as far as the plan's
        /// torques do not contain it.
        gyroscopic: bool,
    },
    /// The final attitude commanded at once, at rest, without the plan's torques (thesis, equation
    /// 28): what a slew without a plan does, for comparison.
    StepInput {
        /// `k` and `c`.
        gains: GainsSpec,
        /// Whether the gyroscopic torque `w x H` is compensated.
        gyroscopic: bool,
    },
    /// The plan's torques and the geometric PID on rotations (BIROS, equations 18 to 24).
    GeometricPid {
        /// Its gains.
        gains: PidGainsSpec,
        /// Whether the integral stops in directions that demand more of a wheel at a limit. Without it,
        /// as published, the integral winds up.
        anti_windup: bool,
    },
}

impl Default for ControllerSpec {
    /// Quaternion feedback with a bandwidth of 0.1 rad/s, without the gyroscopic term: along a plan it
    /// compensates little, and with the momentum of the nominal inertia.
    fn default() -> Self {
        Self::Quaternion {
            gains: GainsSpec::Bandwidth {
                bandwidth_rad_s: 0.1,
                damping: 0.7,
            },
            gyroscopic: false,
        }
    }
}

/// How the gains of quaternion feedback are given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GainsSpec {
    /// By the natural frequency and damping ratio of small attitude errors.
    Bandwidth {
        /// Natural frequency, rad/s.
        bandwidth_rad_s: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// By settling time and damping ratio as published (thesis, equations 39, 42 and 171).
    SettlingTime {
        /// Settling time to 2 %, s.
        settling_time_s: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// Directly.
    Given {
        /// `k`, 1/s².
        attitude_per_s2: f64,
        /// `c`, 1/s.
        rate_per_s: f64,
    },
}

/// How the gains of the geometric PID are given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PidGainsSpec {
    /// By the poles of small attitude errors: a conjugate pair and a real pole.
    Bandwidth {
        /// Natural frequency of the pair, rad/s.
        bandwidth_rad_s: f64,
        /// Damping ratio of the pair.
        damping: f64,
        /// The real pole, at which an offset decays, rad/s; 0 for no integral term.
        integral_rad_s: f64,
    },
    /// Directly, as in BIROS equations 23 and 24.
    Given {
        /// `k_R`, N m.
        attitude_nm: f64,
        /// `k_w`, N m s.
        rate_nms: f64,
        /// `k_I`, N m.
        integral_nm: f64,
        /// `k_p`, weight of the attitude error in the integral, 1/s.
        attitude_weight_per_s: f64,
    },
}

/// Errors of the true spacecraft relative to the nominal one. All are zero by default; random ones have
/// a normal distribution with mean zero.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorsSpec {
    /// Three standard deviations of the inertia about any axis, as a share of it.
    pub inertia_3_sigma: Option<f64>,
    /// Three standard deviations of the tilt of a wheel's axis in each of the two directions across
    /// it, rad.
    pub alignment_3_sigma_rad: Option<f64>,
    /// Three standard deviations of a wheel's friction, as a share of it.
    pub friction_3_sigma: Option<f64>,
    /// Three standard deviations of the initial attitude about each body axis, rad.
    pub initial_attitude_3_sigma_rad: Option<f64>,
    /// Standard deviation of the measured attitude about each body axis, rad; drawn at every sample.
    pub attitude_noise_rad: Option<f64>,
    /// Standard deviation of the measured body rate about each body axis, rad/s; drawn at every sample.
    pub rate_noise_rad_s: Option<f64>,
    /// Constant external torque in body axes, N m.
    pub disturbance_torque_nm: Option<[f64; 3]>,
}
