//! Bounds on legs by their canonical forms: legs that are alike are bounded once.

use super::canonical::{CanonicalLeg, missing_from};
use super::tables::CertifiedLeg;
use crate::run::pool::SolverPool;
use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The bounds that are known so far, by [`CanonicalLeg::key`].
#[derive(Debug, Default)]
pub(super) struct BoundsByForm(Mutex<HashMap<String, CertifiedLeg>>);

impl BoundsByForm {
    /// What is known of a leg.
    pub(super) fn known(&self, leg: &CanonicalLeg) -> Option<CertifiedLeg> {
        self.lock().get(leg.key()).copied()
    }

    /// The bounds of legs; `None` where there is no leg, and where `bound` has none. It gets the number of
    /// a leg in the list; `begin` gets how many legs have to be bounded.
    pub(super) fn of(
        &self,
        legs: &[Option<CanonicalLeg>],
        pool: &SolverPool,
        begin: impl FnOnce(usize),
        bound: impl Fn(usize, &CanonicalLeg) -> Option<CertifiedLeg> + Sync,
    ) -> Vec<Option<CertifiedLeg>> {
        let missing = missing_from(&self.lock(), legs);
        begin(missing.len());
        let bounds = pool.map(&missing, |(index, leg)| bound(*index, leg));
        let mut known = self.lock();
        for ((_, leg), bound) in missing.into_iter().zip(bounds) {
            if let Some(bound) = bound {
                known.insert(leg.key().to_owned(), bound);
            }
        }
        let entry = |leg: &Option<CanonicalLeg>| known.get(leg.as_ref()?.key()).copied();
        legs.iter().map(entry).collect()
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<String, CertifiedLeg>> {
        // A panic under the lock leaves the map consistent.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
