//! A cache of solved segments in bounded memory.
//!
//! The same route is solved differently as a beginning, a piece or a whole tour, and the solutions
//! may differ. The key holds both, so that a result never depends on earlier look-ups.
//!
//! The cache has two generations. When the young one is full it becomes the old one, and the
//! segments of the previous old generation are dropped; a look-up moves a segment to the young
//! generation. A dropped segment is solved again when it is needed, with the same result.

use super::segment_key::SegmentKey;
use crate::leg::multiphase::LegSolution;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Intervals of the motions of one generation. An interval with three wheels takes some 150 bytes,
/// so that both generations together take at most 100 MB, whatever the number of targets: 40 000
/// segments of eight legs, or 1 700 tours of two hundred.
const MAX_GENERATION_INTERVALS: usize = 1 << 18;

/// Solutions by the keys of their segments.
type Generation = HashMap<SegmentKey, Arc<LegSolution>>;

#[derive(Default)]
struct Generations {
    young: Generation,
    old: Generation,
    /// Intervals of the motions in `young`.
    intervals: usize,
}

/// The solved segments of one search.
#[derive(Default)]
pub(super) struct SolvedSegments(Mutex<Generations>);

impl SolvedSegments {
    /// The solution of a segment, when the cache holds it.
    pub(super) fn get(&self, segment: &SegmentKey) -> Option<Arc<LegSolution>> {
        let mut generations = self.lock();
        if let Some(solution) = generations.young.get(segment) {
            return Some(Arc::clone(solution));
        }
        let (segment, solution) = generations.old.remove_entry(segment)?;
        generations.insert(segment, Arc::clone(&solution));
        Some(solution)
    }

    /// Adds a solution.
    pub(super) fn put(&self, segment: SegmentKey, solution: &Arc<LegSolution>) {
        self.lock().insert(segment, Arc::clone(solution));
    }

    fn lock(&self) -> MutexGuard<'_, Generations> {
        // A panic under the lock leaves the maps consistent.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Generations {
    fn insert(&mut self, segment: SegmentKey, solution: Arc<LegSolution>) {
        if self.intervals >= MAX_GENERATION_INTERVALS {
            self.old = std::mem::take(&mut self.young);
            self.intervals = 0;
        }
        self.intervals += solution.profile.intervals();
        self.young.insert(segment, solution);
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
    fn segments_that_are_looked_up_stay_and_others_are_dropped() {
        let length = MAX_GENERATION_INTERVALS / 4;
        let motion = Profile::zero_length(Attitude::identity(), DVector::zeros(3), length);
        let solution = Arc::new(LegSolution {
            profile: motion,
            ..LegSolution::nowhere()
        });
        let segments = SolvedSegments::default();
        let segment = |i| SegmentKey::new(&[Place::Start, Place::Target(i)], SegmentKind::Piece);
        for i in 0..16 {
            segments.put(segment(i), &solution);
            assert!(segments.get(&segment(0)).is_some());
        }
        assert!(segments.get(&segment(1)).is_none());
        assert!(segments.get(&segment(15)).is_some());
        let generations = segments.lock();
        assert!(generations.young.len() + generations.old.len() <= 9);
    }
}
