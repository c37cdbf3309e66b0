//! Records the motions of the legs of a run.

use crate::documents::legs::KeyedLeg;
use crate::store::leg_key;
use slewplan_solver::tour::legs::{LegStore, StoredLeg};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A leg store that records the legs read from and written to another.
pub(super) struct Recorder<'a> {
    legs: &'a dyn LegStore,
    /// By their keys, which is the order of a file.
    seen: Mutex<BTreeMap<String, KeyedLeg>>,
}

impl<'a> Recorder<'a> {
    /// Records the legs of another store.
    pub(super) fn new(legs: &'a dyn LegStore) -> Self {
        Self {
            legs,
            seen: Mutex::default(),
        }
    }

    /// The recorded legs.
    pub(super) fn into_motions(self) -> Vec<KeyedLeg> {
        let seen = self.seen.into_inner();
        let seen = seen.unwrap_or_else(PoisonError::into_inner);
        seen.into_values().collect()
    }

    fn note(&self, identity: &str, leg: &StoredLeg) {
        let key = leg_key(identity);
        let known = KeyedLeg {
            key: key.clone(),
            motion: leg.motion.clone(),
            solve_time_s: leg.solve_time_s,
        };
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.insert(key, known);
    }
}

impl LegStore for Recorder<'_> {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        let leg = self.legs.get(identity)?;
        self.note(identity, &leg);
        Some(leg)
    }

    fn put(&self, identity: &str, leg: &StoredLeg) {
        self.legs.put(identity, leg);
        self.note(identity, leg);
    }
}
