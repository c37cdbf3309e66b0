//! Extremals whose costate stays near a minimum of the support function, refuted all together.
//!
//! A minimum is the normal `n` of a facet, at the distance `a`, that contains the foot `a n` of the perpendicular. With
//! the distance `r` of the foot from the facet's border, the support function at an angle `e` from `n` is at least
//! `a cos e + r sin e`. So an extremal that begins within the least angle `e` at which this exceeds its level stays
//! within. As `A = R M` is fixed in space, the turn then swings `n` by at most `2 e`; and twists about it at the rate
//! `n . w` and a drift of at most `tan(e) |w|` ([`super::super::near_axis`]), with `n . w <= a` within the polytope and
//! `n . w >= h - 2 sin(e / 2) |w|` since `M . w = h`. The costate at rest at `n`, with a turn about it, is among these.

use super::super::turn::{QuatInterval, VectorInterval, cross, dot, least_turn, swing, twist};
use super::faces::Facet;
use crate::bounds::interval::Interval;

/// Angle, rad, far above the rounding of a cell of costates.
const NEAR: f64 = 1e-9;

/// Swing and twist of a turn about the normal of a facet.
#[derive(Debug)]
pub(super) struct NearMinimum<'a> {
    facet: &'a Facet,
    /// Lower bound on the swing, rad.
    swing: f64,
    /// Lower bound on the twist, rad.
    twist: f64,
}

/// What is known of the extremals from a costate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Nearness {
    /// They do not stay near the minimum, or it is not known.
    Unknown,
    /// They stay near and do not make the turn in the time.
    Refuted,
    /// They stay near, and may make the turn.
    Open,
}

impl<'a> NearMinimum<'a> {
    /// `None` where the facet does not contain the foot of its perpendicular.
    pub(super) fn of(facet: &'a Facet, turn: &QuatInterval) -> Option<Self> {
        (facet.inside.high > 0.0).then(|| Self {
            facet,
            swing: swing(turn, &facet.normal).low,
            twist: least_turn(twist(turn, &facet.normal)),
        })
    }

    /// What is known of the extremals of some levels from a costate, for a time.
    pub(super) fn refutes(&self, costate: &VectorInterval, level: Interval, time: f64) -> Nearness {
        let Facet {
            normal,
            distance,
            inside,
        } = self.facet;
        if dot(costate, normal).low <= 0.0 {
            return Nearness::Unknown;
        }
        let [x, y, z] = cross(costate, normal);
        let off = x.length(y).length(z);
        // At the normal itself nothing else is known of an extremal.
        let otherwise = if off.low <= 0.0 {
            Nearness::Open
        } else {
            Nearness::Unknown
        };
        // a cos e + r sin e = b cos(e - e_0)
        let inside = Interval::exactly(inside.low.max(0.0));
        let largest = distance.length(inside);
        let share = Interval::exactly(level.high) / largest;
        if share.high >= 1.0 {
            return otherwise;
        }
        let steepest = Interval::angle(inside, *distance);
        let widest = (steepest - share.acos()).high.max(NEAR);
        if widest >= steepest.low {
            return otherwise;
        }
        let (sin, cos) = Interval::exactly(widest).sin_cos();
        if off.high >= sin.low {
            return otherwise;
        }
        if self.swing > 2.0 * widest {
            return Nearness::Refuted;
        }
        let drift = sin / cos;
        // 2 sin(e / 2) <= e
        let forward = Interval::exactly(level.low) - Interval::exactly(widest) - drift;
        if cos.low <= 0.0 || forward.low <= 0.0 {
            return otherwise;
        }
        let least = Interval::exactly(self.twist) / (*distance + drift);
        if least.low >= time {
            Nearness::Refuted
        } else {
            otherwise
        }
    }
}
