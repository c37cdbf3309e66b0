//! Solved segments of tours, remembered within bounds.
//!
//! A route is solved in different ways as a part of different things, and the answers may differ, so
//! a segment is both: what is found does not depend on what was asked for before.
//!
//! Two generations: when the younger one is full it becomes the older one, whose segments are
//! forgotten unless they were asked for meanwhile. What is forgotten is solved again when it is
//! needed, with the same result.

use super::segment_key::SegmentKey;
use crate::leg::multiphase::LegSolution;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Intervals of the motions of a generation. An interval with three wheels takes some 150 bytes, so
/// both generations together take 100 MB at most, whatever the number of targets: 40 000 segments of
/// eight legs, 1 700 tours of two hundred.
const MAX_GENERATION_INTERVALS: usize = 1 << 18;

/// Flights by their segments.
type Generation = HashMap<SegmentKey, Arc<LegSolution>>;

#[derive(Default)]
struct Generations {
    young: Generation,
    old: Generation,
    /// Intervals of the young ones.
    intervals: usize,
}

/// The memory of a search.
#[derive(Default)]
pub(super) struct SegmentCache(Mutex<Generations>);

impl SegmentCache {
    /// The flight of a segment, when it is remembered.
    pub(super) fn get(&self, segment: &SegmentKey) -> Option<Arc<LegSolution>> {
        let mut generations = self.lock();
        if let Some(flown) = generations.young.get(segment) {
            return Some(Arc::clone(flown));
        }
        let (segment, flown) = generations.old.remove_entry(segment)?;
        generations.insert(segment, Arc::clone(&flown));
        Some(flown)
    }

    /// Remembers a flight.
    pub(super) fn put(&self, segment: SegmentKey, flown: &Arc<LegSolution>) {
        self.lock().insert(segment, Arc::clone(flown));
    }

    fn lock(&self) -> MutexGuard<'_, Generations> {
        // Whoever panicked has left the maps whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Generations {
    fn insert(&mut self, segment: SegmentKey, flown: Arc<LegSolution>) {
        if self.intervals >= MAX_GENERATION_INTERVALS {
            self.old = std::mem::take(&mut self.young);
            self.intervals = 0;
        }
        self.intervals += flown.profile.intervals();
        self.young.insert(segment, flown);
    }
}

#[cfg(test)]
mod tests {
    use super::super::segment_key::SegmentKind;
    use super::*;
    use crate::leg::profile::Profile;
    use crate::model::attitude::Attitude;
    use crate::tour::order::Place;
    use nalgebra::DVector;

    #[test]
    fn what_is_asked_for_stays_and_what_is_not_is_forgotten() {
        let length = MAX_GENERATION_INTERVALS / 4;
        let motion = Profile::zero_length(Attitude::identity(), DVector::zeros(3), length);
        let flown = Arc::new(LegSolution {
            profile: motion,
            ..LegSolution::nowhere()
        });
        let segments = SegmentCache::default();
        let segment = |i| SegmentKey::new(&[Place::Start, Place::Target(i)], SegmentKind::Piece);
        for i in 0..16 {
            segments.put(segment(i), &flown);
            assert!(segments.get(&segment(0)).is_some());
        }
        assert!(segments.get(&segment(1)).is_none());
        assert!(segments.get(&segment(15)).is_some());
        let generations = segments.lock();
        assert!(generations.young.len() + generations.old.len() <= 9);
    }
}
