//! The multiple of the identity that is added to a system that is not convex, or almost not.

/// First multiple that is tried, and its growth while the system is not convex.
const FIRST: f64 = 1e-4;
const GROWTH: f64 = 8.0;
/// Fraction of the last successful multiple that the next iteration tries first.
const DECAY: f64 = 1.0 / 3.0;
/// Range of the multiples.
const MIN_DELTA: f64 = 1e-8;
const MAX_DELTA: f64 = 1e12;
/// After a step shorter than this share of the longest possible, the next system has a floor: the
/// quadratic model did not hold along its flattest directions.
const TOO_SHORT: f64 = 0.1;
/// The first floor, the largest one, and the one below which a decaying floor becomes zero.
const FIRST_FLOOR: f64 = 1e-3;
const MAX_FLOOR: f64 = 1.0;
const MIN_FLOOR: f64 = 1e-4;

/// The multiple of the identity, from iteration to iteration.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Regularisation {
    last: f64,
    floor: f64,
}

impl Regularisation {
    /// The first multiple of an iteration, usually zero.
    pub(super) fn first(&self) -> f64 {
        self.floor
    }

    /// The next multiple when the system was not convex with `delta`; `None` beyond the range.
    pub(super) fn next(&self, delta: f64) -> Option<f64> {
        let next = if delta > 0.0 {
            delta * GROWTH
        } else if self.last > 0.0 {
            (self.last * DECAY).max(MIN_DELTA)
        } else {
            FIRST
        };
        (next <= MAX_DELTA).then_some(next)
    }

    /// Stores the multiple that made a system convex.
    pub(super) fn succeeded(&mut self, delta: f64) {
        if delta > 0.0 {
            self.last = delta;
        }
    }

    /// Adapts the floor to the share of the longest possible step that was taken.
    pub(super) fn stepped(&mut self, share: f64) {
        self.floor = if share < TOO_SHORT {
            (self.floor.max(self.last) * GROWTH).clamp(FIRST_FLOOR, MAX_FLOOR)
        } else if self.floor > MIN_FLOOR {
            self.floor / GROWTH
        } else {
            0.0
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_grow_until_the_range_ends_and_restart_below_the_last_success() {
        let mut regularisation = Regularisation::default();
        assert!(regularisation.first().abs() == 0.0);
        let mut delta = regularisation.next(0.0).expect("within the range");
        assert!((delta - FIRST).abs() < f64::EPSILON);
        delta = regularisation.next(delta).expect("within the range");
        regularisation.succeeded(delta);
        let again = regularisation.next(0.0).expect("within the range");
        assert!((again - FIRST * GROWTH * DECAY).abs() < f64::EPSILON);
        assert_eq!(regularisation.next(MAX_DELTA), None);
    }

    #[test]
    fn short_steps_set_a_floor_that_long_ones_remove() {
        let mut regularisation = Regularisation::default();
        regularisation.stepped(0.01);
        assert!((regularisation.first() - FIRST_FLOOR).abs() < f64::EPSILON);
        regularisation.stepped(0.01);
        assert!(regularisation.first() > FIRST_FLOOR);
        while regularisation.first() > MIN_FLOOR {
            regularisation.stepped(1.0);
        }
        regularisation.stepped(1.0);
        assert!(regularisation.first().abs() == 0.0);
    }
}
