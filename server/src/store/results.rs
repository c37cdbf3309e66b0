//! Plans: the results of jobs, and the best plans so far (incumbents) of jobs without a result.
//!
//! Incumbents are stored rather than held in memory, so that a plan that was read once can be read
//! again after a restart until a better one replaces it. They are written together with the
//! progress that reports them, and never by the solver's threads. They have a table of their own,
//! so that the plan of an interrupted attempt cannot be mistaken for the result of a job.

use super::{Ended, JobState, PackedPlan, Store, StoreError};
use bytes::Bytes;
use sqlx::{FromRow, Row, SqliteConnection};

/// A stored plan.
#[derive(Debug, Clone)]
pub(crate) struct ResultRow {
    /// The plan as JSON.
    pub(crate) document: Bytes,
    /// SHA-256 of the document, hex.
    pub(crate) digest: String,
    /// Whether it is the result of the job, not an incumbent.
    pub(crate) is_final: bool,
}

/// A better plan, found while a job runs.
#[derive(Debug, Clone)]
pub(crate) struct NewIncumbent {
    /// The plan.
    pub(crate) document: PackedPlan,
    /// Its duration, s.
    pub(crate) total_time_s: f64,
    /// Lower bound on the duration when it was found, s.
    pub(crate) lower_bound_s: f64,
    /// Whether it violates a cone.
    pub(crate) keep_out_violated: bool,
}

macro_rules! results_of_job {
    () => {
        " FROM jobs LEFT JOIN results r ON r.job = sequence \
         LEFT JOIN incumbents i ON i.job = sequence AND state <> 'cancelled' WHERE id = ? AND work = 'plan'"
    };
}

/// Stores the incumbent of a running job unless one at least as good is stored already.
pub(super) async fn store_incumbent(
    connection: &mut SqliteConnection,
    job: i64,
    incumbent: &NewIncumbent,
) -> Result<(), StoreError> {
    sqlx::query(
        "INSERT INTO incumbents (job, total_time_s, lower_bound_s, keep_out_violated, document, \
         packed, digest) VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (job) DO UPDATE SET \
         total_time_s = excluded.total_time_s, lower_bound_s = excluded.lower_bound_s, \
         keep_out_violated = excluded.keep_out_violated, document = excluded.document, \
         packed = excluded.packed, digest = excluded.digest \
         WHERE excluded.total_time_s < total_time_s",
    )
    .bind(job)
    .bind(incumbent.total_time_s)
    .bind(incumbent.lower_bound_s)
    .bind(incumbent.keep_out_violated)
    .bind(&incumbent.document.document)
    .bind(incumbent.document.packed)
    .bind(&incumbent.document.digest)
    .execute(connection)
    .await?;
    Ok(())
}

/// The stored incumbent as the end of a job, when it is better than the plan that the job would end
/// with.
pub(super) async fn better_incumbent(
    connection: &mut SqliteConnection,
    job: i64,
    ended: &Ended,
) -> Result<Option<Ended>, StoreError> {
    let kept = sqlx::query(
        "SELECT document, packed, digest, total_time_s, lower_bound_s, keep_out_violated \
         FROM incumbents \
         WHERE job = ?1 AND (?2 IS NULL OR total_time_s < ?2)",
    )
    .bind(job)
    .bind(ended.incumbent_s)
    .fetch_optional(connection)
    .await?;
    let Some(row) = kept else {
        return Ok(None);
    };
    Ok(Some(Ended {
        state: JobState::Stopped,
        document: Some(PackedPlan::from_row(&row)?),
        incumbent_s: row.try_get("total_time_s")?,
        lower_bound_s: row.try_get("lower_bound_s")?,
        keep_out_violated: row.try_get("keep_out_violated")?,
        detail: None,
        code: None,
        early: true,
    }))
}

