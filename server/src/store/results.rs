//! Plans: the results of jobs, and the best plans so far (incumbents) of jobs without a result.
//!
//! Incumbents are stored rather than held in memory, so that a plan that was read once can be read
//! again after a restart until a better one replaces it. They are written together with the
//! progress that reports them, and never by the solver's threads. They have a table of their own,
//! so that the plan of an interrupted attempt cannot be mistaken for the result of a job.

use super::database::Transaction;
use super::database::row::{FromRow, Row};
use super::database::statement::sql;
use super::{Ended, JobEnd, JobState, PackedPlan, Store, StoreError};
use bytes::Bytes;

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
    /// Sum of the values that it visits, where targets have values.
    pub(crate) value: Option<f64>,
    /// Whether it violates a cone.
    pub(crate) keep_out_violated: bool,
}

macro_rules! results_of_job {
    () => {
        " FROM jobs LEFT JOIN results r ON r.job = sequence \
         LEFT JOIN incumbents i ON i.job = sequence AND state <> 'cancelled' WHERE id = $1 AND work = 'plan'"
    };
}

/// Stores the incumbent of a running job unless one at least as good is stored already.
pub(super) async fn store_incumbent(
    transaction: &mut Transaction,
    job: i64,
    incumbent: &NewIncumbent,
) -> Result<(), StoreError> {
    sql(
        "INSERT INTO incumbents (job, total_time_s, lower_bound_s, keep_out_violated, document, \
         packed, digest, value) VALUES ($1, $2, $3, $4, $5, $6, $7, $8) ON CONFLICT (job) DO UPDATE SET \
         total_time_s = excluded.total_time_s, lower_bound_s = excluded.lower_bound_s, \
         keep_out_violated = excluded.keep_out_violated, document = excluded.document, \
         packed = excluded.packed, digest = excluded.digest, value = excluded.value \
         WHERE excluded.value > incumbents.value \
         OR ((excluded.value = incumbents.value OR incumbents.value IS NULL) \
         AND excluded.total_time_s < incumbents.total_time_s)",
    )
    .bind(job)
    .bind(incumbent.total_time_s)
    .bind(incumbent.lower_bound_s)
    .bind(incumbent.keep_out_violated)
    .bind(&incumbent.document.document)
    .bind(incumbent.document.packed)
    .bind(&incumbent.document.digest)
    .bind(incumbent.value)
    .execute(transaction)
    .await?;
    Ok(())
}

/// The stored incumbent as the end of a job, when it is better than the plan that the job would end
/// with.
pub(super) async fn better_incumbent(
    transaction: &mut Transaction,
    job: i64,
    ended: &Ended,
) -> Result<Option<Ended>, StoreError> {
    sql(
        "SELECT document, packed, digest, total_time_s, lower_bound_s, value, keep_out_violated \
         FROM incumbents WHERE job = $1 AND ($2 IS NULL OR value > $3 \
         OR ((value = $3 OR value IS NULL) AND total_time_s < $2))",
    )
    .bind(job)
    .bind(ended.incumbent_s)
    .bind(ended.value)
    .fetch_optional(transaction)
    .await
}

/// An incumbent as the end of a job that was cut short.
impl FromRow for Ended {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            state: JobState::Stopped,
            document: Some(PackedPlan::from_row(row)?),
            incumbent_s: row.get("total_time_s")?,
            lower_bound_s: row.get("lower_bound_s")?,
            value: row.get("value")?,
            // That of the job is kept.
            value_bound: None,
            keep_out_violated: row.get("keep_out_violated")?,
            detail: None,
            code: None,
            early: true,
        })
    }
}

/// Replaces incumbents by the results of jobs. A result without a plan does not replace an incumbent.
pub(super) async fn store_results(
    transaction: &mut Transaction,
    ends: &[&JobEnd],
) -> Result<(), StoreError> {
    let planned = ends.iter().filter(|end| end.ended.incumbent_s.is_some());
    // A job whose begin is not stored has no incumbent either.
    let stored = planned.filter(|end| end.begun.is_none());
    let outdated: Vec<_> = stored.map(|end| [end.lease.sequence.into()]).collect();
    if !outdated.is_empty() {
        sql("DELETE FROM incumbents WHERE job IN (SELECT of_job FROM {rows $1 of_job bigint} AS ended)")
            .rows(outdated)
            .execute(&mut *transaction)
            .await?;
    }
    let documents: Vec<_> = ends
        .iter()
        .filter_map(|end| {
            let document = end.ended.document.as_ref()?;
            Some([
                end.lease.sequence.into(),
                (&document.document).into(),
                document.packed.into(),
                (&document.digest).into(),
            ])
        })
        .collect();
    if documents.is_empty() {
        return Ok(());
    }
    sql("INSERT INTO results (job, document, packed, digest) \
         SELECT of_job, new_document, new_packed, new_digest FROM \
         {rows $1 of_job bigint, new_document {bytes}, new_packed boolean, new_digest text} AS new \
         WHERE NOT EXISTS (SELECT 1 FROM incumbents WHERE job = of_job)")
    .rows(documents)
    .execute(transaction)
    .await?;
    Ok(())
}

