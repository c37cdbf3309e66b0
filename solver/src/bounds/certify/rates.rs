//! The box of rates, scaled so that its corners have length one.

use super::turn::{QuatInterval, VectorInterval, angle_of};
use crate::bounds::interval::Interval;
use nalgebra::Vector3;

/// Relative difference by which each rate exceeds the next smaller one; closer rates are raised.
/// Then no two saddles of the costate are on one level. Times only fall, by less than the margin of
/// certificates.
const APART: f64 = 2e-7;

/// Signs of the rates on an arc.
pub(super) type Octant = [bool; 3];

/// All octants; `true` is a negative rate.
pub(super) fn octants() -> impl Iterator<Item = Octant> {
    (0..8_usize).map(|bits| [0, 1, 2].map(|i| bits >> i & 1 == 1))
}

/// The octant with the sign of one axis changed.
pub(super) fn flipped(mut octant: Octant, axis: usize) -> Octant {
    octant[axis] = !octant[axis];
    octant
}

/// A box of rates.
#[derive(Debug, Clone)]
pub(super) struct Rates {
    /// Rates divided by the norm of their vector.
    pub(super) c: VectorInterval,
    /// That norm, rad/s.
    pub(super) speed: Interval,
    /// Upper bound on the ratio of the raised rates to the given ones.
    pub(super) stretch: f64,
}

impl Rates {
    /// A box that contains the given rates; `None` unless they are positive and finite.
    pub(super) fn around(given: &Vector3<f64>) -> Option<Self> {
        if !given.iter().all(|rate| rate.is_finite() && *rate > 0.0) {
            return None;
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| given[i].total_cmp(&given[j]));
        let mut rates = *given;
        for pair in order.windows(2) {
            rates[pair[1]] = rates[pair[1]].max(rates[pair[0]] * (1.0 + APART));
        }
        let r = [0, 1, 2].map(|i| Interval::exactly(rates[i]));
        let speed = r[0].length(r[1]).length(r[2]);
        Some(Self {
            c: r.map(|rate| rate / speed),
            speed,
            stretch: rates.component_div(given).max().next_up(),
        })
    }

    /// The rate vector of an octant.
    pub(super) fn corner(&self, octant: Octant) -> VectorInterval {
        [0, 1, 2].map(|i| if octant[i] { -self.c[i] } else { self.c[i] })
    }

    /// The least of the rates.
    pub(super) fn least(&self) -> f64 {
        self.c.iter().fold(1.0, |least, c| f64::min(least, c.low))
    }

    /// Upper bound on the time of a turn about its own axis: `max |x_i| / c_i` for the rotation
    /// vector `x`.
    pub(super) fn eigenaxis(&self, q: &QuatInterval) -> f64 {
        let angle = angle_of(q);
        let length = q[0].length(q[1]).length(q[2]);
        if length.low <= 0.0 {
            return (angle / Interval::exactly(self.least())).high;
        }
        (0..3).fold(0.0, |largest, i| {
            let share = q[i].abs() / length;
            f64::max(largest, (share * angle / self.c[i]).high)
        })
    }
}
