//! The strongest of many bounds on one slew, with as few of them as possible computed in full.
//!
//! Every bound on a slew belongs to a box of rates in some axes. Whether a box can give more than a
//! duration `T` is known without its extremals: only if the time `V^` of any motion within it that
//! makes the turn has `V^ - missed > s(T)`, as `V <= V^`. The turn about its own axis and those about
//! three body axes are such motions. So the boxes are tried in the order in which they promise most,
//! and those that promise no more than what is proved already are left out, with the listing of their
//! extremals, which is the larger part of the work for a single leg.

use super::certificate::Certificate;
use super::ramps::{SlewBound, TriedBox, stated};
use super::turns::{best_axis_sequence, eigenaxis_time, least_time};
use crate::model::attitude::Attitude;

/// Relative gain for which a box is not tried any more.
const SMALL_GAIN: f64 = 2e-4;
/// Boxes that are tried. All of them, some twenty, would give bounds of arrays on random axes that are
/// greater by 1 to 2 % in the mean.
const MAX_TRIED: usize = 6;

/// Bounds on one slew in several axes, each with the turn in these axes.
#[derive(Debug, Default)]
pub(crate) struct Alternatives<'a> {
    bounds: Vec<(&'a SlewBound, Attitude)>,
}

/// The strongest of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strongest {
    /// Number of the alternative.
    pub(crate) alternative: usize,
    /// Number of its box.
    tried: usize,
    /// The bound, s.
    pub(crate) bound_s: f64,
}

/// A box that may be tried.
struct Candidate {
    alternative: usize,
    tried: usize,
    /// Time of a motion within it that makes the turn, s, less the time of missed attitudes.
    attained: f64,
    /// The least time of such motions, s, by a guess: half-way between that and a quick lower bound.
    expected: f64,
    /// Ratio of the expected time to that which the box allows in a duration that all share.
    promise: f64,
}

impl<'a> Alternatives<'a> {
    /// Adds a bound, with the turn in its axes.
    pub(crate) fn add(&mut self, bound: &'a SlewBound, turn: Attitude) {
        self.bounds.push((bound, turn));
    }

    /// The strongest bound of the most promising boxes, within [`SMALL_GAIN`]; `None` where there is
    /// none at all.
    pub(crate) fn strongest(&self, tolerance: f64) -> Option<Strongest> {
        let mut best: Option<(Strongest, f64)> = None;
        let mut left = MAX_TRIED;
        for candidate in self.candidates() {
            let (bound, turn) = &self.bounds[candidate.alternative];
            let tried = &bound.boxes[candidate.tried];
            let proved = best.map_or(0.0, |(_, duration)| duration);
            let needed = bound
                .envelope
                .effective(&tried.rates, proved * (1.0 + SMALL_GAIN));
            if best.is_some() && candidate.attained <= needed {
                continue;
            }
            if left == 0 {
                break;
            }
            left -= 1;
            if tried.table().is_none() {
                continue;
            }
            let least = bound.least_time(tried, turn, tolerance);
            if best.is_some() && least <= bound.envelope.effective(&tried.rates, proved) {
                continue;
            }
            let duration = bound.envelope.duration_of(&tried.rates, least);
            if best.is_none() || duration > proved {
                let strongest = Strongest {
                    alternative: candidate.alternative,
                    tried: candidate.tried,
                    bound_s: stated(duration),
                };
                best = Some((strongest, duration));
            }
        }
        best.map(|(strongest, _)| strongest)
    }

    /// The certificate of the strongest bound.
    pub(crate) fn certificate(&self, strongest: &Strongest, tolerance: f64) -> Certificate {
        let (bound, turn) = &self.bounds[strongest.alternative];
        bound.certificate_of(strongest.tried, strongest.bound_s, &[*turn], tolerance)
    }

    /// All boxes, the most promising one first.
    fn candidates(&self) -> Vec<Candidate> {
        let mut all = Vec::new();
        for (alternative, (bound, turn)) in self.bounds.iter().enumerate() {
            for (index, tried) in bound.boxes.iter().enumerate() {
                let [attained, least] = quick_times(tried, turn);
                let left = |time: f64| (time - bound.missed_time(tried)).max(0.0);
                all.push(Candidate {
                    alternative,
                    tried: index,
                    attained: left(attained),
                    expected: left(0.5 * (attained + least)),
                    promise: 0.0,
                });
            }
        }
        // A duration of the order of the bounds.
        let Some(first) = all.first() else {
            return all;
        };
        let (bound, _) = &self.bounds[first.alternative];
        let rates = &bound.boxes[first.tried].rates;
        let reference = bound.envelope.duration_of(rates, first.expected);
        if reference > 0.0 {
            for candidate in &mut all {
                let (bound, _) = &self.bounds[candidate.alternative];
                let rates = &bound.boxes[candidate.tried].rates;
                candidate.promise = candidate.expected / bound.envelope.effective(rates, reference);
            }
        }
        all.sort_by(|one, other| other.promise.total_cmp(&one.promise));
        all
    }
}

/// Time of a motion within a box that makes a turn, and a lower bound on that of all such motions, s.
fn quick_times(tried: &TriedBox, turn: &Attitude) -> [f64; 2] {
    let speed = tried.rates.norm();
    let shape = (tried.rates / speed).into();
    let turn = turn.xyzw();
    let attained = eigenaxis_time(&turn, &shape).min(best_axis_sequence(&turn, &shape).0);
    [attained, least_time(&turn, &shape).min(attained)].map(|time| time / speed)
}

#[cfg(test)]
mod tests;
