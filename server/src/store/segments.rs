//! Segments of tours that the search of a running job has solved.

use super::database::statement::{Value, sql};
use super::held::held;
use super::{JobRow, Store, StoreError};
use std::collections::BTreeMap;

/// Segments of other versions of the solver are not found.
const SOLVER_VERSION: &str = env!("CARGO_PKG_VERSION");

row! {
    columns segment_columns;
    /// A solved segment.
    #[derive(Debug, Clone, PartialEq)]
    pub(crate) struct SegmentRow {
        /// The solver's name of the segment, unique within the job.
        pub(crate) name: String,
        /// Number of its intervals.
        pub(crate) intervals: i64,
        /// Its motion in binary form.
        pub(crate) motion: Vec<u8>,
    }
}

impl Store {
    /// The segments of a job that this version of the solver has solved.
    pub(crate) async fn segments(&self, job: i64) -> Result<Vec<SegmentRow>, StoreError> {
        sql(concat!(
            "SELECT ",
            segment_columns!(),
            " FROM segments WHERE job = $1 AND solver_version = $2",
        ))
        .bind(job)
        .bind(SOLVER_VERSION)
        .fetch_all(&self.database)
        .await
    }

    /// Stores segments of a leased job, all of them or none; `false` when the lease has been lost.
    pub(crate) async fn put_segments(
        &self,
        lease: &JobRow,
        segments: &[SegmentRow],
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let held: Option<(i64,)> = sql(concat!(
            "SELECT sequence FROM jobs, {rows $1 leased bigint, held bigint} AS lease WHERE ",
            is_held!(),
            " {for_update_of_jobs}"
        ))
        .rows(vec![held(lease)])
        .fetch_optional(&mut *transaction)
        .await?;
        if held.is_none() {
            return Ok(false);
        }
        // A statement must not store a segment twice; of two the last one counts.
        let by_name: BTreeMap<&str, &SegmentRow> = segments
            .iter()
            .map(|segment| (&*segment.name, segment))
            .collect();
        let rows = by_name.into_values().map(|segment| {
            let name = Value::from(&segment.name);
            let motion = Value::from(&segment.motion);
            [
                lease.sequence.into(),
                name,
                segment.intervals.into(),
                motion,
            ]
        });
        sql(
            "INSERT INTO segments (job, name, solver_version, intervals, motion) \
             SELECT of_job, new_name, CAST($1 AS text), new_intervals, new_motion \
             FROM {rows $2 of_job bigint, new_name text, new_intervals bigint, new_motion {bytes}} \
             AS new WHERE true ON CONFLICT (job, name) DO UPDATE SET \
             solver_version = excluded.solver_version, intervals = excluded.intervals, \
             motion = excluded.motion",
        )
        .bind(SOLVER_VERSION)
        .rows(rows.collect())
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Deletes at most `at_most` segments of jobs that have ended. Returns their number. Small
    /// batches let other writes come in between.
    pub(crate) async fn delete_segments_of_ended_jobs(
        &self,
        at_most: i64,
    ) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        let deleted = sql("DELETE FROM segments WHERE sequence IN \
             (SELECT sequence FROM segments \
             WHERE (SELECT finished_us FROM jobs WHERE jobs.sequence = job) IS NOT NULL LIMIT $1)")
        .bind(at_most)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(deleted)
    }
}
