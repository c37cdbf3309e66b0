//! Sequences with many flips near a body axis, refuted all together.
//!
//! In a sequence whose axes `j`, `k` flip alternately, with arcs of duration `D`, the costate
//! (length one) has `M_j = 0` at one flip and `M_k = 0` a time `D` later. As
//! `m_k' = +-(m_i c_j - m_j c_i)` for the sizes `m`, with `s` a bound on `hypot(m_j, m_k)`
//! throughout, `|m_k'| <= max(c_j, s c_i)`. So `m_k` is at most this times the time until it
//! vanishes, and likewise `m_j` since it vanished; the sum of squares is largest at an end:
//!
//! ```text
//!   sin e <= D max(c_j, c_k, s c_i)     for the angle e of M from the axis +-e_i,
//! ```
//!
//! first with `s = 1`, then with the bound itself. As `A = R M` is fixed in space, the swing of `R`
//! away from the axis is at most `2 e`, and its twist about the axis changes at the rate
//!
//! ```text
//!   w_i + [w_k (q_0 v_j + v_i v_k) + w_j (v_i v_j - q_0 v_k)] / (q_0^2 + v_i^2),   q = (v, q_0),
//! ```
//!
//! whose second term, the *drift*, is at most `tan(swing / 2) hypot(w_j, w_k)` (Cauchy and
//! Schwarz). The bounds fall with `D`, so they also hold for all sequences of more flips and, in
//! the limit, for the turn about the axis alone.

use super::rates::Rates;
use super::turn::{QuatInterval, least_turn, of_numbers, swing, twist};
use crate::bounds::interval::Interval;
use nalgebra::Vector3;

/// Swing and twist of a target about one axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearAxis {
    /// Lower bound on the swing away from the axis, rad.
    swing: f64,
    /// Lower bounds on the twist in the positive and in the negative sense, in `[0, 2 pi)`, rad.
    twists: [f64; 2],
    axis: usize,
}

impl NearAxis {
    pub(super) fn new(q: &QuatInterval, axis: usize) -> Self {
        let along = of_numbers(&Vector3::ith(axis, 1.0));
        let twist = twist(q, &along);
        Self {
            swing: swing(q, &along).low,
            twists: [least_turn(twist), least_turn(-twist)],
            axis,
        }
    }

    /// Whether sequences whose interior arcs are no longer than `longest`, with a rate of the given
    /// sign about the axis, are proved to take at least `time`.
    pub(super) fn proved(&self, rates: &Rates, longest: f64, negative: bool, time: f64) -> bool {
        let c = &rates.c;
        let (i, j, k) = (self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3);
        let mut sine: f64 = 1.0;
        for _ in 0..3 {
            let fastest = c[j].high.max(c[k].high).max((sine * c[i].high).next_up());
            sine = sine.min((longest * fastest).next_up());
        }
        if sine > 0.9 {
            return false;
        }
        let sine = Interval::exactly(sine);
        // The tangent bounds the angle e from above, and it is the tangent of half the largest
        // swing.
        let tangent = sine / (Interval::ONE - sine.squared()).sqrt();
        if self.swing > tangent.twice().high {
            return true;
        }
        let drift = (tangent * c[j].length(c[k])).high;
        let [along, back] = if negative {
            [self.twists[1], self.twists[0]]
        } else {
            self.twists
        };
        let forward = Interval::exactly(along) / (c[i] + Interval::exactly(drift));
        if forward.low < time {
            return false;
        }
        // Where the drift may exceed the rate, the twist may be reached in the opposite sense.
        let fastest_back = (Interval::exactly(drift) - c[i]).high;
        fastest_back <= 0.0
            || (Interval::exactly(back) / Interval::exactly(fastest_back)).low >= time
    }
}
