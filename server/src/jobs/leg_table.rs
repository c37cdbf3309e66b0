//! Makes the table of one job: from its stored query to its last part.
//!
//! A part is stored as soon as its legs are solved, and not made again by a further attempt. Of the
//! part that a killed process was busy with, the legs are in the cache.

use super::Jobs;
use super::solve::{self, JobContext};
use crate::base::clock::now_us;
use crate::documents::document;
use crate::documents::leg_query::{self, LegQuery, Pair, Refusal};
use crate::documents::leg_rows::{LegRow, Source};
use crate::documents::plan::Interruption;
use crate::store::{EndCode, Ended, JobRow, JobState, LegCounts, NewTablePart, PackedPlan};
use slewplan_solver::model::problem::Code;
use slewplan_solver::run::stop::StopReason;
use slewplan_solver::tour::planner::LegTimeTable;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;
use tokio::runtime::Handle;

/// Number of legs of a part: some tenths of a second.
const PART: usize = 512;
/// Legs of so many parts are offered to others at once.
const OFFERED: usize = 8;
/// Pause before another try after a failure of the database.
const RETRY: Duration = Duration::from_millis(500);

/// Where the parts of a leased job are stored.
pub(super) struct TableStore<'a> {
    /// The jobs.
    pub(super) jobs: &'a Jobs,
    /// The lease.
    pub(super) lease: &'a JobRow,
    /// The runtime that reaches the database.
    pub(super) runtime: &'a Handle,
}

/// Makes the table of a stored query. A panic ends this job only.
pub(super) fn solve(query: &[u8], context: &JobContext<'_>, parts: &TableStore<'_>) -> Ended {
    catch_unwind(AssertUnwindSafe(|| attempt(query, context, parts)))
        .unwrap_or_else(|_| solve::broken())
}

fn attempt(query: &[u8], context: &JobContext<'_>, parts: &TableStore<'_>) -> Ended {
    let query = match read(query) {
        Ok(query) => query,
        Err(ended) => return *ended,
    };
    let table = LegTimeTable::of(&query.scenario, query.kind, context.run_of_legs());
    let total = query.pairs.len();
    let known = parts.begun(total, context);
    let (mut complete, mut offered) = (true, 0);
    for first in (0..total).step_by(PART) {
        if known.contains(&first) {
            continue;
        }
        if first >= offered {
            offered = first + OFFERED * PART;
            let next = query.pairs.part(first, OFFERED * PART);
            table.offer(&next.iter().map(Pair::places).collect::<Vec<_>>());
        }
        let pairs = query.pairs.part(first, PART);
        let places: Vec<_> = pairs.iter().map(Pair::places).collect();
        let times = table.solved(&places);
        if context.stop.reason() == Some(StopReason::Cancelled) {
            return solve::without_plan(JobState::Cancelled, None, "cancelled on request");
        }
        let rows: Vec<_> = times
            .into_iter()
            .map(|time| time.map(LegRow::from))
            .collect();
        complete &= rows.iter().all(Option::is_some);
        parts.put(Some((first, &rows)), total, context);
        if table.is_stopped() {
            complete &= first + pairs.len() == total;
            break;
        }
    }
    if complete {
        return ended(JobState::Succeeded);
    }
    let (detail, code) = match context.interruption() {
        Interruption::TimeLimit => ("the time limit passed before all legs were solved", None),
        Interruption::Request => ("stopped on request before all legs were solved", None),
        Interruption::Memory { .. } => (
            "the legs needed more memory than a job may take",
            Some(EndCode::Problem(Code::MemoryLimit)),
        ),
    };
    Ended {
        detail: Some(detail.to_owned()),
        code,
        early: true,
        ..ended(JobState::Stopped)
    }
}

/// A stored query. It was valid when it was accepted, perhaps by another version of the program.
pub(super) fn read(query: &[u8]) -> Result<LegQuery, Box<Ended>> {
    let node = document::parse(query);
    let node = node.map_err(|problem| Box::new(solve::refused(JobState::Failed, &[problem])))?;
    leg_query::read(&node).map_err(|refusal| {
        Box::new(match refusal {
            Refusal::Invalid(problems) => solve::refused(JobState::Failed, &problems),
            Refusal::TooMany(count) => {
                let detail = format!("{count} legs are more than this version takes");
                solve::without_plan(JobState::Failed, None, &detail)
            }
        })
    })
}

fn ended(state: JobState) -> Ended {
    Ended {
        state,
        document: None,
        incumbent_s: None,
        lower_bound_s: None,
        value: None,
        value_bound: None,
        keep_out_violated: None,
        detail: None,
        code: None,
        early: false,
    }
}

impl TableStore<'_> {
    /// Positions at which the parts begin that an earlier attempt has stored.
    fn begun(&self, total: usize, context: &JobContext<'_>) -> Vec<usize> {
        let known = self.jobs.store().table_parts(self.lease.sequence);
        let known = self.runtime.block_on(known).unwrap_or_else(|error| {
            tracing::warn!(%error, "parts of earlier attempts cannot be read");
            Vec::new()
        });
        self.put(None, total, context);
        let known = known
            .into_iter()
            .filter_map(|first| usize::try_from(first).ok());
        known.collect()
    }

    /// Stores a part, and what it makes of the progress; tries again until it is stored, the lease is
    /// lost or the job is cancelled.
    fn put(
        &self,
        part: Option<(usize, &[Option<LegRow>])>,
        total: usize,
        context: &JobContext<'_>,
    ) {
        let part = part.map(|(first, rows)| packed(first, rows));
        let total = i64::try_from(total).unwrap_or(i64::MAX);
        loop {
            let store = self.jobs.store();
            let stored = store.put_table_part(self.lease, part.as_ref(), total, now_us());
            match self.runtime.block_on(stored) {
                Ok(held) => {
                    if !held {
                        context.stop.cancel();
                    }
                    self.jobs.changed();
                    return;
                }
                Err(_) if context.stop.reason() == Some(StopReason::Cancelled) => return,
                Err(error) => tracing::warn!(%error, "a part of a table cannot be stored yet"),
            }
            self.runtime.block_on(tokio::time::sleep(RETRY));
        }
    }
}

fn packed(first: usize, rows: &[Option<LegRow>]) -> NewTablePart {
    let count = |source: Source| {
        let of_source = rows.iter().flatten().filter(|row| row.source == source);
        i64::try_from(of_source.count()).unwrap_or(i64::MAX)
    };
    let [cached, computed, missing] =
        [Source::Cached, Source::Computed, Source::Missing].map(count);
    let json = serde_json::to_vec(rows).expect("rows are plain data");
    NewTablePart {
        first: i64::try_from(first).unwrap_or(i64::MAX),
        document: PackedPlan::of(&json),
        counts: LegCounts {
            legs: cached + computed + missing,
            cached,
            computed,
        },
    }
}
