//! Plans that were read lately. They are found by the hash of their content, so that what is kept
//! here can never be out of date, and they were found intact when they were read.

use bytes::Bytes;
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// All of them together, and the largest one, bytes.
const MOST: usize = 16 << 20;
const LARGEST: usize = MOST / 8;

/// Plans by their hash; the oldest make room.
#[derive(Debug, Clone, Default)]
pub(super) struct Recent(Arc<Mutex<Shelf>>);

#[derive(Debug, Default)]
struct Shelf {
    plans: HashMap<String, Bytes>,
    /// Hashes, the oldest first.
    order: VecDeque<String>,
    bytes: usize,
}

impl Recent {
    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The plan with a hash.
    pub(super) fn get(&self, digest: &str) -> Option<Bytes> {
        self.shelf().plans.get(digest).cloned()
    }

    /// Keeps a plan that has this hash.
    pub(super) fn keep(&self, digest: &str, plan: &Bytes) {
        if plan.len() > LARGEST {
            return;
        }
        let mut shelf = self.shelf();
        if shelf
            .plans
            .insert(digest.to_owned(), plan.clone())
            .is_some()
        {
            return;
        }
        shelf.order.push_back(digest.to_owned());
        shelf.bytes += plan.len();
        while shelf.bytes > MOST {
            let oldest = shelf.order.pop_front();
            let Some(plan) = oldest.and_then(|digest| shelf.plans.remove(&digest)) else {
                return;
            };
            shelf.bytes -= plan.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_make_room_and_the_largest_are_not_kept() {
        let recent = Recent::default();
        let plan = Bytes::from(vec![0; LARGEST]);
        for number in 0..9 {
            recent.keep(&number.to_string(), &plan);
        }
        // Another time is no other plan.
        recent.keep("8", &plan);
        let kept = |name: &str| recent.get(name).is_some();
        assert!(!kept("0") && kept("1") && kept("8"));
        recent.keep("huge", &Bytes::from(vec![0; LARGEST + 1]));
        assert!(!kept("huge") && kept("1"));
        assert_eq!(recent.shelf().bytes, MOST);
    }
}
