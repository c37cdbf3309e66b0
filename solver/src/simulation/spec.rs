//! What a caller may write about a simulated flight: plain, unvalidated descriptions.

use crate::model::drive::DriveSpec;

/// How a plan is to be flown, and with what errors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SimulationSpec {
    /// The control law.
    pub controller: ControllerSpec,
    /// How the plan's torques reach the wheels; averaged when absent.
    pub feed_forward: Option<FeedForward>,
    /// Samples of the on-board computer per second, 10 when absent. Its commands are held in between.
    pub on_board_rate_hz: Option<f64>,
    /// Cycles of the loop at the wheels per second, 100 when absent: the next whole multiple of the
    /// on-board rate is used.
    pub wheel_loop_rate_hz: Option<f64>,
    /// Samples after which feedback is applied, 0 when absent; 1 is `u_FB(k + 1)` of BIROS
    /// equation 23.
    pub delay_samples: Option<usize>,
    /// Time for which the end of the plan is held under control after it, s; 0 when absent.
    pub settle_s: Option<f64>,
    /// Longest step of the integration, s; 0.01 when absent.
    pub max_step_s: Option<f64>,
    /// What the drives are believed to be, one per wheel, or none for ideal ones. The laws of wheels
    /// that follow one are part of it; such wheels take no commands.
    pub drives: Vec<DriveSpec>,
    /// How the truth differs from what is believed.
    pub errors: ErrorsSpec,
    /// Seed of everything random, 0 when absent.
    pub seed: Option<u64>,
    /// Number of flights of a Monte-Carlo run, 1,000 when absent.
    pub runs: Option<usize>,
    /// Final attitude error up to which a flight counts as a success, degrees; 0.1 when absent.
    pub tolerance_deg: Option<f64>,
}

/// How the torques of a plan, which switch at any time, become commands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FeedForward {
    /// Each on-board sample commands their mean over the time for which it is held: the rate is the
    /// plan's at every sample, the attitude lags by a few microradians at a switch.
    #[default]
    Averaged,
    /// The wheels have a table of them and switch at their times; only feedback is sampled.
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
        /// Whether the torque `w x H` that turns the momentum of body and wheels with the body is made
        /// up for, as far as the plan's torques do not contain it.
        gyroscopic: bool,
    },
    /// The final attitude commanded at once, at rest, without the plan's torques (thesis, equation
    /// 28): what a slew without a plan does, for comparison.
    StepInput {
        /// `k` and `c`.
        gains: GainsSpec,
        /// Whether the torque `w x H` is made up for.
        gyroscopic: bool,
    },
    /// The plan's torques and the geometric PID on rotations (BIROS, equations 18 to 24).
    GeometricPid {
        /// Its gains.
        gains: PidGainsSpec,
        /// Whether the integral leaves out what would ask more of a wheel that is at a limit; without
        /// it, as published, it winds up.
        anti_windup: bool,
    },
}

impl Default for ControllerSpec {
    /// Quaternion feedback of 0.1 rad/s. Without the gyroscopic term: along a plan it makes up for
    /// little, and for the wrong momentum as far as the inertia is.
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
    /// By the natural frequency and damping that small errors of attitude have.
    Bandwidth {
        /// Natural frequency, rad/s.
        bandwidth_rad_s: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// By settling time and damping as published (thesis, equations 39, 42 and 171).
    SettlingTime {
        /// Settling time to 2 %, s.
        settling_time_s: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// As they are.
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
    /// By the poles that small errors of attitude have: a pair and a real one.
    Bandwidth {
        /// Natural frequency of the pair, rad/s.
        bandwidth_rad_s: f64,
        /// Damping ratio of the pair.
        damping: f64,
        /// The real pole, with which an offset decays, rad/s; 0 for none and no integral term.
        integral_rad_s: f64,
    },
    /// As they are in BIROS equations 23 and 24.
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

/// How the truth differs from what is believed. Everything is zero by default; what is drawn has a
/// normal distribution with mean zero.
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
    /// Standard deviation of a measured attitude about each body axis, rad; new at every sample.
    pub attitude_noise_rad: Option<f64>,
    /// Standard deviation of a measured body rate about each body axis, rad/s; new at every sample.
    pub rate_noise_rad_s: Option<f64>,
    /// Constant external torque in body axes, N m.
    pub disturbance_torque_nm: Option<[f64; 3]>,
}
