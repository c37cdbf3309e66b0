//! Tables of leg times, stored part by part as their jobs go on.

use super::database::statement::sql;
use super::leases::update_leased;
use super::{JobRow, PackedPlan, Store, StoreError};

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
        let firsts: Vec<(i64,)> =
            sql("SELECT first FROM leg_table_parts WHERE job = $1 ORDER BY first")
                .bind(job)
                .fetch_all(&self.database)
                .await?;
        Ok(firsts.into_iter().map(|(first,)| first).collect())
    }

    /// The rows of a stored part as JSON; `None` when there is no such part.
    pub(crate) async fn table_part(
        &self,
        job: i64,
        first: i64,
    ) -> Result<Option<Vec<u8>>, StoreError> {
        let part: Option<PackedPlan> = sql(
            "SELECT document, packed, digest FROM leg_table_parts WHERE job = $1 AND first = $2",
        )
        .bind(job)
        .bind(first)
        .fetch_optional(&self.database)
        .await?;
        part.map(PackedPlan::unpacked).transpose()
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
            sql("INSERT INTO leg_table_parts \
                 (job, first, legs, cached, computed, document, packed, digest) \
                 SELECT sequence, $1, $2, $3, $4, $5, $6, $7 FROM jobs \
                 WHERE sequence = $8 AND fence = $9 \
                 ON CONFLICT (job, first) DO UPDATE SET legs = excluded.legs, \
                 cached = excluded.cached, computed = excluded.computed, \
                 document = excluded.document, packed = excluded.packed, digest = excluded.digest")
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
        let counts: LegCounts = sql("SELECT CAST(coalesce(sum(legs), 0) AS bigint) AS legs, \
             CAST(coalesce(sum(cached), 0) AS bigint) AS cached, \
             CAST(coalesce(sum(computed), 0) AS bigint) AS computed \
             FROM leg_table_parts WHERE job = $1")
        .bind(lease.sequence)
        .fetch_one(&mut *transaction)
        .await?;
        let update = sql(concat!(
            "UPDATE jobs SET stage = 'legs', done = $1, total = $2, legs_cached = $3, \
             legs_computed = $4, legs_missing = $5 \
             WHERE sequence = $6 AND fence = $7 AND state = 'running' RETURNING ",
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
