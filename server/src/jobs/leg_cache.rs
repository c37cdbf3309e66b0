//! The leg cache: the solver's view of the legs in the database.

pub(crate) mod upkeep;

use crate::base::clock::now_us;
use crate::jobs::metrics::JobMetrics;
use crate::store::{NewLeg, Store};
use slewplan_solver::tour::legs::{LegStore, StoredLeg, StoredTime};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::runtime::Handle;

/// Number of legs per transaction.
const BATCH: usize = 64;
/// Interval between two writes of [`Unwritten::keep_writing`].
const ROUND: Duration = Duration::from_millis(10);

/// The legs of a database for one solve. New legs are written in batches, on request, and when the
/// value is dropped, which must not happen on a thread of the runtime.
#[derive(Debug)]
pub(crate) struct LegCache {
    store: Store,
    runtime: Handle,
    metrics: Arc<JobMetrics>,
    unwritten: Unwritten,
}

/// Solved legs that are not in the database yet.
#[derive(Debug, Clone)]
pub(crate) struct Unwritten {
    store: Store,
    legs: Arc<Mutex<Vec<NewLeg>>>,
}

impl Unwritten {
    fn legs(&self) -> MutexGuard<'_, Vec<NewLeg>> {
        self.legs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes them at intervals, without end.
    pub(crate) async fn keep_writing(self) {
        loop {
            tokio::time::sleep(ROUND).await;
            self.write().await;
        }
    }

    /// Writes all of them.
    pub(crate) async fn write(&self) {
        let legs = std::mem::take(&mut *self.legs());
        if legs.is_empty() {
            return;
        }
        // Not an error of the job: a lost leg is solved again.
        if let Err(error) = self.store.put_legs(&legs, now_us()).await {
            tracing::warn!(%error, legs = legs.len(), "solved legs cannot be stored");
        }
    }
}

impl LegCache {
    /// The legs of a store, reached from threads outside of the runtime.
    pub(crate) fn new(store: Store, runtime: Handle, metrics: Arc<JobMetrics>) -> Self {
        Self {
            unwritten: Unwritten {
                store: store.clone(),
                legs: Arc::default(),
            },
            store,
            runtime,
            metrics,
        }
    }

    /// The legs that are not in the database yet.
    pub(crate) fn unwritten(&self) -> Unwritten {
        self.unwritten.clone()
    }
}

impl LegStore for LegCache {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        let found = self.runtime.block_on(self.store.known_leg(identity));
        let leg = found.unwrap_or_else(|error| {
            tracing::warn!(%error, "a leg cannot be looked up and is solved again");
            None
        });
        self.metrics.looked_up(std::slice::from_ref(&leg));
        leg
    }

    fn times(&self, identities: &[&str]) -> Vec<Option<StoredTime>> {
        let times = self.runtime.block_on(async {
            // What was solved a moment ago shall be found.
            self.unwritten.write().await;
            self.store.leg_snapshot().await?.times(identities).await
        });
        let times = times.unwrap_or_else(|error| {
            tracing::warn!(%error, "legs cannot be looked up");
            vec![None; identities.len()]
        });
        self.metrics.looked_up(&times);
        times
    }

    fn put(&self, identity: &str, leg: &StoredLeg) {
        self.metrics.leg_solved();
        let waiting = {
            let mut unwritten = self.unwritten.legs();
            unwritten.push(NewLeg {
                identity: identity.to_owned(),
                leg: leg.clone(),
            });
            unwritten.len()
        };
        if waiting >= BATCH {
            self.runtime.block_on(self.unwritten.write());
        }
    }
}

impl Drop for LegCache {
    fn drop(&mut self) {
        self.runtime.block_on(self.unwritten.write());
    }
}
