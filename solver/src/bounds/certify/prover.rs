//! The proof that no arc sequence makes a turn in less than a time.

use super::Rejection;
use super::dwelling;
use super::near_axis::NearAxis;
use super::rates::{Rates, flipped, octants};
use super::sequence::{ArcSequence, InteriorArcs};
use super::terminal_arcs::{Allowed, TargetView};
use super::turn::{QuatInterval, about, angle_of, conjugate, product};
use crate::bounds::interval::Interval;
use crate::model::attitude::Attitude;
use nalgebra::Vector3;

/// Largest number of dwelling sequences.
const MAX_SEQUENCES: usize = 200_000;
/// Largest number of flips near an axis.
const MAX_FLIPS: usize = 20_000;
/// Largest number of cells of one proof.
const MAX_CELLS: usize = 20_000_000;
/// Width of a cell below which the proof is given up.
const NARROW: f64 = 1e-13;
/// Relative difference from which a motion counts as faster; it covers the rounding of the last few
/// operations.
const FASTER: f64 = 1e-12;

/// A box of rates with its dwelling sequences.
#[derive(Debug)]
pub(super) struct Prover {
    rates: Rates,
    dwelling: Vec<ArcSequence>,
    /// Normalised time up to which the fixed arcs of the collected sequences last.
    horizon: f64,
}

/// The proof of one turn.
struct Proof<'a> {
    rates: &'a Rates,
    q: QuatInterval,
    /// The least time to be proved, normalised and rounded up.
    time: f64,
    cells: usize,
}

impl Prover {
    /// `None` unless all rates are positive and finite.
    pub(super) fn new(rates: &Vector3<f64>) -> Option<Self> {
        Some(Self {
            rates: Rates::around(rates)?,
            dwelling: Vec::new(),
            horizon: 0.0,
        })
    }

    /// Proves that a turn takes at least a time, s.
    pub(super) fn prove(&mut self, turn: &Attitude, least_s: f64) -> Result<(), Rejection> {
        if least_s <= 0.0 {
            return Ok(());
        }
        let time = (Interval::exactly(least_s) * self.rates.speed).high;
        let mut q = turn.xyzw().map(Interval::exactly);
        let length = q[0].length(q[1]).length(q[2]).length(q[3]);
        q = q.map(|x| x / length);
        let mut proof = Proof {
            rates: &self.rates,
            q,
            time,
            cells: 0,
        };
        // The turn about its own axis is a possible counterexample.
        proof.reject_if_faster(self.rates.eigenaxis(&q))?;
        if time > self.horizon {
            self.dwelling = dwelling::sequences(&self.rates, time, MAX_SEQUENCES)
                .ok_or(Rejection::not_proved("too many extremals dwell"))?;
            self.horizon = time;
        }
        for sequence in &self.dwelling {
            if sequence.fixed.low < time {
                proof.refute(sequence, 0.0, f64::INFINITY)?;
            }
        }
        for (first, axis) in octants().flat_map(|first| (0..3).map(move |axis| (first, axis))) {
            let sequence = ArcSequence {
                first,
                last: flipped(first, axis),
                fixed: Interval::ZERO,
                interior: InteriorArcs::Nothing,
            };
            proof.refute(&sequence, 0.0, 0.0)?;
        }
        for axis in 0..3 {
            proof.refute_alternating(axis)?;
        }
        Ok(())
    }
}

