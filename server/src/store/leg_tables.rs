//! Tables of leg times, stored part by part as their jobs go on.

use super::leases::update_leased;
use super::{JobRow, PackedPlan, Store, StoreError};
use sqlx::FromRow as _;

/// A finished part of a table.
#[derive(Debug)]
pub(crate) struct NewTablePart {
    /// Position of its first leg in the table.
    pub(crate) first: i64,
    /// Its rows.
    pub(crate) document: PackedPlan,
    /// Its legs.
    pub(crate) counts: LegCounts,
}

row! {
    /// How the legs of a table or of a part of it were found.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    pub(crate) struct LegCounts {
        /// All of them.
        pub(crate) legs: i64,
        /// Found in the cache.
        pub(crate) cached: i64,
        /// Solved.
        pub(crate) computed: i64,
    }
}

impl LegCounts {
    /// Legs without a time.
    fn missing(&self) -> i64 {
        self.legs - self.cached - self.computed
    }
}

impl Store {
    /// Positions at which the stored parts of a table begin.
    pub(crate) async fn table_parts(&self, job: i64) -> Result<Vec<i64>, StoreError> {
        let firsts = "SELECT first FROM leg_table_parts WHERE job = ? ORDER BY first";
        Ok(sqlx::query_scalar(firsts)
            .bind(job)
            .fetch_all(&self.readers)
            .await?)
    }

    /// The rows of a stored part as JSON; `None` when there is no such part.
    pub(crate) async fn table_part(
        &self,
        job: i64,
        first: i64,
    ) -> Result<Option<Vec<u8>>, StoreError> {
        let part = sqlx::query(
            "SELECT document, packed, digest FROM leg_table_parts WHERE job = ? AND first = ?",
        )
        .bind(job)
        .bind(first)
        .fetch_optional(&self.readers)
        .await?;
        part.map(|row| PackedPlan::from_row(&row)?.unpacked())
            .transpose()
    }

    /// Stores a part of the table of a leased job, if any, together with the progress that it makes of
    /// a number of legs, and its event; `false` when the lease has been lost.
    pub(crate) async fn put_table_part(
        &self,
        lease: &JobRow,
        part: Option<&NewTablePart>,
        total: i64,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        if let Some(part) = part {
            sqlx::query(
                "INSERT OR REPLACE INTO leg_table_parts \
                 (job, first, legs, cached, computed, document, packed, digest) \
                 SELECT sequence, ?, ?, ?, ?, ?, ?, ? FROM jobs WHERE sequence = ? AND fence = ?",
            )
            .bind(part.first)
            .bind(part.counts.legs)
            .bind(part.counts.cached)
            .bind(part.counts.computed)
            .bind(&part.document.document)
            .bind(part.document.packed)
            .bind(&part.document.digest)
            .bind(lease.sequence)
            .bind(lease.fence)
            .execute(&mut *transaction)
            .await?;
        }
        let counts = sqlx::query(
            "SELECT coalesce(sum(legs), 0) AS legs, coalesce(sum(cached), 0) AS cached, \
             coalesce(sum(computed), 0) AS computed FROM leg_table_parts WHERE job = ?",
        )
        .bind(lease.sequence)
        .fetch_one(&mut *transaction)
        .await?;
        let counts = LegCounts::from_row(&counts)?;
        let update = sqlx::query(concat!(
            "UPDATE jobs SET stage = 'legs', done = ?, total = ?, legs_cached = ?, \
             legs_computed = ?, legs_missing = ? \
             WHERE sequence = ? AND fence = ? AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(counts.legs)
        .bind(total)
        .bind(counts.cached)
        .bind(counts.computed)
        .bind(counts.missing())
        .bind(lease.sequence)
        .bind(lease.fence);
        let Some(_) = update_leased(&mut transaction, update, "progress", now_us).await? else {
            return Ok(false);
        };
        transaction.commit().await?;
        Ok(true)
    }
}
