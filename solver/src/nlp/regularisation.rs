//! How much of the identity is added to a system that is not convex, or not convex enough.

/// First multiple tried, its growth, the fraction that is tried after a success, and where to
/// give up.
const FIRST: f64 = 1e-4;
const GROWTH: f64 = 8.0;
const DECAY: f64 = 1.0 / 3.0;
const LEAST: f64 = 1e-8;
const MOST: f64 = 1e12;
/// A step this much shorter than the longest possible was too bold: the quadratic model does not
/// hold that far along its flattest directions.
const TOO_SHORT: f64 = 0.1;
/// Floor after the first such step, its most, and where a decaying floor ends.
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
    /// The multiple to begin an iteration with; usually none.
    pub(super) fn first(&self) -> f64 {
        self.floor
    }

    /// The next one after a system was not convex with `delta`; none when it is no use.
    pub(super) fn next(&self, delta: f64) -> Option<f64> {
        let next = if delta > 0.0 {
            delta * GROWTH
        } else if self.last > 0.0 {
            (self.last * DECAY).max(LEAST)
        } else {
            FIRST
        };
        (next <= MOST).then_some(next)
    }

    /// Remembers what made a system convex.
    pub(super) fn succeeded(&mut self, delta: f64) {
        if delta > 0.0 {
            self.last = delta;
        }
    }

    /// Learns from the share of the longest possible step that was taken.
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
