//! The link from the least times of turns to the duration: an upper bound on the integral `s(T)` of
//! [`crate::bounds::kinematic::ramps`] and of norms whose unit balls are polytopes.
//!
//! ```text
//!   s(T) = int_0^T max_f min(m_f(t), sum_i |f_i| m_i(t)) dt
//! ```
//!
//! with the limits `m = min(most, begin + slope t, end + slope (T - t))` of the component of the rate across every
//! facet `f`, relative to its distance, and of those along the axes of a frame. A box of rates has a facet across
//! every axis, and no frame. The least times of the turns add up to at most `s(T)` for every motion of duration `T`.
//! So `T` is a lower bound on the duration if `s(T)` is at most their sum.

use super::turn::{dot, of_numbers};
use crate::bounds::interval::Interval;
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::bounds::polytope::certificate::{FacetPremise, FramePremise};
use crate::bounds::polytope::trapezoid::Trapezoid;
use nalgebra::Vector3;

/// Width of a piece, relative to the duration, below which it is bounded without further splitting.
const NARROW: f64 = 1e-14;
/// Width of a piece, relative to the duration, below which it is not split for a tighter bound
/// alone.
const FINE: f64 = 1e-6;

/// A facet in the integral.
struct Facet {
    limits: Trapezoid,
    /// The distance that its limits are relative to.
    distance: f64,
    /// Sizes of its normal's components along the axes of the frame.
    components: Option<[Interval; 3]>,
}

/// The integral `s(T)` to be bounded.
struct LinkIntegrand {
    facets: Vec<Facet>,
    /// Limits along the axes of the frame.
    frame: Option<[Trapezoid; 3]>,
    duration: f64,
}

/// An upper bound on `s(T)` for a box of rates, s.
pub(super) fn at_most(
    limits: &SlewLimits,
    ends: &EndRates,
    rates: &Vector3<f64>,
    duration: f64,
) -> f64 {
    let axes = along_axes(limits, ends);
    let facets = [0, 1, 2].map(|axis| Facet {
        limits: axes[axis],
        distance: rates[axis],
        components: None,
    });
    let integrand = LinkIntegrand {
        facets: facets.into(),
        frame: None,
        duration,
    };
    integrand.at_most()
}

/// An upper bound on `s(T)` for a polytope of rates, s.
pub(super) fn at_most_across(
    facets: &[FacetPremise],
    frame: Option<&FramePremise>,
    duration: f64,
) -> f64 {
    let facets = facets.iter().map(|facet| Facet {
        limits: facet.share,
        distance: 1.0,
        components: frame.map(|frame| {
            let normal = of_numbers(&facet.normal);
            [0, 1, 2].map(|i| dot(&normal, &of_numbers(&frame.axes.column(i).into())).abs())
        }),
    });
    let integrand = LinkIntegrand {
        facets: facets.collect(),
        frame: frame.map(|frame| along_axes(&frame.limits, &frame.ends)),
        duration,
    };
    integrand.at_most()
}

/// By how much less time, s, a turn within the box takes whose ends are missed by an angle, rad: that
/// of two turns about any axes by this angle.
pub(super) fn missed(rates: &Vector3<f64>, angle: f64) -> Interval {
    let once = Interval::exactly(angle) / Interval::exactly(rates.min());
    once + once
}

/// The same within a polytope.
pub(super) fn missed_across(facets: &[FacetPremise], angle: f64) -> Interval {
    let lengths = facets.iter().map(|facet| {
        let [x, y, z] = of_numbers(&facet.normal);
        x.length(y).length(z).high
    });
    let once = Interval::exactly(angle) * Interval::exactly(lengths.fold(0.0, f64::max));
    once + once
}

fn along_axes(limits: &SlewLimits, ends: &EndRates) -> [Trapezoid; 3] {
    [0, 1, 2].map(|axis| Trapezoid {
        most: limits.rates_rad_s[axis],
        slope: limits.accelerations_rad_s2[axis],
        ends: [ends.begin_rad_s[axis], ends.end_rad_s[axis]],
    })
}

