//! Descriptions of simulated flights as a caller gives them, not yet validated.

use crate::model::drive::DriveSpec;
use crate::model::input::{input_choice, input_object, input_union, optional, or, required};

input_object! {
    /// How a plan is simulated in closed loop, and with which errors.
    #[derive(Default)]
    pub struct SimulationSpec as "Simulation" {
        /// Quaternion feedback of 0.1 rad/s without it.
        pub controller: ControllerSpec = or(ControllerSpec::default()),
        /// How the plan's torques, which switch at any time, become commands; `averaged` without it.
        pub feed_forward: Option<FeedForwardMode> = optional(),
        /// Samples of the on-board computer per second. Its commands are held in between.
        pub on_board_rate_hz: Option<f64> = optional().above(0.0).means(10.0),
        /// Cycles of the wheel loop per second; rounded up to a whole multiple of the on-board rate.
        pub wheel_loop_rate_hz: Option<f64> = optional().above(0.0).means(100.0),
        /// Samples after which feedback is applied; 1 is `u_FB(k + 1)` of BIROS equation 23.
        pub delay_samples: Option<usize> = optional().format("int32").means(0_u64),
        /// Time for which the end of the plan is held under control after it.
        pub settle_s: Option<f64> = optional().at_least(0.0).means(0.0),
        /// Longest step of the integration.
        pub max_step_s: Option<f64> = optional().above(0.0).means(0.01),
        /// Nominal drives, one for each wheel; ideal ones without it. They include speed laws; wheels with
        /// a speed law take no commands.
        pub drives: Vec<DriveSpec> = or(Vec::new()),
        /// Errors of the true spacecraft relative to the nominal one.
        pub errors: ErrorsSpec = or(ErrorsSpec::default()),
        /// Seed of everything random.
        pub seed: Option<u64> = optional().means(0_u64),
        /// Number of flights.
        pub runs: Option<usize> = optional().at_least(1.0).format("int32").means(1000_u64),
        /// Final attitude error up to which a flight counts as a success.
        pub tolerance_deg: Option<f64> = optional().above(0.0).means(0.1),
    }
}

input_choice! {
    /// How the torques of a plan, which may switch at any time, become commands.
    pub enum FeedForwardMode as "FeedForward" {
        /// Each on-board sample commands their mean until the next sample: body rates at samples are those
        /// of the plan, the attitude differs by some microradians after a switch.
        Averaged = "averaged",
        /// The wheels switch at the plan's times, from a stored table; only feedback is sampled.
        TimeTagged = "time_tagged",
    }
}

input_union! {
    /// A control law.
    pub enum ControllerSpec as "Controller" {
        /// The plan's torques and nothing else.
        FeedForward = "feed_forward",
        /// The plan's torques and quaternion feedback (RW/CMG thesis, equations 157 and 158):
        /// `-k J q_e - c J w_e`.
        Quaternion = "quaternion" {
            /// Whether the gyroscopic torque `w x H` of body and wheels is compensated, as far as the
            /// plan's torques do not contain it.
            gyroscopic: bool = or(false),
            /// `k` and `c`.
            gains: GainsSpec = required(),
        },
        /// The final attitude commanded at once, at rest, without the plan's torques (thesis, equation
        /// 28): what a slew without a plan does, for comparison.
        StepInput = "step_input" {
            /// Whether the gyroscopic torque `w x H` is compensated.
            gyroscopic: bool = or(false),
            /// `k` and `c`.
            gains: GainsSpec = required(),
        },
        /// The plan's torques and the geometric PID on rotations (BIROS, equations 18 to 24).
        GeometricPid = "geometric_pid" {
            /// Its gains.
            gains: PidGainsSpec = required(),
            /// Whether the integral stops in directions that demand more of a wheel at a limit. Without
            /// it, as published, the integral winds up.
            anti_windup: bool = or(true),
        },
    }
}

