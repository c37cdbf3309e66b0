//! The leg cache: the solver's view of the legs in the database.

pub(crate) mod upkeep;

use crate::base::clock::now_us;
use crate::jobs::metrics::JobMetrics;
use crate::jobs::shards::ShardOffer;
use crate::store::{NewLeg, Store, StoreError};
use slewplan_solver::tour::legs::{LegKind, LegStore, StoredLeg, StoredTime};
use slewplan_solver::tour::order::Place;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;

/// Number of legs that are looked up or written at once.
pub(super) const BATCH: usize = 64;
/// Number of legs that are looked up at once while others solve some of them.
const SHARED_BATCH: usize = 8;
/// Time after which a database that was away is asked again.
const AWAY: Duration = Duration::from_secs(5);
/// Maximum number of legs that wait for it, some 16 MB.
const MAX_KEPT: usize = 4096;
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
    offer: Option<ShardOffer>,
}

/// Solved legs that are not in the database yet.
#[derive(Debug, Clone)]
pub(crate) struct Unwritten {
    store: Store,
    legs: Arc<Mutex<Vec<NewLeg>>>,
    /// Held while legs are on their way, so that whoever has them written waits for them.
    writing: Arc<tokio::sync::Mutex<()>>,
    /// Until when a database that was away is not asked again: every question takes seconds then, and
    /// the solve shall go on.
    away_until: Arc<Mutex<Option<Instant>>>,
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
        if self.is_away() {
            return;
        }
        let _writing = self.writing.lock().await;
        let legs = std::mem::take(&mut *self.legs());
        if legs.is_empty() {
            return;
        }
        // Not an error of the job: a lost leg is solved again.
        if let Err(error) = self.store.put_legs(&legs, now_us()).await {
            tracing::warn!(%error, legs = legs.len(), "solved legs cannot be stored");
            self.note(&error);
            self.keep(legs, &error);
        }
    }

    /// Takes them, to be stored with the end of their job; writes them where there are many. The solve has
    /// ended.
    pub(super) async fn take(&self) -> Vec<NewLeg> {
        if self.legs().len() > BATCH {
            self.write().await;
        }
        let _writing = self.writing.lock().await;
        std::mem::take(&mut *self.legs())
    }

    /// Whether the database was away a moment ago.
    fn is_away(&self) -> bool {
        let until = *self
            .away_until
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        until.is_some_and(|until| Instant::now() < until)
    }

    /// Notes that the database is away, if the error says so.
    fn note(&self, error: &StoreError) {
        if error.is_away() {
            let until = Instant::now() + AWAY;
            *self
                .away_until
                .lock()
                .unwrap_or_else(PoisonError::into_inner) = Some(until);
        }
    }

    /// Keeps legs for when the database is back.
    fn keep(&self, mut legs: Vec<NewLeg>, error: &StoreError) {
        let mut unwritten = self.legs();
        if error.is_away() && unwritten.len() + legs.len() <= MAX_KEPT {
            unwritten.append(&mut legs);
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
                writing: Arc::default(),
                away_until: Arc::default(),
            },
            store,
            runtime,
            metrics,
            offer: None,
        }
    }

    /// The same with parts of large tables offered to others.
    pub(super) fn offering(self, offer: Option<ShardOffer>) -> Self {
        let mut cache = self;
        cache.offer = offer;
        cache
    }

    /// The legs that are not in the database yet.
    pub(crate) fn unwritten(&self) -> Unwritten {
        self.unwritten.clone()
    }
}

impl LegStore for LegCache {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        self.get_all(&[identity]).pop()?
    }

    fn get_all(&self, identities: &[&str]) -> Vec<Option<StoredLeg>> {
        if self.unwritten.is_away() {
            return vec![None; identities.len()];
        }
        let found = self.runtime.block_on(self.store.known_legs(identities));
        let legs = found.unwrap_or_else(|error| {
            tracing::warn!(%error, "legs cannot be looked up and are solved again");
            self.unwritten.note(&error);
            vec![None; identities.len()]
        });
        self.metrics.looked_up(&legs);
        legs
    }

    fn batch(&self) -> usize {
        match &self.offer {
            // What others have just solved shall be found.
            Some(offer) if offer.has_offered() => SHARED_BATCH,
            _ => BATCH,
        }
    }

    fn is_shared(&self) -> bool {
        self.offer.is_some()
    }

    fn offer(&self, kind: LegKind, pairs: &[(Place, Place)]) {
        if let Some(offer) = &self.offer {
            self.runtime.block_on(offer.offer(kind, pairs));
        }
    }

    fn times(&self, identities: &[&str]) -> Vec<Option<StoredTime>> {
        if self.unwritten.is_away() {
            return vec![None; identities.len()];
        }
        let times = self.runtime.block_on(async {
            // What was solved a moment ago shall be found.
            self.unwritten.write().await;
            self.store.leg_snapshot().await?.times(identities).await
        });
        let times = times.unwrap_or_else(|error| {
            tracing::warn!(%error, "legs cannot be looked up");
            self.unwritten.note(&error);
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
