//! What the store has of a list of legs: looked up some at once, and the rest offered to others.

use super::canonical::CanonicalLeg;
use crate::tour::legs::{LegKind, LegStore, StoredLeg};
use crate::tour::order::Place;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Offers those of the missing legs to others that are not stored. The number of each is that of its pair.
pub(super) fn offer(
    store: &dyn LegStore,
    kind: LegKind,
    pairs: &[(Place, Place)],
    missing: &[(usize, &CanonicalLeg)],
) {
    let identities: Vec<_> = missing.iter().map(|(_, leg)| &*leg.identity).collect();
    let times = store.times(&identities);
    let unsolved = missing.iter().zip(times).filter(|(_, time)| time.is_none());
    let unsolved: Vec<_> = unsolved.map(|((pair, _), _)| pairs[*pair]).collect();
    store.offer(kind, &unsolved);
}

/// The stored legs of a list. A leg that is stored after the others of its batch were looked up is not
/// found: it is solved again, with the same result.
pub(super) struct LegsAhead<'a> {
    store: &'a dyn LegStore,
    batches: Vec<Batch<'a>>,
    batch: usize,
}

struct Batch<'a> {
    identities: Vec<&'a str>,
    /// In their order, each until it is taken.
    found: OnceLock<Vec<Mutex<Option<StoredLeg>>>>,
}

impl<'a> LegsAhead<'a> {
    /// The legs of a list, of which none is looked up yet.
    pub(super) fn new(store: &'a dyn LegStore, legs: &[&'a CanonicalLeg]) -> Self {
        let batch = store.batch().max(1);
        let batches = legs.chunks(batch).map(|legs| Batch {
            identities: legs.iter().map(|leg| leg.identity.as_str()).collect(),
            found: OnceLock::new(),
        });
        Self {
            store,
            batches: batches.collect(),
            batch,
        }
    }

    /// The leg at a place of the list, if it is stored. It is given once.
    pub(super) fn take(&self, place: usize) -> Option<StoredLeg> {
        let batch = self.batches.get(place / self.batch)?;
        let found = batch.found.get_or_init(|| {
            let found = self.store.get_all(&batch.identities);
            found.into_iter().map(Mutex::new).collect()
        });
        let leg = found.get(place % self.batch)?.lock();
        leg.unwrap_or_else(PoisonError::into_inner).take()
    }
}
