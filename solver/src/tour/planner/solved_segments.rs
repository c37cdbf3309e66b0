//! A cache of solved segments in bounded memory.
//!
//! The same route is solved differently as a beginning, a piece or a whole tour, and the solutions
//! may differ. The key holds both, so that a result never depends on earlier look-ups.
//!
//! The cache has two generations. When the young one is full it becomes the old one, and the
//! segments of the previous old generation are dropped; a look-up moves a segment to the young
//! generation. A dropped segment is solved again when it is needed, with the same result.
//!
//! Motions are kept packed, the momenta of all nodes in one allocation, and are unpacked, digit for
//! digit, when they are looked up.

use super::segment_key::SegmentKey;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use nalgebra::DVector;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Intervals of the motions of one generation. An interval with three wheels takes 64 bytes, so that
/// both generations together take some 40 MB, whatever the number of targets: 40 000 segments of
/// eight legs, or 1 700 tours of two hundred.
const MAX_GENERATION_INTERVALS: usize = 1 << 18;

/// Solutions by the keys of their segments.
type Generation = HashMap<SegmentKey, PackedSolution>;

/// A solution with all numbers of its motion in three allocations.
struct PackedSolution {
    /// The solution without its motion.
    rest: LegSolution,
    attitudes: Box<[Attitude]>,
    /// Momenta of all wheels at the first node, then at the next.
    momenta: Box<[f64]>,
    lengths: Box<[f64]>,
}

impl PackedSolution {
    fn of(solution: &LegSolution) -> Self {
        let LegSolution {
            status,
            profile,
            intervals,
            iterations,
            infeasibility,
            costates,
        } = solution;
        Self {
            rest: LegSolution {
                status: *status,
                profile: Profile::empty(),
                intervals: intervals.clone(),
                iterations: *iterations,
                infeasibility: *infeasibility,
                costates: costates.clone(),
            },
            attitudes: profile.attitudes.as_slice().into(),
            momenta: profile.wheels.iter().flatten().copied().collect(),
            lengths: profile.lengths.as_slice().into(),
        }
    }

    fn unpacked(&self) -> LegSolution {
        let wheels = self.momenta.len() / self.attitudes.len().max(1);
        let nodes = self.momenta.chunks_exact(wheels.max(1));
        LegSolution {
            profile: Profile {
                attitudes: self.attitudes.to_vec(),
                wheels: nodes.map(DVector::from_column_slice).collect(),
                lengths: self.lengths.to_vec(),
            },
            ..self.rest.clone()
        }
    }
}

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
            return Some(Arc::new(solution.unpacked()));
        }
        let (segment, packed) = generations.old.remove_entry(segment)?;
        let solution = packed.unpacked();
        generations.insert(segment, packed);
        Some(Arc::new(solution))
    }

    /// Adds a solution.
    pub(super) fn put(&self, segment: SegmentKey, solution: &Arc<LegSolution>) {
        let packed = PackedSolution::of(solution);
        self.lock().insert(segment, packed);
    }

    fn lock(&self) -> MutexGuard<'_, Generations> {
        // A panic under the lock leaves the maps consistent.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Generations {
    fn insert(&mut self, segment: SegmentKey, solution: PackedSolution) {
        if self.intervals >= MAX_GENERATION_INTERVALS {
            self.old = std::mem::take(&mut self.young);
            self.intervals = 0;
        }
        self.intervals += solution.lengths.len();
        self.young.insert(segment, solution);
    }
}

#[cfg(test)]
mod tests {
    use super::super::segment_key::SegmentKind;
    use super::*;
    use crate::tour::order::Place;
    use nalgebra::Vector3;

    #[test]
    fn a_motion_is_the_same_when_it_is_unpacked() {
        let mut solution = LegSolution::nowhere();
        assert_eq!(
            PackedSolution::of(&solution).unpacked().profile,
            solution.profile
        );
        for wheels in [3, 5] {
            let node = |i: usize| DVector::from_fn(wheels, |wheel, _| 0.1 * (7 * i + wheel) as f64);
            let turned =
                |i: usize| Attitude::from_rotation_vector(Vector3::new(i as f64, 0.0, 0.3));
            solution.profile = Profile {
                attitudes: (0..4).map(turned).collect(),
                wheels: (0..4).map(node).collect(),
                lengths: vec![1.0, 1.0 / 3.0, 0.0],
            };
            solution.intervals = vec![2, 1];
            solution.costates = vec![node(9)];
            let unpacked = PackedSolution::of(&solution).unpacked();
            assert_eq!(unpacked.profile, solution.profile);
            assert_eq!(unpacked.intervals, solution.intervals);
            assert_eq!(unpacked.costates, solution.costates);
        }
    }

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
