//! Rows of the tables as types.

use super::StoreError;
use std::str::FromStr as _;

/// The state of a job.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    serde::Serialize,
    utoipa::ToSchema,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase", const_into_str)]
#[strum(parse_err_ty = String, parse_err_fn = unknown_state)]
pub(crate) enum JobState {
    /// Waits for its turn.
    Queued,
    /// Is being solved.
    Running,
    /// Ended with an optimal plan.
    Succeeded,
    /// Ended early with the best plan so far.
    Stopped,
    /// No plan can exist.
    Infeasible,
    /// No plan was found.
    Failed,
    /// Abandoned on request.
    Cancelled,
    /// Given up: its process died at every attempt.
    Dead,
}

fn unknown_state(text: &str) -> String {
    format!("{text:?} is not a state of a job")
}

impl JobState {
    /// Whether the state never changes again.
    pub(crate) const fn is_final(self) -> bool {
        !matches!(self, Self::Queued | Self::Running)
    }

    /// The state in the text of a row.
    pub(super) fn stored(text: &str) -> Result<Self, StoreError> {
        text.parse().map_err(|what| StoreError::Inconsistent {
            table: "jobs",
            what,
        })
    }
}

/// What a job makes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, strum::EnumString, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case", const_into_str)]
pub(crate) enum Work {
    /// A plan for a scenario.
    #[default]
    Plan,
    /// A table of leg times.
    LegTable,
}

row! {
    columns job_columns;
    /// A job without its scenario.
    #[derive(Debug, Clone)]
    pub(crate) struct JobRow {
        /// Order of submission.
        pub(crate) sequence: i64,
        /// Public identifier.
        pub(crate) id: String,
        state: String,
        work: String,
        /// Name of the scenario.
        pub(crate) name: Option<String>,
        /// Number of targets; of legs, for a table.
        pub(crate) targets: i64,
        /// Stage of the solve.
        pub(crate) stage: Option<String>,
        /// Steps of the stage that are done.
        pub(crate) done: Option<i64>,
        /// Steps of the stage in all.
        pub(crate) total: Option<i64>,
        /// Of the legs of a table so far: found in the cache.
        pub(crate) legs_cached: Option<i64>,
        /// Solved.
        pub(crate) legs_computed: Option<i64>,
        /// Without a time.
        pub(crate) legs_missing: Option<i64>,
        /// Duration of the best plan so far, s.
        pub(crate) incumbent_s: Option<f64>,
        /// Lower bound on the duration, s.
        pub(crate) lower_bound_s: Option<f64>,
        /// Sum of the values that the best plan so far visits, where targets have values.
        pub(crate) value: Option<f64>,
        /// Upper bound on that sum.
        pub(crate) value_bound: Option<f64>,
        /// Whether the plan that the job ended with violates a cone.
        pub(crate) keep_out_violated: Option<bool>,
        /// Why the job ended without a plan.
        pub(crate) detail: Option<String>,
        /// The same reason as a stable code.
        pub(crate) code: Option<String>,
        /// Number of attempts so far.
        pub(crate) attempt: i64,
        /// Number of its newest lease (fence).
        pub(crate) fence: i64,
        /// When a stop was requested.
        pub(crate) stop_requested_us: Option<i64>,
        /// When its cancellation was requested.
        pub(crate) cancel_requested_us: Option<i64>,
        /// Jobs of greater priority are leased first.
        pub(crate) priority: i64,
        /// When it was submitted.
        pub(crate) submitted_us: i64,
        /// When its newest attempt began.
        pub(crate) started_us: Option<i64>,
        /// When it ended.
        pub(crate) finished_us: Option<i64>,
        /// The job for which it solves a part of a table of legs; callers do not see such a job.
        pub(crate) parent: Option<i64>,
    }
}

impl JobRow {
    /// The state of the job.
    pub(crate) fn state(&self) -> Result<JobState, StoreError> {
        JobState::stored(&self.state)
    }

    /// The job after the begin of its next attempt.
    pub(crate) fn begun(&self, now_us: i64) -> Self {
        Self {
            state: JobState::Running.into_str().to_owned(),
            attempt: self.attempt + 1,
            // Another machine's clock may have been ahead.
            started_us: Some(now_us.max(self.submitted_us)),
            ..self.clone()
        }
    }

    /// What the job makes.
    pub(crate) fn work(&self) -> Result<Work, StoreError> {
        Work::from_str(&self.work).map_err(|_| StoreError::Inconsistent {
            table: "jobs",
            what: format!("no job makes a {}", self.work),
        })
    }
}

/// Progress of a running job.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ProgressRow {
    /// Stage of the solve.
    pub(crate) stage: &'static str,
    /// Steps of the stage that are done.
    pub(crate) done: i64,
    /// Steps of the stage in all.
    pub(crate) total: Option<i64>,
    /// Duration of the best plan so far, s.
    pub(crate) incumbent_s: Option<f64>,
    /// Lower bound on the duration, s.
    pub(crate) lower_bound_s: Option<f64>,
    /// Sum of the values that the best plan so far visits, where targets have values.
    pub(crate) value: Option<f64>,
    /// Upper bound on that sum.
    pub(crate) value_bound: Option<f64>,
}

/// Number of jobs in a state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counts {
    /// The state.
    pub(crate) state: JobState,
    /// How many are in it.
    pub(crate) jobs: i64,
}
