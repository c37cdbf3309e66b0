//! From a scenario to a verified plan.

use crate::plan::Outcome;
use crate::pool::SolverPool;
use crate::problem::Problem;
use crate::progress::Observer;
use crate::scenario::Scenario;
use crate::stop::StopSignal;

/// What a solve needs from its surroundings.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// Where the work is done.
    pub pool: &'a SolverPool,
    /// Polled for reasons to stop.
    pub stop: &'a StopSignal,
    /// Told about progress.
    pub observer: &'a dyn Observer,
}

/// Which boundary conditions a tabulated leg has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegKind {
    /// All rates zero at both ends; with more than three wheels the null-space momentum of the
    /// scenario's start is held at both ends.
    RestToRest,
    /// Each end with only its own conditions, everything else free: a lower bound of the leg.
    LowerBound,
}

impl LegKind {
    /// The stable text of the kind.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::RestToRest => "rest_to_rest",
            Self::LowerBound => "lower_bound",
        }
    }
}

/// One entry of the table of leg times.
#[derive(Debug, Clone, PartialEq)]
pub struct LegRow {
    /// `start` or a target's identifier.
    pub from: String,
    /// A target's identifier or `end`.
    pub to: String,
    /// The boundary conditions.
    pub kind: LegKind,
    /// Minimum time, s, when solved.
    pub duration_s: Option<f64>,
    /// Wall-clock time of the solve with all starts, refinement and verification, s.
    pub solve_time_s: f64,
    /// How the solve ended (`converged`, ...).
    pub status: String,
}

/// A part of the table: entries `i` with `i % of == index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Zero-based index of the part.
    pub index: usize,
    /// Number of parts.
    pub of: usize,
}

/// Solves a scenario: order, torques, bound, verification.
#[must_use]
pub fn solve(scenario: &Scenario, run: Run<'_>) -> Outcome {
    let _ = (scenario, run);
    Outcome::StoppedEmpty
}

/// Solves all legs between start, targets and end, both directions listed.
///
/// When stopped early the table holds what was finished and the flag is false.
#[must_use]
pub fn leg_table(
    scenario: &Scenario,
    kind: LegKind,
    shard: Shard,
    run: Run<'_>,
) -> (Vec<LegRow>, bool) {
    let _ = (scenario, kind, shard, run);
    (Vec::new(), false)
}

/// What can be said against a valid scenario before it is solved: rests that the wheels cannot
/// hold, for example.
#[must_use]
pub fn feasibility_problems(scenario: &Scenario) -> Vec<Problem> {
    crate::envelope::momentum_problems(scenario)
}
