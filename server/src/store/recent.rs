//! A cache of recently read plans.
//!
//! They are looked up by the hash of their content, so that no entry can be out of date; their hashes
//! were checked when they were read.

use bytes::Bytes;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Maximum size of all cached plans together, and of a single one, bytes.
const MAX_BYTES: usize = 16 << 20;
const MAX_PLAN_BYTES: usize = MAX_BYTES / 8;

/// Plans by their hash; the oldest are evicted first.
#[derive(Debug, Clone, Default)]
pub(super) struct RecentPlans(Arc<Mutex<CachedPlans>>);

#[derive(Debug, Default)]
struct CachedPlans {
    plans: HashMap<String, Bytes>,
    /// Hashes, the oldest first.
    order: VecDeque<String>,
    bytes: usize,
}

impl RecentPlans {
    fn lock(&self) -> MutexGuard<'_, CachedPlans> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The plan with a hash.
    pub(super) fn get(&self, digest: &str) -> Option<Bytes> {
        self.lock().plans.get(digest).cloned()
    }

    /// Caches a plan under its hash.
    pub(super) fn keep(&self, digest: &str, plan: &Bytes) {
        if plan.len() > MAX_PLAN_BYTES {
            return;
        }
        let mut cached = self.lock();
        if cached
            .plans
            .insert(digest.to_owned(), plan.clone())
            .is_some()
        {
            return;
        }
        cached.order.push_back(digest.to_owned());
        cached.bytes += plan.len();
        while cached.bytes > MAX_BYTES {
            let oldest = cached.order.pop_front();
            let Some(plan) = oldest.and_then(|digest| cached.plans.remove(&digest)) else {
                return;
            };
            cached.bytes -= plan.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_plans_are_evicted_and_oversized_ones_are_not_cached() {
        let recent = RecentPlans::default();
        let plan = Bytes::from(vec![0; MAX_PLAN_BYTES]);
        for number in 0..9 {
            recent.keep(&number.to_string(), &plan);
        }
        // The same plan again takes no more room.
        recent.keep("8", &plan);
        let kept = |name: &str| recent.get(name).is_some();
        assert!(!kept("0") && kept("1") && kept("8"));
        recent.keep("huge", &Bytes::from(vec![0; MAX_PLAN_BYTES + 1]));
        assert!(!kept("huge") && kept("1"));
        assert_eq!(recent.lock().bytes, MAX_BYTES);
    }
}