/// Replaces the incumbent by the result of the job. A result without a plan does not replace an
/// incumbent.
pub(super) async fn store_result(
    connection: &mut SqliteConnection,
    job: i64,
    ended: &Ended,
) -> Result<(), StoreError> {
    if ended.incumbent_s.is_some() {
        delete_incumbent(connection, job).await?;
    }
    if let Some(document) = &ended.document {
        sqlx::query(
            "INSERT INTO results (job, document, packed, digest) SELECT ?1, ?2, ?3, ?4 \
             WHERE NOT EXISTS (SELECT 1 FROM incumbents WHERE job = ?1)",
        )
        .bind(job)
        .bind(&document.document)
        .bind(document.packed)
        .bind(&document.digest)
        .execute(connection)
        .await?;
    }
    Ok(())
}

/// Deletes the incumbent of a job that ends with another plan.
async fn delete_incumbent(connection: &mut SqliteConnection, job: i64) -> Result<(), StoreError> {
    sqlx::query("DELETE FROM incumbents WHERE job = ?")
        .bind(job)
        .execute(connection)
        .await?;
    Ok(())
}

/// Deletes what there is so far of a job that is cancelled: its best plan, or parts of its table.
pub(super) async fn delete_unfinished(
    connection: &mut SqliteConnection,
    job: i64,
) -> Result<(), StoreError> {
    delete_incumbent(connection, job).await?;
    sqlx::query("DELETE FROM leg_table_parts WHERE job = ?")
        .bind(job)
        .execute(connection)
        .await?;
    Ok(())
}

impl Store {
    /// The scenario of a job as JSON, or the query of a table, and when it was submitted; `None` when there is no such job.
    pub(crate) async fn scenario(&self, id: &str) -> Result<Option<(Vec<u8>, i64)>, StoreError> {
        let found = sqlx::query_as("SELECT scenario, submitted_us FROM jobs WHERE id = ?")
            .bind(id)
            .fetch_optional(&self.readers)
            .await?;
        Ok(found)
    }

    /// The state of a job and its plan: its result, or the incumbent unless the job is cancelled.
    /// `None` when there is no such job.
    pub(crate) async fn result(
        &self,
        id: &str,
    ) -> Result<Option<(JobState, Option<ResultRow>)>, StoreError> {
        let known = sqlx::query(concat!(
            "SELECT state, coalesce(r.digest, i.digest) AS digest, r.job IS NOT NULL AS is_final",
            results_of_job!()
        ))
        .bind(id)
        .fetch_optional(&self.readers)
        .await?;
        let Some(row) = known else {
            return Ok(None);
        };
        let digest: Option<String> = row.try_get("digest")?;
        let Some(digest) = digest else {
            return Ok(Some((JobState::stored(row.try_get("state")?)?, None)));
        };
        if let Some(document) = self.recent.get(&digest) {
            let plan = ResultRow {
                document,
                digest,
                is_final: row.try_get("is_final")?,
            };
            return Ok(Some((JobState::stored(row.try_get("state")?)?, Some(plan))));
        }
        self.read_result(id).await
    }

    /// The same with the plan read from the database and checked against its hash.
    async fn read_result(
        &self,
        id: &str,
    ) -> Result<Option<(JobState, Option<ResultRow>)>, StoreError> {
        // One statement, so that state and plan belong to the same moment.
        let row = sqlx::query(concat!(
            "SELECT state, coalesce(r.document, i.document) AS document, \
             coalesce(r.packed, i.packed) AS packed, coalesce(r.digest, i.digest) AS digest, \
             r.job IS NOT NULL AS is_final",
            results_of_job!()
        ))
        .bind(id)
        .fetch_optional(&self.readers)
        .await?;
        let Some(row) = row else {
            return Ok(None);
        };
        let state = JobState::stored(row.try_get("state")?)?;
        let Some(digest) = row.try_get::<Option<String>, _>("digest")? else {
            return Ok(Some((state, None)));
        };
        let document = Bytes::from(PackedPlan::from_row(&row)?.unpacked()?);
        self.recent.keep(&digest, &document);
        let plan = ResultRow {
            document,
            digest,
            is_final: row.try_get("is_final")?,
        };
        Ok(Some((state, Some(plan))))
    }
}
