//! Solved segments of tours, remembered within bounds.
//!
//! Two generations: when the younger one is full it becomes the older one, whose segments are
//! forgotten unless they were asked for meanwhile. What is forgotten is solved again when it is
//! needed, with the same result.

use crate::multiphase::Flown;
use crate::sequence::Place;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Intervals of the motions of a generation. An interval with three wheels takes some 150 bytes, so
/// both generations together take 100 MB at most, whatever the number of targets: 40 000 segments of
/// eight legs, 1 700 tours of two hundred.
const GENERATION: usize = 1 << 18;

/// Flights by their places.
type Generation = HashMap<Vec<Place>, Arc<Flown>>;

#[derive(Default)]
struct Generations {
    young: Generation,
    old: Generation,
    /// Intervals of the young ones.
    intervals: usize,
}

/// The memory of a search.
#[derive(Default)]
pub(super) struct Segments(Mutex<Generations>);

impl Segments {
    /// The flight through some places, when it is remembered.
    pub(super) fn get(&self, route: &[Place]) -> Option<Arc<Flown>> {
        let mut generations = self.lock();
        if let Some(flown) = generations.young.get(route) {
            return Some(Arc::clone(flown));
        }
        let (route, flown) = generations.old.remove_entry(route)?;
        generations.insert(route, Arc::clone(&flown));
        Some(flown)
    }

    /// Remembers a flight.
    pub(super) fn put(&self, route: &[Place], flown: &Arc<Flown>) {
        self.lock().insert(route.to_vec(), Arc::clone(flown));
    }

    fn lock(&self) -> MutexGuard<'_, Generations> {
        // Whoever panicked has left the maps whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Generations {
    fn insert(&mut self, route: Vec<Place>, flown: Arc<Flown>) {
        if self.intervals >= GENERATION {
            self.old = std::mem::take(&mut self.young);
            self.intervals = 0;
        }
        self.intervals += flown.profile.intervals();
        self.young.insert(route, flown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attitude::Attitude;
    use crate::profile::Profile;
    use nalgebra::DVector;

    #[test]
    fn what_is_asked_for_stays_and_what_is_not_is_forgotten() {
        let length = GENERATION / 4;
        let motion = Profile::standstill(Attitude::identity(), DVector::zeros(3), length);
        let flown = Arc::new(Flown {
            profile: motion,
            ..Flown::nowhere()
        });
        let segments = Segments::default();
        let route = |i| [Place::Start, Place::Target(i)];
        for i in 0..16 {
            segments.put(&route(i), &flown);
            assert!(segments.get(&route(0)).is_some());
        }
        assert!(segments.get(&route(1)).is_none());
        assert!(segments.get(&route(15)).is_some());
        let generations = segments.lock();
        assert!(generations.young.len() + generations.old.len() <= 9);
    }
}
