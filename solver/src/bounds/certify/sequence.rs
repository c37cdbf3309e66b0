//! Arc sequences: a first arc, an interior with one unknown duration, a last arc.

use super::rates::{Octant, Rates, flipped};
use super::turn::{IDENTITY, QuatInterval, product, scaled, sum, times_vector};
use crate::bounds::interval::Interval;

/// A turn and its derivative by a parameter, both as quaternions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving {
    pub(super) turn: QuatInterval,
    pub(super) slope: QuatInterval,
}

impl Moving {
    const NONE: Self = Self {
        turn: IDENTITY,
        slope: [Interval::ZERO; 4],
    };

    fn then(&self, next: &Self) -> Self {
        Self {
            turn: product(&self.turn, &next.turn),
            slope: sum(
                &product(&self.slope, &next.turn),
                &product(&self.turn, &next.slope),
            ),
        }
    }
}

/// The arcs between the first and the last one.
#[derive(Debug, Clone)]
pub(super) enum InteriorArcs {
    /// No interior arc and no unknown.
    Nothing,
    /// Arcs of one unknown duration. Before each, and before the last arc of the sequence, one of
    /// two axes flips, alternately.
    Alternating { axes: [usize; 2], arcs: usize },
    /// Fixed arcs before and after a dwell of unknown duration at a rate of the given norm; with a
    /// dwell by the angle `x` the whole interior is `cos(x / 2) even + sin(x / 2) odd`.
    Dwelling {
        even: QuatInterval,
        odd: QuatInterval,
        speed: Interval,
    },
}

/// An arc sequence without the durations of its terminal arcs.
#[derive(Debug, Clone)]
pub(super) struct ArcSequence {
    pub(super) first: Octant,
    pub(super) last: Octant,
    /// Sum of the known durations.
    pub(super) fixed: Interval,
    pub(super) interior: InteriorArcs,
}

impl ArcSequence {
    /// The sequence in which two axes flip alternately, with so many interior arcs.
    pub(super) fn alternating(first: Octant, axes: [usize; 2], arcs: usize) -> Self {
        let last = (0..=arcs).fold(first, |octant, flip| flipped(octant, axes[flip % 2]));
        Self {
            first,
            last,
            fixed: Interval::ZERO,
            interior: InteriorArcs::Alternating { axes, arcs },
        }
    }

    /// Number of arcs with the unknown duration.
    pub(super) fn repeats(&self) -> f64 {
        match self.interior {
            InteriorArcs::Nothing => 0.0,
            InteriorArcs::Alternating { arcs, .. } => arcs as f64,
            InteriorArcs::Dwelling { .. } => 1.0,
        }
    }

    /// Upper bound on the sum of the speeds of all arcs with the unknown duration.
    pub(super) fn speed(&self) -> f64 {
        match &self.interior {
            InteriorArcs::Dwelling { speed, .. } => speed.high,
            _ => self.repeats(),
        }
    }

    /// The turn of the interior for a value of the unknown, with its derivative.
    pub(super) fn at(&self, rates: &Rates, unknown: f64) -> Moving {
        match &self.interior {
            InteriorArcs::Nothing => Moving::NONE,
            InteriorArcs::Alternating { axes, arcs } => {
                let (sin, cos) = Interval::exactly(0.5 * unknown).sin_cos();
                self.chain(rates, *axes, *arcs, sin, cos)
            }
            InteriorArcs::Dwelling { even, odd, speed } => {
                let (sin, cos) = (Interval::exactly(0.5 * unknown) * *speed).sin_cos();
                let half = speed.half();
                Moving {
                    turn: sum(&scaled(even, cos), &scaled(odd, sin)),
                    slope: sum(&scaled(even, -(sin * half)), &scaled(odd, cos * half)),
                }
            }
        }
    }

    /// The product of alternating arcs, which repeat with period four, by repeated squaring.
    fn chain(
        &self,
        rates: &Rates,
        axes: [usize; 2],
        arcs: usize,
        sin: Interval,
        cos: Interval,
    ) -> Moving {
        let mut octant = self.first;
        let steps: Vec<Moving> = (0..arcs.min(4))
            .map(|flip| {
                octant = flipped(octant, axes[flip % 2]);
                let c = rates.corner(octant);
                let turn = [c[0] * sin, c[1] * sin, c[2] * sin, cos];
                // d/dp exp(p c) = exp(p c) c / 2.
                let slope = times_vector(&turn, &c).map(Interval::half);
                Moving { turn, slope }
            })
            .collect();
        let joined = |steps: &[Moving]| {
            steps
                .iter()
                .skip(1)
                .fold(steps[0], |all, next| all.then(next))
        };
        if arcs < 4 {
            return joined(&steps);
        }
        let (mut all, mut power, mut block) = (Moving::NONE, arcs / 4, joined(&steps));
        loop {
            if power % 2 == 1 {
                all = all.then(&block);
            }
            power /= 2;
            if power == 0 {
                break;
            }
            block = block.then(&block);
        }
        steps[..arcs % 4]
            .iter()
            .fold(all, |all, next| all.then(next))
    }
}