impl LinkIntegrand {
    fn at_most(&self) -> f64 {
        let mut sum = Interval::ZERO;
        let mut open = vec![(0.0, self.duration)];
        while let Some((from, to)) = open.pop() {
            let middle = 0.5 * (from + to);
            let narrow = to - from <= NARROW * self.duration || middle <= from || middle >= to;
            match self.piece(from, to, narrow) {
                Some(area) => sum = sum + area,
                None => open.extend([(from, middle), (middle, to)]),
            }
        }
        sum.high
    }

    /// The three bounds on what is limited, each linear in time.
    fn bounds(&self, limits: &Trapezoid, at: f64) -> [Interval; 3] {
        let exactly = Interval::exactly;
        let slope = exactly(limits.slope);
        let ramp = |begin: f64, time: Interval| {
            // The limit of a free end is infinite; the largest double keeps intervals finite.
            exactly(begin.min(f64::MAX)) + slope * time
        };
        [
            exactly(limits.most),
            ramp(limits.ends[0], exactly(at)),
            ramp(limits.ends[1], exactly(self.duration) - exactly(at)),
        ]
    }

    /// A linear bound over a piece by its values at both ends; `None` where the piece should be split.
    fn linear(&self, limits: &Trapezoid, from: f64, to: f64, narrow: bool) -> Option<[f64; 2]> {
        let (begin, end) = (self.bounds(limits, from), self.bounds(limits, to));
        // Any of the linear bounds is valid over the whole piece. The one that is least at both
        // ends is the tightest; if there is none, the piece contains a kink.
        let least = |at: &[Interval; 3]| at.iter().map(|x| x.high).fold(f64::MAX, f64::min);
        let both = (0..3).find(|&i| begin[i].high <= least(&begin) && end[i].high <= least(&end));
        let chosen = both.or_else(|| {
            let first = (0..3).min_by(|&i, &j| begin[i].high.total_cmp(&begin[j].high));
            first.filter(|_| narrow)
        })?;
        Some([begin[chosen].high, end[chosen].high])
    }

    /// An upper bound on the integral over a piece, or `None` where the piece should be split.
    fn piece(&self, from: f64, to: f64, narrow: bool) -> Option<Interval> {
        let width = Interval::exactly(to) - Interval::exactly(from);
        let coarse = !narrow && to - from > FINE * self.duration;
        let frame = match &self.frame {
            None => None,
            Some(frame) => {
                let [x, y, z] = [0, 1, 2].map(|i| self.linear(&frame[i], from, to, narrow));
                Some([x?, y?, z?])
            }
        };
        let mut shares = Vec::with_capacity(self.facets.len());
        for facet in &self.facets {
            let own = self.linear(&facet.limits, from, to, narrow)?;
            let share = |x: f64| (Interval::exactly(x) / Interval::exactly(facet.distance)).high;
            let own = own.map(share);
            let summed = frame.zip(facet.components).map(|(frame, components)| {
                [0, 1].map(|end| {
                    let parts = [0, 1, 2].map(|i| components[i] * Interval::exactly(frame[i][end]));
                    (parts[0] + parts[1] + parts[2]).high
                })
            });
            let lesser = summed.map_or(own, |summed| {
                if summed[0] + summed[1] < own[0] + own[1] {
                    summed
                } else {
                    own
                }
            });
            let crosses = summed
                .is_some_and(|summed| (0..2).any(|end| lesser[end] > own[end].min(summed[end])));
            if crosses && coarse {
                return None;
            }
            shares.push(lesser);
        }
        // The maximum of linear functions is convex and lies below its chord. Where the largest
        // facet changes within the piece, the chord is not tight.
        let largest = |end: usize| shares.iter().map(|s| s[end]).fold(0.0, f64::max);
        let most = [largest(0), largest(1)];
        let crosses = !shares.iter().any(|s| s[0] >= most[0] && s[1] >= most[1]);
        if crosses && coarse {
            return None;
        }
        let mean = (Interval::exactly(most[0]) + Interval::exactly(most[1])).half();
        Some(mean * width)
    }
}
