//! The answer: order, passage times, wheel torques, bound and verification.

mod rolls;
mod schedule;

pub use rolls::Rolls;
pub use schedule::{InclusionCost, Objective, Schedule, SkipReason, SkippedTarget, Wait};

use crate::model::attitude::Attitude;
use crate::model::cone::Cone;
use crate::model::problem::Problem;
use nalgebra::Vector3;

/// How a solve ended.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// A verified plan.
    Planned(Box<Plan>),
    /// No plan can exist, for these reasons.
    Infeasible(Vec<Problem>),
    /// No plan was found, for these reasons; none may be a proof.
    Failed(Vec<Problem>),
    /// Stopped before a first plan was found.
    StoppedEmpty,
}

/// What is known about a plan's optimality.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Optimality {
    /// The search is complete: no order beats the plan by more than the requested gap, relative
    /// to the stated kind of bound.
    Optimal,
    /// The search was stopped with this incumbent.
    Feasible,
}

/// What a lower bound rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum LowerBoundKind {
    /// Relaxed multi-phase NLPs, assumed to be solved globally.
    NlpRelaxation,
    /// Sums over a table of leg times with free ends, assumed to be solved globally.
    PairTable,
    /// Proved bounds of the rate-limited kinematics.
    Certified,
}

/// A complete answer.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What is known about optimality.
    pub optimality: Optimality,
    /// Duration including settle and dwell, s.
    pub total_time_s: f64,
    /// No plan is shorter than this, s, in the sense of the kind; of a scenario with values, no plan of
    /// at least the same value.
    pub lower_bound_s: f64,
    /// `(total - bound) / total`.
    pub relative_gap: f64,
    /// What the bound rests on.
    pub lower_bound_kind: LowerBoundKind,
    /// Proved: no plan is shorter than this, s, in any order that the scenario admits (in the given
    /// order, where one was given). It is the shortest sum of the certified bounds of legs with
    /// settle and dwell. `None` where no leg is bounded.
    pub certified_lower_bound_s: Option<f64>,
    /// The next best orders.
    pub alternatives: Vec<Alternative>,
    /// One entry per leg.
    pub legs: Vec<Leg>,
    /// The motion: passages and torques.
    pub flight: Flight,
    /// The rolls about the boresights that are pointed.
    pub rolls: Rolls,
    /// What the clock adds; `None` for a scenario without windows, values and latest end.
    pub schedule: Option<Schedule>,
    /// Sampled states, at every control boundary at least.
    pub states: Vec<State>,
    /// The margins of all limits.
    pub margins: Margins,
    /// The independent re-integration.
    pub verification: Verification,
    /// Statistics of the solve.
    pub statistics: Statistics,
    /// Warnings, for example of keep-out violations.
    pub warnings: Vec<Problem>,
}

impl Plan {
    /// The largest relative distance between a leg's duration and its certified bound: what a
    /// better local minimum might save. One where a leg has no bound; `None` without legs.
    #[must_use]
    pub fn largest_open_share(&self) -> Option<f64> {
        let slews = self.legs.iter().filter(|leg| leg.duration_s > 0.0);
        let open = slews.map(|leg| {
            let proved = leg.certified_lower_bound_s.unwrap_or(0.0);
            (1.0 - proved / leg.duration_s).max(0.0)
        });
        open.reduce(f64::max)
    }
}

/// The part of a plan that is commanded and checked: times of the passages, and torques.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// Duration, s.
    pub total_time_s: f64,
    /// The passages in order of time.
    pub passages: Vec<Passage>,
    /// Wheel torques; the intervals tile `[0, total_time_s]`.
    pub controls: Vec<Control>,
}

/// The passage of a target.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// Identifier of the target.
    pub target: String,
    /// Arrival, s.
    pub time_s: f64,
    /// Departure: arrival plus settle and dwell, s.
    pub departure_s: f64,
}

/// Constant wheel torques on one interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// Begin of the interval, s.
    pub start_s: f64,
    /// Length of the interval, s.
    pub duration_s: f64,
    /// Motor torque on each wheel, N m; the body feels the opposite.
    pub wheel_torque_nm: Vec<f64>,
}

/// Another order of the same targets.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// Identifiers in visiting order.
    pub sequence: Vec<String>,
    /// Duration, s.
    pub total_time_s: f64,
}

/// One leg of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Where it begins: `start` or a target's identifier.
    pub from: String,
    /// Where it ends: a target's identifier or `end`.
    pub to: String,
    /// Begin, s.
    pub start_s: f64,
    /// Length without settle and dwell, s.
    pub duration_s: f64,
    /// Proved: no leg between these two places under the scenario's conditions takes less, s, in
    /// any tour. Rates that the plan chose are not used. `None` where nothing is proved.
    pub certified_lower_bound_s: Option<f64>,
    /// Time of the rest-to-rest eigenaxis slew, s, when that slew keeps all limits; cones aside.
    pub eigenaxis_duration_s: Option<f64>,
    /// Minimum time of the leg from rest to rest between the same attitudes, s: its duration if it
    /// stood alone and there were no cones. `None` when it was not solved, as in plans of searches
    /// that were stopped or go on.
    pub rest_to_rest_duration_s: Option<f64>,
    /// How the NLP that shaped this leg ended.
    pub solver_status: String,
}

/// A state of the spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time, s.
    pub time_s: f64,
    /// Attitude, with the sign of the continuous quaternion trajectory.
    pub attitude: Attitude,
    /// Body rate in body axes, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Wheel speeds relative to the body, rad/s.
    pub wheel_speed_rad_s: Vec<f64>,
}

