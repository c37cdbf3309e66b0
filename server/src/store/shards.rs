//! Parts of tables of legs, for workers that have nothing else to do: jobs of the same queue, which callers
//! do not see.

use super::database::Transaction;
use super::database::statement::{Value, sql};
use super::held::held;
use super::jobs::PRIORITIES;
use super::{JobRow, Store, StoreError, Work};

/// Memory that a part may need, bytes.
const MEMORY_BYTES: i64 = 32 << 20;
/// The turn of parts, behind all other jobs.
const LAST_TURN: i64 = 1 << 60;

/// A part of a table.
#[derive(Debug)]
pub(crate) struct NewShard {
    /// Identifier, unique.
    pub(crate) id: String,
    /// What is to be solved.
    pub(crate) document: Vec<u8>,
    /// Number of its legs.
    pub(crate) legs: i64,
}

row! {
    /// A job as its parts need it.
    #[derive(Debug)]
    pub(crate) struct ShardedJob {
        work: String,
        /// The scenario or the query as JSON.
        pub(crate) scenario: Vec<u8>,
    }
}

impl ShardedJob {
    /// Whether it makes a table of legs; otherwise a plan.
    pub(crate) fn is_table(&self) -> bool {
        self.work == Work::LegTable.into_str()
    }
}

impl Store {
    /// Queues parts of a table of a leased job, in their order, in place of all parts that it had; none when
    /// the lease has been lost.
    pub(crate) async fn put_shards(
        &self,
        lease: &JobRow,
        shards: &[NewShard],
        now_us: i64,
    ) -> Result<(), StoreError> {
        let mut transaction = self.begin().await?;
        delete(&mut transaction, lease.sequence).await?;
        if !shards.is_empty() {
            let rows = shards.iter().map(|shard| {
                let document = Value::from(&shard.document);
                [Value::from(&shard.id), document, shard.legs.into()]
            });
            sql(
                "INSERT INTO jobs (id, state, work, scenario, targets, submitted_us, priority, \
                 memory_bytes, turn, parent) \
                 SELECT new_id, 'queued', CAST($1 AS text), document, legs, CAST($2 AS bigint), \
                 CAST($3 AS bigint), CAST($4 AS bigint), CAST($5 AS bigint), jobs.sequence \
                 FROM {rows $8 new_id text, document {bytes}, legs bigint} AS new, jobs \
                 WHERE jobs.sequence = $6 AND jobs.fence = $7 AND jobs.boot_id IS NOT NULL",
            )
            .bind(Work::LegTable.into_str())
            .bind(now_us)
            .bind(*PRIORITIES.start())
            .bind(MEMORY_BYTES)
            .bind(LAST_TURN)
            .bind(lease.sequence)
            .bind(lease.fence)
            .rows(rows.collect())
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit().await
    }

    /// The job of a part, while it is worked on.
    pub(crate) async fn sharded_job(&self, parent: i64) -> Result<Option<ShardedJob>, StoreError> {
        sql("SELECT work, scenario FROM jobs WHERE sequence = $1 AND finished_us IS NULL")
            .bind(parent)
            .fetch_optional(&self.database)
            .await
    }

    /// Deletes a leased part, which is done, unless the lease has been lost.
    pub(crate) async fn end_shard(&self, lease: &JobRow) -> Result<(), StoreError> {
        let mut transaction = self.begin().await?;
        sql(concat!(
            "DELETE FROM jobs WHERE EXISTS \
             (SELECT 1 FROM {rows $1 leased bigint, held bigint} AS lease WHERE ",
            is_held!(),
            ")"
        ))
        .rows(vec![held(lease)])
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await
    }
}

/// Deletes all parts of a job; a worker that solves one notices by its lease.
pub(super) async fn delete(transaction: &mut Transaction, parent: i64) -> Result<(), StoreError> {
    sql("DELETE FROM jobs WHERE parent = $1")
        .bind(parent)
        .execute(transaction)
        .await?;
    Ok(())
}
