//! The envelope `m_i(t; T)` of the rates of a motion, and its integral `s(T)`; both are defined in
//! [`super::ramps`].

use super::inversion::last_below;
use super::limits::{EndRates, SlewLimits};
use nalgebra::Vector3;

/// Smallest width of a box, as a share of the rate limit and relative to its widest axis: more
/// extreme boxes have many extremals and gain nothing.
const MIN_SHARE: f64 = 0.1;

/// Limits with the rates at the two ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RateEnvelope {
    pub(crate) limits: SlewLimits,
    pub(crate) ends: EndRates,
}

impl RateEnvelope {
    /// `m_i(t; T)`.
    pub(crate) fn available(&self, axis: usize, at: f64, duration: f64) -> f64 {
        let acceleration = self.limits.accelerations_rad_s2[axis];
        let begin = self.ends.begin_rad_s[axis] + acceleration * at;
        let end = self.ends.end_rad_s[axis] + acceleration * (duration - at);
        self.limits.rates_rad_s[axis].min(begin).min(end)
    }

    /// Times at which some `m_i` may have a kink, sorted, with both ends.
    pub(crate) fn kinks(&self, duration: f64) -> [f64; 11] {
        let mut times = [0.0; 11];
        times[1] = duration;
        for i in 0..3 {
            let (rate, acceleration) = (
                self.limits.rates_rad_s[i],
                self.limits.accelerations_rad_s2[i],
            );
            // An end rate above the limit gives no ramp.
            let begin = self.ends.begin_rad_s[i].min(rate);
            let end = self.ends.end_rad_s[i].min(rate);
            let at = [
                (rate - begin) / acceleration,
                duration - (rate - end) / acceleration,
                0.5 * (duration + (end - begin) / acceleration),
            ];
            for k in 0..3 {
                times[2 + 3 * i + k] = at[k].clamp(0.0, duration);
            }
        }
        times.sort_by(f64::total_cmp);
        times
    }

    /// Means of `m_i` over a duration, each raised to at least [`MIN_SHARE`] of the largest share
    /// of its limit.
    pub(super) fn mean_rates(&self, duration: f64) -> Vector3<f64> {
        let kinks = self.kinks(duration);
        let shares = Vector3::from_fn(|i, _| {
            let area: f64 = kinks
                .windows(2)
                .map(|t| {
                    let ends = [t[0], t[1]].map(|t| self.available(i, t, duration));
                    0.5 * (ends[0] + ends[1]) * (t[1] - t[0])
                })
                .sum();
            area / (duration * self.limits.rates_rad_s[i])
        });
        let least = MIN_SHARE * shares.max();
        self.limits
            .rates_rad_s
            .component_mul(&shares.map(|share| share.max(least)))
    }

    /// `s(T)` for a box: the integrand is linear between kinks and crossings of the `m_i / p_i`.
    pub(crate) fn effective(&self, rates: &Vector3<f64>, duration: f64) -> f64 {
        let kinks = self.kinks(duration);
        let inverse = rates.map(f64::recip);
        let shares =
            |at: f64| Vector3::from_fn(|i, _| self.available(i, at, duration) * inverse[i]);
        let (mut sum, mut first) = (0.0, shares(0.0));
        for pair in kinks.windows(2) {
            let length = pair[1] - pair[0];
            if length <= 0.0 {
                continue;
            }
            let last = shares(pair[1]);
            sum += length * mean_of_largest(&first, &last);
            first = last;
        }
        sum
    }

    /// The duration `s^-1(least)`, from below and to rounding.
    pub(crate) fn duration_of(&self, rates: &Vector3<f64>, least: f64) -> f64 {
        self.longest_short_of(rates, least, 0.0, 0.0)
    }

    /// The longest duration `T >= from` with `s(T) + slope (T - from) < least`, to rounding and
    /// from below; `from` itself if there is none.
    pub(super) fn longest_short_of(
        &self,
        rates: &Vector3<f64>,
        least: f64,
        slope: f64,
        from: f64,
    ) -> f64 {
        let covered = |duration: f64| self.effective(rates, duration) + slope * (duration - from);
        // A lower bound on the duration: all rates at their limits.
        let step = least * rates.component_div(&self.limits.rates_rad_s).min();
        last_below(from, step, least, covered)
    }
}

/// The mean of the largest component of a vector that changes linearly between two.
fn mean_of_largest(first: &Vector3<f64>, last: &Vector3<f64>) -> f64 {
    let mut cuts = [0.0, 1.0, 1.0, 1.0, 1.0];
    let mut crossings = 0;
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let (before, after) = (first[i] - first[j], last[i] - last[j]);
        if before * after < 0.0 {
            crossings += 1;
            cuts[crossings] = before / (before - after);
        }
    }
    if crossings == 0 {
        return 0.5 * (first.max() + last.max());
    }
    cuts[1..=crossings].sort_by(f64::total_cmp);
    let value = |cut: f64| (first + (last - first) * cut).max();
    let parts = cuts.windows(2);
    parts
        .map(|cut| 0.5 * (value(cut[0]) + value(cut[1])) * (cut[1] - cut[0]))
        .sum()
}
