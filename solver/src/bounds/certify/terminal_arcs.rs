//! The terminal arcs with which a sequence reaches its target, as functions of its interior.
//!
//! With half durations `a`, `b` of the terminal arcs and the interior `P`,
//!
//! ```text
//!   <q, exp(2 a c_0) P exp(2 b c_f)> = x_1 cos S + y_1 sin S + x_2 cos U + y_2 sin U,
//!   S = a + b,  U = a - b
//! ```
//!
//! whose absolute value has to be one. The lengths `C_1` and `C_2` of `(x_1, y_1)` and `(x_2, y_2)`
//! add up to one at most (it is the largest value of a scalar product of unit quaternions). Where
//! the interior is known within a turn of `eta` the sum must reach `cos(eta / 2) >= 1 - eta^2 / 8`,
//! so `C_1 (1 - cos(S - s)) + C_2 (1 - cos(U - u)) <= eta^2 / 8 - (1 - C_1 - C_2)` with the angles
//! `s`, `u` of the two vectors, both shifted by half a turn for the other sign of `q`.

use super::rates::Rates;
use super::sequence::{ArcSequence, Moving};
use super::turn::{QuatInterval, VectorInterval, dot, dot4, product, rotate, times_vector};
use crate::bounds::interval::{Interval, twice_asin_of_root};
use std::f64::consts::PI;

/// Distance from half a turn, rad, within which a half duration is replaced by zero.
const LEFT_OUT: f64 = 1e-3;

/// The equation of a sequence for a target.
#[derive(Debug)]
pub(super) struct TargetView {
    /// `q`, `-c_0 q`, `-q c_f`, `c_0 q c_f`: their scalar products with `P` make up the equation.
    images: [QuatInterval; 4],
    /// `c_0` and `c_f`.
    pub(super) ends: [VectorInterval; 2],
    /// `c_0 . R c_f`, which `c_0 . P c_f` must equal.
    target: Interval,
}

/// Half durations of the terminal arcs that may close a sequence, enclosed.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnclosedTerminalArcs {
    /// `S` and `U`, each modulo a full turn and both together modulo half a turn.
    sum: Interval,
    difference: Interval,
}

/// Limits of the terminal arcs, in half durations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowed {
    /// Largest value of each.
    pub(super) each: f64,
    /// Strict upper bound on the sum of both.
    pub(super) both: f64,
}

impl TargetView {
    pub(super) fn new(rates: &Rates, q: &QuatInterval, sequence: &ArcSequence) -> Self {
        let ends = [sequence.first, sequence.last].map(|octant| rates.corner(octant));
        let [x, y, z] = ends[0];
        let begun = product(&[-x, -y, -z, Interval::ZERO], q);
        let ended = times_vector(q, &ends[1].map(|c| -c));
        let both = times_vector(&begun, &ends[1].map(|c| -c));
        Self {
            images: [*q, begun, ended, both],
            target: dot(&ends[0], &rotate(q, &ends[1])),
            ends,
        }
    }

    /// Whether `c_0 . P c_f` is proved to differ from the target's value over a cell about `P`.
    pub(super) fn misses(&self, interior: &Moving, half: Interval, curvature: Interval) -> bool {
        // P c_f P* and its derivative, twice the vector part of P' c_f P*.
        let [x, y, z, w] = times_vector(&interior.turn, &self.ends[1]);
        let back = [x, y, z, -w];
        let along = |q: &QuatInterval| {
            let [x, y, z, _] = product(q, &back);
            dot(&self.ends[0], &[x, y, z])
        };
        let value = along(&interior.turn) - self.target;
        let slope = along(&interior.slope).twice();
        value.abs().low > (slope.abs() * half + curvature).high
    }

    /// The terminal arcs for an interior that is known within a turn of `eta`; `None` when no
    /// terminal arcs reach the target.
    pub(super) fn terminal_arcs(
        &self,
        interior: &QuatInterval,
        eta: Interval,
    ) -> Option<EnclosedTerminalArcs> {
        let [plain, begun, ended, both] = self.images.map(|image| dot4(&image, interior));
        let one = [(plain - both).half(), (begun + ended).half()];
        let two = [(plain + both).half(), (begun - ended).half()];
        let lengths = [one, two].map(|[x, y]| x.length(y));
        let missing = (Interval::ONE - lengths[0] - lengths[1]).low.max(0.0);
        let excess = (eta.squared() * Interval::exactly(0.125)).high - missing;
        if excess.next_up() < 0.0 {
            return None;
        }
        let excess = Interval::exactly(excess.next_up());
        let [sum, difference] = [(one, lengths[0]), (two, lengths[1])].map(|([x, y], length)| {
            let angle = Interval::angle(y, x);
            let spread = if length.low > 0.0 {
                twice_asin_of_root((excess / length.twice()).high)
            } else {
                Interval::PI.high
            };
            Interval {
                low: (angle.low - spread).next_down(),
                high: (angle.high + spread).next_up(),
            }
        });
        Some(EnclosedTerminalArcs { sum, difference })
    }
}

impl EnclosedTerminalArcs {
    /// Whether no terminal arcs within these limits close the sequence.
    pub(super) fn impossible(&self, allowed: Allowed) -> bool {
        let first = (self.sum + self.difference).half();
        let last = (self.sum - self.difference).half();
        // Each half duration is known modulo half a turn.
        shifts(first, allowed.each).all(|k| {
            shifts(last, allowed.each).all(|l| {
                let shifted = |x: Interval, turns: f64| x + Interval::PI * Interval::exactly(turns);
                let (a, b) = (shifted(first, k), shifted(last, l));
                let sum = shifted(self.sum, k + l);
                let apart = shifted(self.difference, k - l).abs();
                let by_parts =
                    Interval::exactly(a.low.max(0.0)) + Interval::exactly(b.low.max(0.0));
                let least = sum.low.max(by_parts.low).max(apart.low);
                least >= allowed.both || least > sum.high
            })
        })
    }

    /// Approximate durations of terminal arcs that close the sequence, without error bounds.
    pub(super) fn candidate(&self) -> [f64; 2] {
        let (sum, difference) = (self.sum.middle(), self.difference.middle());
        [sum + difference, sum - difference].map(|twice| {
            let x = (0.5 * twice).rem_euclid(PI);
            // An arc near half a turn is replaced by none.
            if x > PI - LEFT_OUT { 0.0 } else { 2.0 * x }
        })
    }
}

/// Numbers of half turns whose addition may bring an angle into `[0, max]`.
fn shifts(angle: Interval, max: f64) -> impl Iterator<Item = f64> {
    let slack = 1e-9;
    let from = (-angle.high / Interval::PI.low - slack).ceil();
    let to = ((max - angle.low) / Interval::PI.low + slack).floor();
    std::iter::successors(Some(from), |k| Some(k + 1.0)).take_while(move |k| *k <= to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turns_at_the_ends_of_the_range_are_among_the_shifts() {
        let all = |angle: f64, max: f64| shifts(Interval::exactly(angle), max).collect::<Vec<_>>();
        assert_eq!(all(0.0, 1.0), [0.0]);
        assert_eq!(all(0.0, PI), [0.0, 1.0]);
        assert_eq!(all(-PI, 1.0), [1.0]);
        assert_eq!(all(0.5, 0.4), Vec::<f64>::new());
    }
}
