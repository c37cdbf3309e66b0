//! How finely slews are solved: the number of intervals.

use crate::model::dynamics::Dynamics;
use crate::model::spec::Accuracy;

/// How finely slews are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Resolution {
    /// Intervals of a leg.
    pub(crate) intervals: usize,
    /// Whether solutions are freed of what draws interval lengths together.
    pub(crate) polished: bool,
}

impl Resolution {
    /// The resolution of an accuracy.
    pub(crate) fn of(accuracy: Accuracy, dynamics: &Dynamics) -> Self {
        let bent = if dynamics.has_momentum() {
            WITH_MOMENTUM
        } else {
            0
        };
        let usual = MIN_INTERVALS + PER_SPARE_WHEEL * (dynamics.wheel_count() - 3) + bent;
        match accuracy {
            Accuracy::Standard => Self {
                intervals: usual,
                polished: false,
            },
            Accuracy::Tight => Self {
                intervals: 2 * usual,
                polished: true,
            },
        }
    }

    /// Intervals of a leg that turns by an angle, rad: more where a rate on its limit would stray
    /// from it, under a torque that does not turn with the stored momentum.
    pub(crate) fn intervals_of(&self, dynamics: &Dynamics, turn: f64) -> usize {
        let stray = if self.polished {
            0.5 * MAX_STRAY
        } else {
            MAX_STRAY
        };
        let longest = (8.0 * stray / dynamics.straying()).sqrt();
        self.intervals + parts_of(DETOUR * turn, longest, MAX_ALONG_LIMITS)
    }
}

/// Into how many parts a turn is cut, none longer than this; at most so many.
pub(super) fn parts_of(turn: f64, longest: f64, most: usize) -> usize {
    if longest == f64::INFINITY {
        return 0;
    }
    let enough = |parts: &usize| *parts as f64 * longest >= turn - SAME_TURN;
    (0..most).find(enough).unwrap_or(most)
}

/// Intervals of a leg with three wheels and without momentum: with more the measured durations of
/// 171 legs gain less than 1e-4.
const MIN_INTERVALS: usize = 12;
/// Further intervals for every further wheel, which switches at times of its own, and for stored
/// momentum, which turns in the body while the torque of an interval does not. Of 90
/// legs of the random suite with wheels to spare and without momentum, two per wheel leave two 0.11
/// and 0.24 % above the tight durations, four leave none more than 0.03 %.
const PER_SPARE_WHEEL: usize = 4;
const WITH_MOMENTUM: usize = 6;
/// How far a rate on its limit may stray from it on an interval, relative: the program takes it off,
/// so that a third of it is lost at most.
const MAX_STRAY: f64 = 1.1e-2;
/// How much farther than about the eigenaxis the fastest slew turns, about.
pub(super) const DETOUR: f64 = 1.3;
/// Turn, rad, that rounding may add without adding a part.
const SAME_TURN: f64 = 1e-9;
/// Most intervals for rate limits; with more momentum than these resolve, limits are kept by reserves.
const MAX_ALONG_LIMITS: usize = 240;
