//! Segments of tours that the search of a running job has solved.

use super::{JobRow, Store, StoreError};

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
        Ok(sqlx::query_as(concat!(
            "SELECT ",
            segment_columns!(),
            " FROM segments WHERE job = ? AND solver_version = ?",
        ))
        .bind(job)
        .bind(SOLVER_VERSION)
        .fetch_all(&self.readers)
        .await?)
    }

    /// Stores segments of a leased job, all of them or none; `false` when the lease has been lost.
    pub(crate) async fn put_segments(
        &self,
        lease: &JobRow,
        segments: &[SegmentRow],
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let held: Option<i64> = sqlx::query_scalar(
            "SELECT sequence FROM jobs WHERE sequence = ? AND fence = ? AND state = 'running'",
        )
        .bind(lease.sequence)
        .bind(lease.fence)
        .fetch_optional(&mut *transaction)
        .await?;
        if held.is_none() {
            return Ok(false);
        }
        for segment in segments {
            sqlx::query(
                "INSERT OR REPLACE INTO segments (job, name, solver_version, intervals, motion) \
                 VALUES (?, ?, ?, ?, ?)",
            )
            .bind(lease.sequence)
            .bind(&segment.name)
            .bind(SOLVER_VERSION)
            .bind(segment.intervals)
            .bind(&segment.motion)
            .execute(&mut *transaction)
            .await?;
        }
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
        let done = sqlx::query(
            "DELETE FROM segments WHERE sequence IN \
             (SELECT segments.sequence FROM segments JOIN jobs ON jobs.sequence = job \
             WHERE finished_us IS NOT NULL LIMIT ?)",
        )
        .bind(at_most)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(done.rows_affected())
    }
}
