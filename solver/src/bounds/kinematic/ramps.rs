//! From the least time of turns to lower bounds on slews with limited accelerations.
//!
//! Let every motion of the spacecraft have `|w_i| <= r_i` and `|w_i'| <= a_i` in body axes, and let
//! `b_i`, `e_i` bound `|w_i|` at the two ends of a leg of duration `T` (0 where the component is
//! stopped, the value where it is known, no bound where it is free). Then, whatever the motion,
//!
//! ```text
//!   |w_i(t)| <= m_i(t; T) = min(r_i, b_i + a_i t, e_i + a_i (T - t))
//! ```
//!
//! **Any box.** For rates `p_i > 0` let `s(T) = int_0^T max_i m_i / p_i dt`. Along the motion take
//! `s` as the time instead, `ds / dt = max_i m_i / p_i`: then `dR / ds = R S(w / s')` with
//! `|w_i / s'| <= p_i`, a motion within the box `p` that lasts `s(T)`. So `V_p(R) <= s(T)`, and as
//! `s` does not decrease with `T` (neither the integrand nor the range does),
//!
//! ```text
//!   T >= s^-1(V_p(R))    for every box p: the best of them counts.
//! ```
//!
//! Special cases, with `p = r`:
//!
//! * both ends at rest, `r_i = a_i tau` for all axes: `s = T - tau` for `T >= 2 tau`, else
//!   `T^2 / (4 tau)`. Hence `T >= V + tau` if `V >= tau`, else `T >= 2 sqrt(tau V)` (**short
//!   slews**). With unequal `tau_i`, `m_i / r_i` is largest for the least of them: the same with
//!   that one, and other boxes do better;
//! * one end at rest, one free: `m_i / r_i = min(1, t / tau)`, so `T >= V + tau / 2` if
//!   `V >= tau / 2`, else `sqrt(2 tau V)`;
//! * some components free at both ends: `m_i = r_i` for these, `s = T`, `T >= V`; boxes that are
//!   narrower on the stopped axes do better where these are the bottleneck;
//! * known end rates: `b_i = |w_i(0)|`, `e_i = |w_i(T)|`.
//!
//! **Tours.** For a motion through several rotations the argument holds on each leg, and `s` is
//! additive: the sum of `V_p` over the legs is at most `s(T)` of the whole motion, with the end
//! conditions of the tour. Where all components stop at every target, the legs are independent and
//! their bounds are summed instead.
//!
//! **Missed attitudes.** Where the attitudes at the two ends of a turn `R` are met within an angle `d`
//! only, the motion makes a turn `E_0^T R E_1` with `E_0`, `E_1` by at most `d`. A turn by `d` about any
//! axis takes `d / min_i p_i` at most, at a constant rate about it, and `V_p` obeys the triangle
//! inequality: `V_p(E_0^T R E_1) >= V_p(R) - 2 d / min_i p_i`. So much less of each turn counts.
//!
//! The boxes tried are those of the mean rates `1 / T int m_i dt` for some durations `T`, from `r`
//! (long slews) to the shape of `a` (short slews at rest). Any choice is valid.

use super::RateBox;
use super::certificate::{Certificate, CertifiedTurn, PROOF_MARGIN};
use super::limits::{EndRates, SlewLimits};
use super::rate_envelope::RateEnvelope;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;
use std::sync::OnceLock;

/// Durations whose mean rates give the boxes, in units of the longest ramp.
const DURATIONS: [f64; 4] = [0.5, 1.0, 2.0, 5.0];
/// Relative difference of shapes below which two boxes are treated as one.
const SAME_SHAPE: f64 = 0.02;
/// Relative increase of the time of missed attitudes, for the rounding of what is left of a turn.
const ROUNDING: f64 = 1e-12;
/// Relative reduction of a duration for the rounding of `s`.
pub(super) const DEFLATION: f64 = 1e-9;

/// Lower bounds on the slews within given limits and with given end rates.
#[derive(Debug, Clone)]
pub struct SlewBound {
    pub(super) envelope: RateEnvelope,
    /// The boxes; the first one is that of the limits themselves.
    pub(super) boxes: Vec<TriedBox>,
    /// Largest angle by which attitudes are missed, rad.
    pub(super) attitude_tolerance_rad: f64,
}

/// A box of rates, rad/s, whose extremals are listed when they are first needed.
#[derive(Debug, Clone)]
pub(super) struct TriedBox {
    pub(super) rates: Vector3<f64>,
    table: OnceLock<Option<RateBox>>,
}

impl TriedBox {
    fn new(rates: Vector3<f64>) -> Self {
        Self {
            rates,
            table: OnceLock::new(),
        }
    }

    /// The extremals; `None` for rates so different that there are too many.
    pub(super) fn table(&self) -> Option<&RateBox> {
        let table = self.table.get_or_init(|| RateBox::new(self.rates));
        table.as_ref()
    }

    /// A turn with a lower bound on its time within the box that has the margin which its verification
    /// needs; zero where the extremals are too many to list.
    pub(super) fn certified(&self, turn: &Attitude, tolerance: f64) -> CertifiedTurn {
        let least = |table: &RateBox| table.lower_bound(turn, tolerance) * (1.0 - PROOF_MARGIN);
        CertifiedTurn {
            turn: *turn,
            least_s: self.table().map_or(0.0, least),
        }
    }
}

