//! The sequences with a dwell, from the motion of the costate.
//!
//! On the level of the saddle `M_j = 0` let the costate leave it in an octant with signs `s`. With
//! `n` the corner of the octant (length one), `M(t) = h n + cos t (M - h n) + sin t M x n`, and the
//! components other than `j`, times their signs, are
//!
//! ```text
//!   h c_k + (c_k c_j^2 / h) cos t +- (c_j c_l / h) sin t,   h = hypot(c_k, c_l)
//! ```
//!
//! with the upper sign for the one of `k, l` that follows `j` in cyclic order if the product of the
//! signs is positive, and for the other one if it is negative. At the first zero of these an axis
//! flips; from there the folded costate returns on the same path and reaches the saddle again after
//! the same time, where `w_j` may have either sign. (A component whose rate exceeds that of `j`
//! never reaches zero; component `j` itself touches zero only after a whole turn.)

use super::rates::{Octant, Rates, flipped, octants};
use super::sequence::{ArcSequence, InteriorArcs};
use super::turn::{IDENTITY, QuatInterval, VectorInterval, about, product};
use crate::bounds::interval::Interval;

/// Relative saving from which a turn that replaces some fixed arcs shows that they are no part of a
/// shortest motion. Any saving would do; the margin avoids ties.
const SHORTER: f64 = 1e-6;

/// Arcs of known duration, in order.
type FixedArcs = Vec<(Octant, Interval)>;

/// The enumeration of the sequences of one saddle.
struct Saddle<'a> {
    rates: &'a Rates,
    /// The axis whose rate is zero during the dwell.
    axis: usize,
    /// Sequences whose fixed arcs last longer than this are left out.
    horizon: f64,
    limit: usize,
    sequences: Vec<ArcSequence>,
}

/// All sequences with a dwell whose fixed arcs last less than the horizon: `None` if there are more
/// than the limit.
pub(super) fn sequences(rates: &Rates, horizon: f64, limit: usize) -> Option<Vec<ArcSequence>> {
    let mut sequences = Vec::new();
    for axis in 0..3 {
        let mut saddle = Saddle {
            rates,
            axis,
            horizon,
            limit,
            sequences,
        };
        // The octant in which the costate reaches the saddle: in the first arc, or after a flip.
        for octant in octants() {
            saddle.begin(octant, None)?;
            for (wall, time) in saddle.walls(octant, true) {
                saddle.begin(flipped(octant, wall), Some((octant, time)))?;
            }
        }
        sequences = saddle.sequences;
    }
    Some(sequences)
}

impl Saddle<'_> {
    /// The axis that flips first after the costate leaves the saddle in an octant, and the time
    /// until then; `backwards`, the last flip before it reaches the saddle. Several if intervals
    /// cannot decide which comes first; none if it is more than half a turn away, as longer arcs
    /// are no part of a shortest motion.
    fn walls(&self, octant: Octant, backwards: bool) -> Vec<(usize, Interval)> {
        let c = &self.rates.c;
        let (j, k, l) = (self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3);
        let h = c[k].length(c[l]);
        let negative = octant.iter().filter(|sign| **sign).count() % 2 == 1;
        let mut found: Vec<(usize, Interval)> = Vec::new();
        for (axis, other, upper) in [(k, l, true), (l, k, false)] {
            let rises = (upper != negative) != backwards;
            let constant = h * c[axis];
            let cosine = c[axis] * c[j].squared() / h;
            let sine = c[j] * c[other] / h;
            let length = cosine.length(sine);
            if constant.low > length.high {
                continue;
            }
            let phase = Interval::angle(if rises { sine } else { -sine }, cosine);
            found.push((axis, phase + (-(constant / length)).acos()));
        }
        let first = found
            .iter()
            .fold(Interval::PI.high, |first, (_, time)| first.min(time.high));
        found.retain(|(_, time)| time.low <= first);
        found
    }

    /// Sequences whose dwell follows either the first arc, in an octant, or the `fixed` arc after
    /// it.
    fn begin(&mut self, first: Octant, fixed: Option<(Octant, Interval)>) -> Option<()> {
        let arrives = fixed.map_or(first, |(octant, _)| octant);
        let before: FixedArcs = fixed.into_iter().collect();
        let lasted = fixed.map_or(Interval::ZERO, |(_, time)| time);
        for leaves in [arrives, flipped(arrives, self.axis)] {
            self.follow(first, &before, leaves, &mut Vec::new(), lasted)?;
        }
        Some(())
    }

    /// Sequences that continue from a visit of the saddle in an octant.
    fn follow(
        &mut self,
        first: Octant,
        before: &FixedArcs,
        leaves: Octant,
        after: &mut FixedArcs,
        lasted: Interval,
    ) -> Option<()> {
        self.add(first, before, after, leaves, lasted)?;
        for (wall, time) in self.walls(leaves, false) {
            let returns = flipped(leaves, wall);
            after.push((leaves, time));
            if (lasted + time).low < self.horizon && !self.replaceable(after) {
                self.add(first, before, after, returns, lasted + time)?;
                let lasted = lasted + time + time;
                after.push((returns, time));
                if lasted.low < self.horizon && !self.replaceable(after) {
                    for next in [returns, flipped(returns, self.axis)] {
                        self.follow(first, before, next, after, lasted)?;
                    }
                }
                after.pop();
            }
            after.pop();
        }
        Some(())
    }

    fn add(
        &mut self,
        first: Octant,
        before: &FixedArcs,
        after: &FixedArcs,
        last: Octant,
        fixed: Interval,
    ) -> Option<()> {
        if self.sequences.len() == self.limit {
            return None;
        }
        // The face is that of the octant before the dwell.
        let face = before.last().map_or(first, |(octant, _)| *octant);
        let mut rate = self.rates.corner(face);
        rate[self.axis] = Interval::ZERO;
        let (k, l) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let speed = rate[k].length(rate[l]);
        let direction: VectorInterval = rate.map(|w| w / speed);
        let [x, y, z] = direction;
        let (before, after) = (self.turn(before), self.turn(after));
        self.sequences.push(ArcSequence {
            first,
            last,
            fixed,
            interior: InteriorArcs::Dwelling {
                even: product(&before, &after),
                odd: product(&product(&before, &[x, y, z, Interval::ZERO]), &after),
                speed,
            },
        });
        Some(())
    }

    fn turn(&self, arcs: &[(Octant, Interval)]) -> QuatInterval {
        arcs.iter().fold(IDENTITY, |all, (octant, time)| {
            product(&all, &about(&self.rates.corner(*octant), *time))
        })
    }

    /// Whether some of the last arcs can be replaced by a faster turn.
    fn replaceable(&self, arcs: &FixedArcs) -> bool {
        (0..arcs.len()).any(|from| {
            let lasts = arcs[from..]
                .iter()
                .fold(Interval::ZERO, |sum, (_, time)| sum + *time);
            self.rates.eigenaxis(&self.turn(&arcs[from..])) < lasts.low * (1.0 - SHORTER)
        })
    }
}
