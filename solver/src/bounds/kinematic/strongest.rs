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
use nalgebra::Vector3;

/// Relative gain for which a box is not tried any more.
pub(super) const SMALL_GAIN: f64 = 2e-4;
/// Boxes that are tried. All of them, some twenty, would give bounds of arrays on random axes that are
/// greater by 1 to 2 % in the mean.
const MAX_TRIED: usize = 6;

/// Bounds on one slew in several axes, each with the turn in these axes.
#[derive(Debug, Default)]
pub(crate) struct Alternatives<'a> {
    bounds: Vec<Alternative<'a>>,
}

/// A bound with the turn to which it is applied.
#[derive(Debug)]
struct Alternative<'a> {
    bound: &'a SlewBound,
    turn: Attitude,
    given_away: GivenAway,
}

/// Turns by which the ends of a slew may be missed, beside the attitude tolerance of its bound.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct GivenAway {
    /// Absolute components of the rotation vector, rad, at both ends, in the axes of the bound.
    pub(crate) turns: [Vector3<f64>; 2],
}

impl GivenAway {
    /// The time of these turns at constant rates within a box, s.
    fn time_s(&self, rates: &Vector3<f64>) -> f64 {
        let times = self.turns.map(|turn| turn.component_div(rates).max());
        times.iter().sum()
    }
}

impl Alternative<'_> {
    /// What is left of the time of a turn within a box, s, for those up to what is missed.
    fn left_of(&self, time: f64, tried: &TriedBox) -> f64 {
        let missed = self.bound.missed_time(tried) + self.given_away.time_s(&tried.rates);
        (time - missed).max(0.0)
    }

    /// Least time of any motion within a box that makes such a turn, s.
    fn least_time(&self, tried: &TriedBox, tolerance: f64) -> f64 {
        let least = self.bound.least_time(tried, &self.turn, tolerance);
        (least - self.given_away.time_s(&tried.rates)).max(0.0)
    }
}

/// The strongest of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strongest {
    /// Number of the alternative.
    pub(crate) alternative: usize,
    /// Number of its box.
    pub(crate) tried: usize,
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
    pub(crate) fn add(&mut self, bound: &'a SlewBound, turn: Attitude, given_away: GivenAway) {
        self.bounds.push(Alternative {
            bound,
            turn,
            given_away,
        });
    }

    /// The strongest bound of the most promising boxes, within [`SMALL_GAIN`]; `None` where there is
    /// none at all.
    pub(crate) fn strongest(&self, tolerance: f64) -> Option<Strongest> {
        let mut best: Option<(Strongest, f64)> = None;
        let mut left = MAX_TRIED;
        for candidate in self.candidates() {
            let alternative = &self.bounds[candidate.alternative];
            let bound = alternative.bound;
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
            let least = alternative.least_time(tried, tolerance);
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

    /// The bound, s, that one box of one alternative gives, where there are these.
    pub(crate) fn of_box(&self, alternative: usize, tried: usize, tolerance: f64) -> Option<f64> {
        let one = self.bounds.get(alternative)?;
        let tried = one.bound.boxes.get(tried)?;
        let least = one.least_time(tried, tolerance);
        Some(stated(one.bound.envelope.duration_of(&tried.rates, least)))
    }

    /// The certificate of the strongest bound.
    pub(crate) fn certificate(&self, strongest: &Strongest, tolerance: f64) -> Certificate {
        let Alternative { bound, turn, .. } = &self.bounds[strongest.alternative];
        bound.certificate_of(strongest.tried, strongest.bound_s, &[*turn], tolerance)
    }

    /// All boxes, the most promising one first.
    fn candidates(&self) -> Vec<Candidate> {
        let mut all = Vec::new();
        for (alternative, one) in self.bounds.iter().enumerate() {
            for (index, tried) in one.bound.boxes.iter().enumerate() {
                let [attained, least] = quick_times(tried, &one.turn);
                all.push(Candidate {
                    alternative,
                    tried: index,
                    attained: one.left_of(attained, tried),
                    expected: one.left_of(0.5 * (attained + least), tried),
                    promise: 0.0,
                });
            }
        }
        // A duration of the order of the bounds.
        let Some(first) = all.first() else {
            return all;
        };
        let bound = self.bounds[first.alternative].bound;
        let rates = &bound.boxes[first.tried].rates;
        let reference = bound.envelope.duration_of(rates, first.expected);
        if reference > 0.0 {
            for candidate in &mut all {
                let bound = self.bounds[candidate.alternative].bound;
                let rates = &bound.boxes[candidate.tried].rates;
                candidate.promise = candidate.expected / bound.envelope.effective(rates, reference);
            }
        }
        all.sort_by(|one, other| other.promise.total_cmp(&one.promise));
        all
    }
}

/// Time of a motion within a box that makes a turn, and a lower bound on that of all such motions, s.
pub(super) fn quick_times(tried: &TriedBox, turn: &Attitude) -> [f64; 2] {
    let speed = tried.rates.norm();
    let shape = (tried.rates / speed).into();
    let turn = turn.xyzw();
    let attained = eigenaxis_time(&turn, &shape).min(best_axis_sequence(&turn, &shape).0);
    [attained, least_time(&turn, &shape).min(attained)].map(|time| time / speed)
}

#[cfg(test)]
mod tests;
