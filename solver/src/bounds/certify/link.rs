//! From the least times of turns to the duration: the integral of `kinematic_bound::ramps`, enclosed.
//!
//! `s(T) = int_0^T max_i m_i(t) / p_i dt` with `m_i = min(r_i, b_i + a_i t, e_i + a_i (T - t))`. As
//! least times of the turns within the box `p` add up to `s(T)` at most, a duration `T` with `s(T)`
//! no more than their sum cannot be undercut.

use super::interval::Interval;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use nalgebra::Vector3;

/// Pieces narrower than this share of the duration are bounded by a constant.
const NARROW: f64 = 1e-14;
/// Pieces narrower than this share are not split for the sake of sharpness alone.
const FINE: f64 = 1e-6;

/// The integral that is to be bounded.
struct LinkIntegrand<'a> {
    limits: &'a SlewLimits,
    ends: &'a EndRates,
    rates: &'a Vector3<f64>,
    duration: f64,
}

/// A number that `s(T)` does not exceed, s.
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

impl LinkIntegrand<'_> {
    /// The three bounds on the rate of an axis, linear in the time.
    fn bounds(&self, axis: usize, at: f64) -> [Interval; 3] {
        let exactly = Interval::exactly;
        let acceleration = exactly(self.limits.accelerations_rad_s2[axis]);
        let ramp = |rate: f64, time: Interval| {
            // A free end bounds nothing.
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

    /// The area over a piece, or `None` where it should be split.
    fn piece(&self, from: f64, to: f64, narrow: bool) -> Option<Interval> {
        let width = Interval::exactly(to) - Interval::exactly(from);
        let mut shares = [[0.0; 2]; 3];
        for axis in 0..3 {
            let (begin, end) = (self.bounds(axis, from), self.bounds(axis, to));
            let share = |x: f64| (Interval::exactly(x) / Interval::exactly(self.rates[axis])).high;
            // Any of the linear bounds will do over the whole piece; the one that is least at both
            // ends is the sharpest, and if there is none the piece contains a kink.
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
        // The largest of linear functions is convex: it lies below its chord. Where another axis
        // takes over the chord is a little too high.
        let most = |end: usize| shares.iter().map(|s| s[end]).fold(0.0, f64::max);
        let crosses = !shares.iter().any(|s| s[0] >= most(0) && s[1] >= most(1));
        if crosses && !narrow && to - from > FINE * self.duration {
            return None;
        }
        let mean = (Interval::exactly(most(0)) + Interval::exactly(most(1))).half();
        Some(mean * width)
    }
}