/// Damping ratio of feedback where none is given.
const DEFAULT_DAMPING: f64 = 0.7;

impl Default for ControllerSpec {
    /// Quaternion feedback with a bandwidth of 0.1 rad/s, without the gyroscopic term: along a plan it
    /// compensates little, and with the momentum of the nominal inertia.
    fn default() -> Self {
        Self::Quaternion {
            gains: GainsSpec::Bandwidth {
                bandwidth_rad_s: 0.1,
                damping: DEFAULT_DAMPING,
            },
            gyroscopic: false,
        }
    }
}

input_union! {
    /// Gains of quaternion feedback `-k J q_e - c J w_e`.
    #[derive(Copy)]
    pub enum GainsSpec as "Gains" {
        /// By the natural frequency and damping ratio of small attitude errors.
        Bandwidth = "bandwidth" {
            /// Natural frequency.
            bandwidth_rad_s: f64 = required().above(0.0),
            /// Damping ratio.
            damping: f64 = or(DEFAULT_DAMPING).above(0.0),
        },
        /// By settling time and damping ratio as published (thesis, equations 39, 42 and 171).
        SettlingTime = "settling_time" {
            /// Settling time to 2 %.
            settling_time_s: f64 = required().above(0.0),
            /// Damping ratio.
            damping: f64 = or(DEFAULT_DAMPING).above(0.0),
        },
        /// Directly.
        Given = "given" {
            /// `k`, 1/s².
            attitude_per_s2: f64 = required(),
            /// `c`, 1/s.
            rate_per_s: f64 = required(),
        },
    }
}

input_union! {
    /// Gains of the geometric PID.
    #[derive(Copy)]
    pub enum PidGainsSpec as "PidGains" {
        /// By the poles of small attitude errors: a conjugate pair and a real pole.
        Bandwidth = "bandwidth" {
            /// The real pole, at which an offset decays; 0 for no integral term.
            integral_rad_s: f64 = or(0.0).at_least(0.0),
            /// Natural frequency of the pair.
            bandwidth_rad_s: f64 = required().above(0.0),
            /// Damping ratio of the pair.
            damping: f64 = or(DEFAULT_DAMPING).above(0.0),
        },
        /// Directly, as in BIROS equations 23 and 24.
        Given = "given" {
            /// `k_R`, N m.
            attitude_nm: f64 = required(),
            /// `k_w`, N m s.
            rate_nms: f64 = required(),
            /// `k_I`, N m.
            integral_nm: f64 = required(),
            /// `k_p`, weight of the attitude error in the integral, 1/s.
            attitude_weight_per_s: f64 = required(),
        },
    }
}

input_object! {
    /// Errors of the true spacecraft relative to the nominal one. All are zero by default; random ones
    /// have a normal distribution with mean zero.
    #[derive(Default)]
    pub struct ErrorsSpec as "SimulationErrors" {
        /// Three standard deviations of the inertia about any axis, as a share of it.
        pub inertia_3_sigma: Option<f64> = optional().at_least(0.0),
        /// Three standard deviations of the tilt of a wheel's axis in each of the two directions across
        /// it.
        pub alignment_3_sigma_rad: Option<f64> = optional().at_least(0.0),
        /// Three standard deviations of a wheel's friction, as a share of it.
        pub friction_3_sigma: Option<f64> = optional().at_least(0.0),
        /// Three standard deviations of the initial attitude about each body axis.
        pub initial_attitude_3_sigma_rad: Option<f64> = optional().at_least(0.0),
        /// Standard deviation of the measured attitude about each body axis, drawn at every sample.
        pub attitude_noise_rad: Option<f64> = optional().at_least(0.0),
        /// Standard deviation of the measured body rate about each body axis, drawn at every sample.
        pub rate_noise_rad_s: Option<f64> = optional().at_least(0.0),
        /// Constant external torque in body axes.
        pub disturbance_torque_nm: Option<[f64; 3]> = optional(),
    }
}
