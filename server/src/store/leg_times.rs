//! Times of stored legs, thousands in a statement, all from one snapshot of the database.

use super::database::Transaction;
use super::database::statement::sql;
use super::legs::{SOLVER_VERSION, json_of, keys_of};
use super::{Store, StoreError};
use slewplan_solver::bounds;
use slewplan_solver::tour::legs::StoredTime;

/// Maximum number of legs of one statement.
const BATCH: usize = 4096;

row! {
    /// The time of a stored leg.
    struct TimeRow {
        /// Place of its key among those asked for.
        position: i64,
        duration_s: f64,
        certified_lower_bound_s: Option<f64>,
        bound_version: Option<i64>,
        solve_time_s: f64,
    }
}

impl TimeRow {
    /// The time of the leg with this key.
    fn time(&self, key: String) -> StoredTime {
        let is_bound_current = self.bound_version == Some(bounds::VERSION.into());
        StoredTime {
            key,
            duration_s: self.duration_s,
            certified_lower_bound_s: self.certified_lower_bound_s.filter(|_| is_bound_current),
            is_bound_current,
            solve_time_s: self.solve_time_s,
        }
    }
}

/// The legs as they were at the first look-up.
#[derive(Debug)]
pub(crate) struct LegSnapshot(Transaction);

impl Store {
    /// A snapshot of the legs. The write-ahead log cannot be reset while it lives.
    pub(crate) async fn leg_snapshot(&self) -> Result<LegSnapshot, StoreError> {
        Ok(LegSnapshot(self.database.snapshot().await?))
    }
}

impl LegSnapshot {
    /// The times of the legs of identities that this version of the solver has solved, in their order.
    pub(crate) async fn times(
        &mut self,
        identities: &[&str],
    ) -> Result<Vec<Option<StoredTime>>, StoreError> {
        let mut times = vec![None; identities.len()];
        for (batch, times) in identities.chunks(BATCH).zip(times.chunks_mut(BATCH)) {
            let mut keys = keys_of(batch);
            for row in self.rows(&keys).await? {
                let place = usize::try_from(row.position).unwrap_or(usize::MAX);
                if let (Some(time), Some(key)) = (times.get_mut(place), keys.get_mut(place)) {
                    *time = Some(row.time(std::mem::take(key)));
                }
            }
        }
        Ok(times)
    }

    async fn rows(&mut self, keys: &[String]) -> Result<Vec<TimeRow>, StoreError> {
        sql(
            "SELECT place AS position, duration_s, certified_lower_bound_s, bound_version, \
             solve_time_s FROM {asked} {with_leg_times} WHERE solver_version = $2",
        )
        .bind(json_of(keys))
        .bind(SOLVER_VERSION)
        .fetch_all(&mut self.0)
        .await
    }
}
