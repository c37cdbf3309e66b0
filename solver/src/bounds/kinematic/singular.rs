//! The sequences with a dwell: extremals on the level of a saddle.
//!
//! The costate may rest on the saddle `M_j = 0`, where `M` and the rate are parallel to the face
//! diagonal; on leaving, `w_j` has either sign. At a later visit it passes or is reflected. All
//! dwells of an extremal are turns about the same axis in space and may be moved to the first
//! visit. Between visits the level determines the durations of the arcs.

use super::levels::Levels;
use super::sequences::{ClosedFormSequence, FIRST, InteriorArc, OctantBits, corner, sense};
use super::turns::{about, best_axis_sequence, eigenaxis_time};
use crate::math::quaternion::{Quat, product};
use std::f64::consts::{PI, TAU};

/// Largest number of arcs of an interior.
const MAX_STEPS: usize = 500;
/// Relative saving from which a turn that replaces some fixed arcs shows that they are no part of a
/// shortest motion.
const CLEARLY_SHORTER: f64 = 1e-6;

/// What the folded costate reaches on its circle.
#[derive(Debug, Clone, Copy)]
enum CostateEvent {
    /// A saddle, where the sign of an axis is free.
    Saddle(usize),
    /// The wall of an axis, met when moving in the given direction.
    Wall(usize, i32),
}

/// One level with its saddles and walls, by azimuth.
struct Circle<'a> {
    c: &'a [f64; 3],
    horizon: f64,
    limit: usize,
    events: Vec<(f64, CostateEvent)>,
    sequences: &'a mut Vec<ClosedFormSequence>,
}

/// The end of a sequence under construction.
#[derive(Clone, Copy)]
struct PartialSequence {
    /// Index of the first octant.
    first: usize,
    octant: OctantBits,
    event: usize,
    direction: i32,
    /// Index of the dwell among the steps.
    dwell: Option<usize>,
    /// Sum of the fixed arcs so far.
    fixed: f64,
}

/// All dwelling sequences whose fixed arcs last less than the horizon; `None` if there are more
/// than the limit.
pub(super) fn sequences(
    levels: &Levels,
    horizon: f64,
    limit: usize,
) -> Option<Vec<ClosedFormSequence>> {
    let mut found = Vec::new();
    for j in 0..3 {
        let h = levels.saddle[j];
        let same = |k: usize| levels.same_rate(j, k);
        if (0..j).any(same) {
            continue;
        }
        let mut events = Vec::new();
        for k in 0..3 {
            let centre = levels.azimuth[k] + PI;
            if same(k) {
                events.push((centre.rem_euclid(TAU), CostateEvent::Saddle(k)));
            } else if levels.saddle[k] > h {
                let half = levels.half_width(k, h);
                events.push(((centre - half).rem_euclid(TAU), CostateEvent::Wall(k, 1)));
                events.push(((centre + half).rem_euclid(TAU), CostateEvent::Wall(k, -1)));
            }
        }
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut circle = Circle {
            c: &levels.c,
            horizon,
            limit,
            events,
            sequences: &mut found,
        };
        for first in 0..FIRST.len() {
            let direction = -sense(FIRST[first]);
            for event in 0..circle.events.len() {
                if matches!(circle.events[event].1, CostateEvent::Wall(_, met) if met != direction)
                {
                    continue;
                }
                let place = PartialSequence {
                    first,
                    octant: FIRST[first],
                    event,
                    direction,
                    dwell: None,
                    fixed: 0.0,
                };
                circle.follow(place, &mut Vec::new())?;
            }
        }
    }
    found.sort_by(|a, b| a.fixed.total_cmp(&b.fixed));
    Some(found)
}

impl Circle<'_> {
    /// Continues from an event in all possible ways.
    fn follow(&mut self, at: PartialSequence, steps: &mut Vec<InteriorArc>) -> Option<()> {
        match self.events[at.event].1 {
            CostateEvent::Wall(axis, _) => {
                self.leave(at, at.octant ^ (1 << axis), -at.direction, steps)
            }
            CostateEvent::Saddle(axis) if at.dwell.is_none() => {
                let mut rate = corner(self.c, at.octant);
                rate[axis] = 0.0;
                let dwell = Some(steps.len());
                steps.push(InteriorArc {
                    rate,
                    duration: None,
                });
                let at = PartialSequence { dwell, ..at };
                for octant in [at.octant, at.octant ^ (1 << axis)] {
                    self.leave(at, octant, -sense(octant), steps)?;
                }
                steps.pop();
                Some(())
            }
            CostateEvent::Saddle(axis) => {
                self.leave(at, at.octant, at.direction, steps)?;
                self.leave(at, at.octant ^ (1 << axis), -at.direction, steps)
            }
        }
    }

    /// Continues from an event in an octant: adds the sequence that ends with this arc, and follows
    /// the arc to the next event.
    fn leave(
        &mut self,
        at: PartialSequence,
        octant: OctantBits,
        direction: i32,
        steps: &mut Vec<InteriorArc>,
    ) -> Option<()> {
        if at.dwell.is_some() {
            if self.sequences.len() == self.limit {
                return None;
            }
            let range = (0.0, f64::INFINITY);
            let sequence =
                ClosedFormSequence::new(self.c, at.first, steps.clone(), octant, range, false);
            self.sequences.extend(sequence);
        }
        // Prevents endless recursion if rounding makes arcs vanish.
        if steps.len() == MAX_STEPS {
            return None;
        }
        let count = self.events.len();
        let event = (at.event + count).saturating_add_signed(direction as isize) % count;
        let mut arc = (f64::from(direction) * (self.events[event].0 - self.events[at.event].0))
            .rem_euclid(TAU);
        if event == at.event {
            arc = TAU;
        }
        // A second wall before any saddle: this sequence has no dwell.
        if at.dwell.is_none() && matches!(self.events[event].1, CostateEvent::Wall(..)) {
            return Some(());
        }
        steps.push(InteriorArc {
            rate: corner(self.c, octant),
            duration: Some(arc),
        });
        let next = PartialSequence {
            octant,
            event,
            direction,
            fixed: at.fixed + arc,
            ..at
        };
        if next.fixed < self.horizon && !self.replaceable(steps, at.dwell) {
            self.follow(next, steps)?;
        }
        steps.pop();
        Some(())
    }

    /// Whether some of the last arcs, at most those since the dwell, can be replaced by a faster
    /// turn: then no shortest motion contains them.
    fn replaceable(&self, steps: &[InteriorArc], dwell: Option<usize>) -> bool {
        let begin = dwell.map_or(0, |at| at + 1);
        let mut turn: Quat = [0.0, 0.0, 0.0, 1.0];
        let mut lasted = 0.0;
        steps[begin..].iter().rev().any(|step| {
            let duration = step.duration.unwrap_or(0.0);
            turn = product(&about(&step.rate, duration), &turn);
            lasted += duration;
            let shorter = lasted * (1.0 - CLEARLY_SHORTER);
            // No turn is faster than its angle.
            let angle = 2.0 * turn[3].abs().min(1.0).acos();
            if angle >= shorter {
                return false;
            }
            eigenaxis_time(&turn, self.c) < shorter || best_axis_sequence(&turn, self.c).0 < shorter
        })
    }
}