impl State {
    /// The one nearest to a time, s, of states in order of time. Passages are control boundaries, which
    /// all have a state.
    #[must_use]
    pub fn nearest(states: &[Self], time_s: f64) -> Option<&Self> {
        let after = states.partition_point(|state| state.time_s < time_s);
        let candidates = &states[after.saturating_sub(1)..states.len().min(after + 1)];
        candidates.iter().min_by(|a, b| {
            (a.time_s - time_s)
                .abs()
                .total_cmp(&(b.time_s - time_s).abs())
        })
    }
}

/// Relative margins of all limits: 0 is at the limit, 1 is unused.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Margins {
    /// Smallest relative margin of the wheel torques.
    pub torque: f64,
    /// Smallest relative margin of the wheel speeds, when any is limited.
    pub wheel_speed: Option<f64>,
    /// Smallest relative margin of the body rates, when any is limited.
    pub body_rate: Option<f64>,
    /// How often each wheel's speed passes through zero.
    pub wheel_zero_crossings: Vec<u32>,
    /// The closest approach to each cone, keep-out and keep-in, that applied at some time.
    pub keep_out_clearance_deg: Vec<ConeClearance>,
    /// Every time span on the wrong side of a cone while it applied, in order of cone and time.
    pub keep_out_intrusions: Vec<Intrusion>,
}

impl Margins {
    /// Whether a boresight is on the wrong side of a cone at some time.
    #[must_use]
    pub fn violates_cones(&self) -> bool {
        !self.keep_out_intrusions.is_empty()
    }
}

/// The closest approach of a boresight to the surface of a cone.
#[derive(Debug, Clone, PartialEq)]
pub struct ConeClearance {
    /// Name of the boresight.
    pub boresight: String,
    /// JSON pointer of the cone in the scenario.
    pub cone: String,
    /// Unit vector along the cone's axis in the reference frame: where the Sun was taken to be.
    pub direction: Vector3<f64>,
    /// Smallest angle to the cone's surface while the cone applied, degrees; negative on the wrong
    /// side.
    pub clearance_deg: f64,
    /// When, s.
    pub time_s: f64,
}

impl ConeClearance {
    /// An angle between the boresight and the surface, rad, negative on the wrong side, at a time, s.
    /// What could not be computed, a number of the largest size, stays one.
    #[must_use]
    pub fn new(cone: &Cone, clearance: f64, time_s: f64) -> Self {
        Self {
            boresight: cone.boresight.clone(),
            cone: cone.pointer(),
            direction: cone.direction,
            clearance_deg: clearance.to_degrees().clamp(f64::MIN, f64::MAX),
            time_s,
        }
    }
}

/// A span of time during which a boresight is on the wrong side of a cone.
#[derive(Debug, Clone, PartialEq)]
pub struct Intrusion {
    /// Name of the boresight.
    pub boresight: String,
    /// JSON pointer of the cone in the scenario.
    pub cone: String,
    /// Entry, s.
    pub from_s: f64,
    /// Exit, s.
    pub to_s: f64,
    /// Largest angle to the cone's surface, rad.
    pub depth_rad: f64,
}

/// Result of the independent re-integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// Whether every tolerance is met.
    pub passed: bool,
    /// Largest attitude error at a passage or the end, rad.
    pub max_attitude_error_rad: f64,
    /// Largest error of a required rate component, rad/s.
    pub max_rate_error_rad_s: f64,
    /// Largest relative excess over a wheel speed limit.
    pub max_wheel_speed_excess: f64,
    /// Largest relative excess over a torque limit.
    pub max_torque_excess: f64,
    /// Largest relative excess over a body rate limit.
    pub max_rate_excess: f64,
    /// The integrator and its tolerance.
    pub integrator: String,
    /// What failed, in words; empty when passed.
    pub failures: Vec<String>,
}

/// Work and progress of a solve; never part of a comparison between plans.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Statistics {
    /// Wall-clock time, s.
    pub wall_time_s: f64,
    /// Search nodes explored.
    pub nodes_explored: u64,
    /// NLPs solved, all starts counted.
    pub nlp_solves: u64,
    /// NLPs solved, by kind.
    pub nlp_solves_by_kind: NlpSolves,
    /// Nodes of the search, by their fate.
    pub search: SearchWork,
    /// Every plan that was better than those before it; the last one is the plan returned.
    pub history: Vec<Milestone>,
    /// Legs solved.
    pub legs_solved: u64,
    /// Legs taken from a cache.
    pub legs_from_cache: u64,
    /// Worker threads.
    pub threads: usize,
}

/// NLPs solved, all starts counted, by purpose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NlpSolves {
    /// Single legs.
    pub legs: u64,
    /// Segments: several legs in one program, coupled where rates are free, of prefixes and whole
    /// orders.
    pub segments: u64,
}

/// Nodes of the search, by their fate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SearchWork {
    /// Prefixes of orders evaluated.
    pub prefixes: u64,
    /// Prefixes whose evaluation did not converge.
    pub prefixes_unresolved: u64,
    /// Whole orders evaluated.
    pub tours: u64,
    /// Whole orders whose evaluation did not converge.
    pub tours_unresolved: u64,
    /// Nodes pruned by the table of legs alone.
    pub pruned_by_table: u64,
    /// Nodes pruned by their own evaluation.
    pub pruned_by_prefix: u64,
    /// Nodes pruned when a better order was found.
    pub pruned_by_incumbent: u64,
    /// Nodes dropped because memory was short.
    pub dropped_for_memory: u64,
}

/// A moment at which a better plan was known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Milestone {
    /// Wall-clock time since the beginning, s.
    pub time_s: f64,
    /// Duration of the best plan then, s.
    pub total_time_s: f64,
    /// Its lower bound then, s.
    pub lower_bound_s: f64,
}
