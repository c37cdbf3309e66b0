//! The link from the least times of turns to the duration: an upper bound on the integral `s(T)` of
//! `kinematic::ramps`.
//!
//! `s(T) = int_0^T max_i m_i(t) / p_i dt` with `m_i = min(r_i, b_i + a_i t, e_i + a_i (T - t))`.
//! The least times of the turns within the box `p` add up to at most `s(T)` for every motion of
//! duration `T`. So `T` is a lower bound on the duration if `s(T)` is at most their sum.

use super::interval::Interval;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use nalgebra::Vector3;

/// Width of a piece, relative to the duration, below which it is bounded without further splitting.
const NARROW: f64 = 1e-14;
/// Width of a piece, relative to the duration, below which it is not split for a tighter bound
/// alone.
const FINE: f64 = 1e-6;

/// The integral `s(T)` to be bounded.
struct LinkIntegrand<'a> {
    limits: &'a SlewLimits,
    ends: &'a EndRates,
    rates: &'a Vector3<f64>,
    duration: f64,
}

/// An upper bound on `s(T)`, s.
pub(super) fn at_most(
    limits: &SlewLimits,
    ends: &EndRates,
    rates: &Vector3<f64>,
    duration: f64,
) -> f64 {
    let integrand = LinkIntegrand {
        limits,
        ends,
        rates,
        duration,
    };
    let mut sum = Interval::ZERO;
    let mut open = vec![(0.0, duration)];
    while let Some((from, to)) = open.pop() {
        let middle = 0.5 * (from + to);
        let narrow = to - from <= NARROW * duration || middle <= from || middle >= to;
        match integrand.piece(from, to, narrow) {
            Some(area) => sum = sum + area,
            None => open.extend([(from, middle), (middle, to)]),
        }
    }
    sum.high
}

/// By how much less time, s, a turn within the box takes whose ends are missed by an angle, rad: that
/// of two turns about any axes by this angle.
pub(super) fn missed(rates: &Vector3<f64>, angle: f64) -> Interval {
    let once = Interval::exactly(angle) / Interval::exactly(rates.min());
    once + once
}

impl LinkIntegrand<'_> {
    /// The three bounds on the rate of an axis, each linear in time.
    fn bounds(&self, axis: usize, at: f64) -> [Interval; 3] {
        let exactly = Interval::exactly;
        let acceleration = exactly(self.limits.accelerations_rad_s2[axis]);
        let ramp = |rate: f64, time: Interval| {
            // The limit of a free end is infinite; the largest double keeps intervals finite.
            exactly(rate.min(f64::MAX)) + acceleration * time
        };
        [
            exactly(self.limits.rates_rad_s[axis]),
            ramp(self.ends.begin_rad_s[axis], exactly(at)),
            ramp(
                self.ends.end_rad_s[axis],
                exactly(self.duration) - exactly(at),
            ),
        ]
    }

    /// An upper bound on the integral over a piece, or `None` where the piece should be split.
    fn piece(&self, from: f64, to: f64, narrow: bool) -> Option<Interval> {
        let width = Interval::exactly(to) - Interval::exactly(from);
        let mut shares = [[0.0; 2]; 3];
        for axis in 0..3 {
            let (begin, end) = (self.bounds(axis, from), self.bounds(axis, to));
            let share = |x: f64| (Interval::exactly(x) / Interval::exactly(self.rates[axis])).high;
            // Any of the linear bounds is valid over the whole piece. The one that is least at both
            // ends is the tightest; if there is none, the piece contains a kink.
            let least = |at: &[Interval; 3]| at.iter().map(|x| x.high).fold(f64::MAX, f64::min);
            let both =
                (0..3).find(|&i| begin[i].high <= least(&begin) && end[i].high <= least(&end));
            shares[axis] = match both {
                Some(i) => [share(begin[i].high), share(end[i].high)],
                None if narrow => {
                    let i = (0..3)
                        .min_by(|&i, &j| begin[i].high.total_cmp(&begin[j].high))
                        .unwrap_or(0);
                    [share(begin[i].high), share(end[i].high)]
                }
                None => return None,
            };
        }
        // The maximum of linear functions is convex and lies below its chord. Where the largest
        // axis changes within the piece, the chord is not tight.
        let largest = |end: usize| shares.iter().map(|s| s[end]).fold(0.0, f64::max);
        let crosses = !shares
            .iter()
            .any(|s| s[0] >= largest(0) && s[1] >= largest(1));
        if crosses && !narrow && to - from > FINE * self.duration {
            return None;
        }
        let mean = (Interval::exactly(largest(0)) + Interval::exactly(largest(1))).half();
        Some(mean * width)
    }
}