/// Deletes the incumbent of a job.
async fn delete_incumbent(transaction: &mut Transaction, job: i64) -> Result<(), StoreError> {
    sql("DELETE FROM incumbents WHERE job = $1")
        .bind(job)
        .execute(transaction)
        .await?;
    Ok(())
}

/// Deletes what there is so far of a job that is cancelled: its best plan, or parts of its table.
pub(super) async fn delete_unfinished(
    transaction: &mut Transaction,
    job: i64,
) -> Result<(), StoreError> {
    delete_incumbent(transaction, job).await?;
    sql("DELETE FROM leg_table_parts WHERE job = $1")
        .bind(job)
        .execute(transaction)
        .await?;
    Ok(())
}

impl Store {
    /// The scenario of a job as JSON, or the query of a table, and when it was submitted; `None` when there is no such job.
    pub(crate) async fn scenario(&self, id: &str) -> Result<Option<(Vec<u8>, i64)>, StoreError> {
        sql("SELECT scenario, submitted_us FROM jobs WHERE id = $1")
            .bind(id)
            .fetch_optional(&self.database)
            .await
    }

    /// The state of a job and its plan: its result, or the incumbent unless the job is cancelled.
    /// `None` when there is no such job.
    pub(crate) async fn result(
        &self,
        id: &str,
    ) -> Result<Option<(JobState, Option<ResultRow>)>, StoreError> {
        let known: Option<KnownResult> = sql(concat!(
            "SELECT state, coalesce(r.digest, i.digest) AS digest, r.job IS NOT NULL AS is_final",
            results_of_job!()
        ))
        .bind(id)
        .fetch_optional(&self.database)
        .await?;
        let Some(known) = known else {
            return Ok(None);
        };
        let Some(digest) = known.digest else {
            return Ok(Some((known.state, None)));
        };
        if let Some(document) = self.recent.get(&digest) {
            let plan = ResultRow {
                document,
                digest,
                is_final: known.is_final,
            };
            return Ok(Some((known.state, Some(plan))));
        }
        self.read_result(id).await
    }

    /// The same with the plan read from the database and checked against its hash.
    async fn read_result(
        &self,
        id: &str,
    ) -> Result<Option<(JobState, Option<ResultRow>)>, StoreError> {
        // One statement, so that state and plan belong to the same moment.
        let read: Option<ReadResult> = sql(concat!(
            "SELECT state, coalesce(r.document, i.document) AS document, \
             coalesce(r.packed, i.packed) AS packed, coalesce(r.digest, i.digest) AS digest, \
             r.job IS NOT NULL AS is_final",
            results_of_job!()
        ))
        .bind(id)
        .fetch_optional(&self.database)
        .await?;
        let Some(ReadResult { known, plan }) = read else {
            return Ok(None);
        };
        let (Some(digest), Some(plan)) = (known.digest, plan) else {
            return Ok(Some((known.state, None)));
        };
        let document = Bytes::from(plan.unpacked()?);
        self.recent.keep(&digest, &document);
        let plan = ResultRow {
            document,
            digest,
            is_final: known.is_final,
        };
        Ok(Some((known.state, Some(plan))))
    }
}

/// What is known of a plan before it is read.
struct KnownResult {
    state: JobState,
    /// `None` where there is no plan.
    digest: Option<String>,
    is_final: bool,
}

impl FromRow for KnownResult {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            state: JobState::stored(&row.get::<String>("state")?)?,
            digest: row.get("digest")?,
            is_final: row.get("is_final")?,
        })
    }
}

/// The same with the plan.
struct ReadResult {
    known: KnownResult,
    plan: Option<PackedPlan>,
}

impl FromRow for ReadResult {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        let known = KnownResult::from_row(row)?;
        let there = known.digest.is_some();
        Ok(Self {
            known,
            plan: there.then(|| PackedPlan::from_row(row)).transpose()?,
        })
    }
}
