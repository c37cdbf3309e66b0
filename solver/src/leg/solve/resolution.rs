//! How finely legs are solved: the number of intervals.

use crate::math::rounding::parts_of;
use crate::model::dynamics::Dynamics;
use crate::model::spec::Accuracy;

/// How finely legs are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Resolution {
    /// Intervals of a leg.
    pub(crate) intervals: usize,
    /// Whether solutions are freed of the penalty on uneven interval lengths.
    pub(crate) polished: bool,
}

impl Resolution {
    /// The resolution of an accuracy.
    pub(crate) fn of(accuracy: Accuracy, dynamics: &Dynamics) -> Self {
        let for_momentum = if dynamics.has_momentum() {
            WITH_MOMENTUM
        } else {
            0
        };
        let usual = MIN_INTERVALS + PER_SPARE_WHEEL * (dynamics.wheel_count() - 3) + for_momentum;
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

    /// Intervals of a leg that turns by an angle, rad. Torque is constant on an interval while the
    /// stored momentum turns in body axes, so a rate on its limit strays from it: more intervals
    /// where that counts.
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

/// Intervals of a leg with three wheels and without momentum: more of them shorten legs by less
/// than 1e-4 of the duration.
const MIN_INTERVALS: usize = 12;
/// Further intervals for every further wheel, which switches at times of its own, and for stored
/// momentum, which turns in body axes while the torque of an interval does not.
const PER_SPARE_WHEEL: usize = 4;
const WITH_MOMENTUM: usize = 6;
/// How far a rate on its limit may stray from it on an interval, relative. The program keeps it as
/// a reserve, of which at most a third is lost.
const MAX_STRAY: f64 = 1.1e-2;
/// Angle of the fastest motion relative to that about the eigenaxis, approximately.
pub(super) const DETOUR: f64 = 1.3;
/// Most intervals added for rate limits. Momentum that would need more is handled by reserves.
const MAX_ALONG_LIMITS: usize = 240;
