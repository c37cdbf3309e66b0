//! Leg times of one moment, for a table that is only looked up.

use crate::jobs::leg_cache::BATCH;
use crate::jobs::metrics::JobMetrics;
use crate::store::{LegSnapshot, Store, StoreError};
use slewplan_solver::tour::legs::{LegStore, StoredLeg, StoredTime};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::runtime::Handle;

/// The legs of a database as they are at the first look-up. Nothing is stored through it.
#[derive(Debug)]
pub(crate) struct LegsAtOnce {
    store: Store,
    runtime: Handle,
    metrics: Arc<JobMetrics>,
    snapshot: Mutex<LegSnapshot>,
}

impl LegsAtOnce {
    /// The legs of a store, for threads outside of the runtime.
    ///
    /// # Errors
    ///
    /// When the database cannot be read.
    pub(super) async fn new(
        store: Store,
        runtime: Handle,
        metrics: Arc<JobMetrics>,
    ) -> Result<Self, StoreError> {
        Ok(Self {
            snapshot: Mutex::new(store.leg_snapshot().await?),
            store,
            runtime,
            metrics,
        })
    }
}

impl LegStore for LegsAtOnce {
    /// A leg with its motion, as it is now: a stored leg is only ever replaced by its equal.
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        self.get_all(&[identity]).pop()?
    }

    fn get_all(&self, identities: &[&str]) -> Vec<Option<StoredLeg>> {
        let found = self.runtime.block_on(self.store.known_legs(identities));
        found.unwrap_or_else(|error| {
            tracing::warn!(%error, "legs cannot be looked up");
            vec![None; identities.len()]
        })
    }

    fn batch(&self) -> usize {
        BATCH
    }

    fn times(&self, identities: &[&str]) -> Vec<Option<StoredTime>> {
        let mut snapshot = self.snapshot.lock().unwrap_or_else(PoisonError::into_inner);
        let times = self.runtime.block_on(snapshot.times(identities));
        let times = times.unwrap_or_else(|error| {
            tracing::warn!(%error, "legs cannot be looked up");
            vec![None; identities.len()]
        });
        self.metrics.looked_up(&times);
        times
    }

    fn put(&self, _: &str, _: &StoredLeg) {}
}