impl SlewBound {
    /// Bounds for slews within these limits and with these end rates. `None` when limits are not
    /// positive and finite, or an end rate is negative or not a number.
    #[must_use]
    pub fn new(limits: SlewLimits, ends: EndRates) -> Option<Self> {
        let positive = |v: &Vector3<f64>| v.iter().all(|x| x.is_finite() && *x > 0.0);
        let bounds = |v: &Vector3<f64>| v.iter().all(|x| *x >= 0.0);
        if !positive(&limits.rates_rad_s)
            || !positive(&limits.accelerations_rad_s2)
            || !bounds(&ends.begin_rad_s)
            || !bounds(&ends.end_rad_s)
        {
            return None;
        }
        let rates = limits.rates_rad_s;
        let mut bound = Self {
            envelope: RateEnvelope { limits, ends },
            boxes: vec![TriedBox::new(rates)],
            attitude_tolerance_rad: 0.0,
        };
        let longest = rates.component_div(&limits.accelerations_rad_s2).max();
        for duration in DURATIONS {
            let candidate = bound.envelope.mean_rates(duration * longest);
            let known = bound.boxes.iter().any(|other| {
                let ratio = candidate.component_div(&other.rates);
                ratio.max() < ratio.min() * (1.0 + SAME_SHAPE)
            });
            if !known {
                bound.boxes.push(TriedBox::new(candidate));
            }
        }
        Some(bound)
    }

    /// The same for slews that may miss every attitude, those at their beginning included, by an
    /// angle, rad.
    #[must_use]
    pub fn missing(self, attitude_tolerance_rad: f64) -> Self {
        Self {
            attitude_tolerance_rad,
            ..self
        }
    }

    /// Lower bound, s, on the duration of a slew that makes these turns one after the other, each
    /// in the body axes where the one before ended; one turn for a leg. The end rates apply to the
    /// two ends of the whole motion; between the turns all rates are free.
    ///
    /// The least times of the turns are computed to the relative tolerance and reduced by 2e-6, so
    /// that [`crate::bounds::certify`] can verify them. The result is valid for any tolerance. It
    /// is rounded down to seven digits, so that it does not depend on the mathematical library.
    #[must_use]
    pub fn lower_bound_s(&self, turns: &[Attitude], tolerance: f64) -> f64 {
        self.best(turns, tolerance).1
    }

    /// The certificate of the bound [`Self::lower_bound_s`].
    #[must_use]
    pub fn certificate(&self, turns: &[Attitude], tolerance: f64) -> Certificate {
        let (index, duration_s) = self.best(turns, tolerance);
        self.certificate_of(index, duration_s, turns, tolerance)
    }

    /// The certificate of a bound, s, that a box gives.
    pub(super) fn certificate_of(
        &self,
        index: usize,
        duration_s: f64,
        turns: &[Attitude],
        tolerance: f64,
    ) -> Certificate {
        let tried = &self.boxes[index];
        Certificate {
            limits: self.envelope.limits,
            ends: self.envelope.ends,
            box_rad_s: tried.rates,
            turns: turns
                .iter()
                .map(|turn| tried.certified(turn, tolerance))
                .collect(),
            attitude_tolerance_rad: self.attitude_tolerance_rad,
            duration_s,
        }
    }

    /// Least time of any motion within a box that makes a turn up to the missed angles at its ends,
    /// s; with the margin that its verification needs.
    pub(super) fn least_time(&self, tried: &TriedBox, turn: &Attitude, tolerance: f64) -> f64 {
        self.left_of(tried, tried.certified(turn, tolerance).least_s)
    }

    /// What is left of a least time within a box, s, for turns up to the missed angles at their ends.
    pub(super) fn left_of(&self, tried: &TriedBox, least_s: f64) -> f64 {
        (least_s - self.missed_time(tried)).max(0.0)
    }

    /// Time of the angles by which the attitudes at both ends of a turn are missed, s.
    pub(super) fn missed_time(&self, tried: &TriedBox) -> f64 {
        2.0 * self.attitude_tolerance_rad * (1.0 + ROUNDING) / tried.rates.min()
    }

    /// Index of the box with the best bound for the turns, and the bound, s.
    fn best(&self, turns: &[Attitude], tolerance: f64) -> (usize, f64) {
        let mut best = (0, 0.0);
        for (index, tried) in self.boxes.iter().enumerate() {
            let least: f64 = turns
                .iter()
                .map(|turn| self.least_time(tried, turn, tolerance))
                .sum();
            let duration = self.envelope.duration_of(&tried.rates, least);
            if duration > best.1 {
                best = (index, duration);
            }
        }
        (best.0, stated(best.1))
    }
}

/// A bound as it is given: less what rounding may have added, and to seven digits.
pub(crate) fn stated(duration_s: f64) -> f64 {
    rounded_down(duration_s * (1.0 - DEFLATION))
}

/// A number rounded down to seven digits; 0 if it is negative.
pub(super) fn rounded_down(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let unit = 10.0_f64.powf(x.log10().floor() - 6.0);
    ((x / unit).floor() * unit).min(x)
}