impl Proof<'_> {
    /// Refutes all sequences in which the two axes other than the given one flip alternately. (One
    /// axis alone flips on levels with a single wall; the costate then travels more than half of
    /// its circle between flips, and such arcs are no part of a shortest motion.)
    fn refute_alternating(&mut self, axis: usize) -> Result<(), Rejection> {
        let near = NearAxis::new(&self.q, axis);
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let angle = angle_of(&self.q).low;
        for arcs in 1..MAX_FLIPS {
            let longest = (self.time / arcs as f64).next_up().min(Interval::PI.high);
            let open = [false, true]
                .map(|negative| !near.proved(self.rates, longest, negative, self.time));
            if open == [false; 2] {
                return Ok(());
            }
            // Terminal arcs are no longer than the others, and the norm of the rate is at most one.
            let shortest = (angle / (arcs + 2) as f64).next_down().next_down();
            for first in octants().filter(|first| open[usize::from(first[axis])]) {
                for axes in [[j, k], [k, j]] {
                    let sequence = ArcSequence::alternating(first, axes, arcs);
                    self.refute(&sequence, shortest, longest)?;
                }
            }
        }
        Err(Rejection::not_proved("extremals with very many flips"))
    }

    /// Refutes one sequence for all values of its unknown in a range, by bisection.
    fn refute(
        &mut self,
        sequence: &ArcSequence,
        shortest: f64,
        longest: f64,
    ) -> Result<(), Rejection> {
        let view = TargetView::new(self.rates, &self.q, sequence);
        // A dwell lasts no longer than the time left by the fixed arcs, and no longer than half a
        // turn at its speed.
        let repeats = sequence.repeats();
        let mut longest = longest;
        if let InteriorArcs::Dwelling { speed, .. } = &sequence.interior {
            let left = (self.time - sequence.fixed.low).next_up();
            longest = longest.min((Interval::PI / *speed).high).min(left);
        }
        let mut open = vec![(shortest.max(0.0), longest)];
        while let Some((low, high)) = open.pop() {
            if low > high || self.excluded(sequence, &view, low, high)? {
                continue;
            }
            let middle = 0.5 * (low + high);
            if high - low < NARROW || repeats == 0.0 || middle <= low || middle >= high {
                return Err(Rejection::not_proved(
                    "an extremal may be as fast as the bound, to rounding",
                ));
            }
            open.extend([(low, middle), (middle, high)]);
        }
        Ok(())
    }

    /// Whether a sequence with its unknown in a range is proved not to make the turn in less than
    /// the time.
    fn excluded(
        &mut self,
        sequence: &ArcSequence,
        view: &TargetView,
        low: f64,
        high: f64,
    ) -> Result<bool, Rejection> {
        self.cells += 1;
        if self.cells > MAX_CELLS {
            return Err(Rejection::not_proved("the proof takes too long"));
        }
        let repeats = Interval::exactly(sequence.repeats());
        let inside = sequence.fixed + repeats * Interval::exactly(low);
        let left = Interval::exactly(self.time) - inside;
        if left.high <= 0.0 {
            return Ok(true);
        }
        let middle = 0.5 * (low + high);
        let half = Interval::exactly((high - middle).max(middle - low).next_up());
        let interior = sequence.at(self.rates, middle);
        // Second derivatives of a product of turns are at most the square of the sum of the speeds.
        let curvature = (Interval::exactly(sequence.speed()) * half)
            .squared()
            .half();
        if view.misses(&interior, half, curvature) {
            return Ok(true);
        }
        // The angular velocity is twice the length of the quaternion's derivative.
        let [x, y, z, w] = interior.slope;
        let velocity = x.length(y).length(z).length(w).twice();
        let Some(terminal) = view.terminal_arcs(&interior.turn, velocity * half + curvature) else {
            return Ok(true);
        };
        let each = match sequence.interior {
            InteriorArcs::Alternating { .. } => 0.5 * high,
            _ => Interval::PI.half().high,
        };
        let both = left.half().high;
        if terminal.impossible(Allowed { each, both }) {
            return Ok(true);
        }
        // The sequence at the middle and a turn about the eigenaxis of its miss make up a motion to
        // the target.
        let [first, last] = terminal.candidate().map(Interval::exactly);
        let before = product(&about(&view.ends[0], first), &interior.turn);
        let end = product(&before, &about(&view.ends[1], last));
        let missing = self.rates.eigenaxis(&product(&conjugate(&end), &self.q));
        let inside = sequence.fixed + repeats * Interval::exactly(middle);
        self.reject_if_faster((inside + first + last).high + missing)?;
        Ok(false)
    }

    /// Rejects the bound if a motion of this normalised time makes the turn and is faster.
    fn reject_if_faster(&self, time: f64) -> Result<(), Rejection> {
        // The true rates may be smaller than the raised ones.
        let time = time * self.rates.stretch;
        if time < self.time * (1.0 - FASTER) {
            return Err(Rejection::Faster {
                turn: 0,
                time_s: time / self.rates.speed.low,
            });
        }
        Ok(())
    }
}
