//! The interior of a sequence with several arcs of one duration, and the parts of a cell in which
//! its equation can hold.

use super::sequences::{SequenceFamily, corner};
use super::turns::rotate;
use crate::math::quaternion::{Quat, product};

/// Margin in the equation `f = 0`, rad. Rounding of `f` is below 1e-12 even for a thousand arcs.
pub(super) const MARGIN: f64 = 1e-10;

/// The turn of a sequence's interior at a value of its parameter.
#[derive(Clone, Copy)]
pub(super) struct InteriorTurn {
    pub(super) turn: Quat,
    /// Its derivative by the parameter, as an angular velocity in the frame of its beginning.
    pub(super) velocity: [f64; 3],
}

impl InteriorTurn {
    pub(super) const NONE: Self = Self {
        turn: [0.0, 0.0, 0.0, 1.0],
        velocity: [0.0; 3],
    };

    fn then(&self, next: &Self) -> Self {
        let carried = rotate(&self.turn, &next.velocity);
        Self {
            turn: product(&self.turn, &next.turn),
            velocity: [0, 1, 2].map(|i| self.velocity[i] + carried[i]),
        }
    }

    /// The interior of a sequence: its arcs repeat with period four.
    pub(super) fn of(
        c: &[f64; 3],
        family: &SequenceFamily,
        first: usize,
        flips: usize,
        parameter: f64,
    ) -> Self {
        let (sin, cos) = (0.5 * parameter).sin_cos();
        let arc = |m: usize| {
            let rate = corner(c, family.octant(first, m));
            Self {
                turn: [rate[0] * sin, rate[1] * sin, rate[2] * sin, cos],
                velocity: rate,
            }
        };
        let arcs = flips - 1;
        let mut all = Self::NONE;
        if arcs >= 4 {
            let mut block = (2..=4).fold(arc(1), |all, m| all.then(&arc(m)));
            let mut power = arcs / 4;
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
        }
        for m in 1..=arcs % 4 {
            all = all.then(&arc(m));
        }
        all
    }
}

/// The parts of `[-half, half]` in which a function can be zero up to the margin. The function has
/// the given value and slope at 0 and a second derivative of at most `curvature`.
pub(super) fn where_zero(
    value: f64,
    slope: f64,
    curvature: f64,
    half: f64,
) -> [Option<(f64, f64)>; 3] {
    let (value, slope) = if value < 0.0 {
        (-value, -slope)
    } else {
        (value, slope)
    };
    let kept = |from: f64, to: f64| {
        let (from, to) = (from.max(-half), to.min(half));
        (from <= to).then_some((from, to))
    };
    // Positive where value + slope x - curvature x^2 / 2 > margin: between these two.
    let above = value - MARGIN;
    if above <= 0.0 {
        return [kept(-half, half), None, None];
    }
    let root = (slope * slope + 2.0 * curvature * above).sqrt();
    let (left, right) = ((slope - root) / curvature, (slope + root) / curvature);
    // Negative where value + slope x + curvature x^2 / 2 < -margin: between these two, on one side.
    let inner = slope * slope - 2.0 * curvature * (value + MARGIN);
    if inner <= 0.0 {
        return [kept(-half, left), kept(right, half), None];
    }
    let root = inner.sqrt();
    let (far, near) = ((-slope - root) / curvature, (-slope + root) / curvature);
    if slope > 0.0 {
        [kept(-half, far), kept(near, left), kept(right, half)]
    } else {
        [kept(-half, left), kept(right, far), kept(near, half)]
    }
}
