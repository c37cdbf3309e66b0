//! The extremals as arc sequences: a first arc, an interior that depends on one parameter, a last
//! arc.
//!
//! Every sequence starts in the octant `(+, +, +)` or `(-, -, -)`. The other six follow by
//! conjugation with half turns about the body axes, which the search applies to the target instead.

use super::levels::{Levels, RANGE_SLACK, others};
use super::turns::{about, chain, cross, dot, rotate};
use crate::math::quaternion::{Quat, conjugate, product};
use std::f64::consts::TAU;

/// Signs of the rates: bit `i` is set where `w_i` is negative.
pub(super) type OctantBits = usize;

/// The octants in which sequences start, by the index of their sense.
pub(super) const FIRST: [OctantBits; 2] = [0b000, 0b111];

/// The rate vector of an octant.
pub(super) fn corner(c: &[f64; 3], octant: OctantBits) -> [f64; 3] {
    [0, 1, 2].map(|i| if octant >> i & 1 == 1 { -c[i] } else { c[i] })
}

/// The product of the signs of an octant; the folded costate moves in the opposite sense.
pub(super) fn sense(octant: OctantBits) -> i32 {
    if octant.count_ones().is_multiple_of(2) {
        1
    } else {
        -1
    }
}

/// An arc of an interior.
#[derive(Debug, Clone, Copy)]
pub(super) struct InteriorArc {
    /// Rate vector: a corner, or on a dwell a face diagonal.
    pub(super) rate: [f64; 3],
    /// Its duration; `None` where it is the parameter.
    pub(super) duration: Option<f64>,
}

/// A sequence whose parameter `p` is the duration of one arc. With `x = speed p` the interior is
/// `P = cos(x / 2) U + sin(x / 2) W`, and the equation for `x` is a sinusoid.
#[derive(Debug, Clone)]
pub(super) struct ClosedFormSequence {
    /// Index into [`FIRST`].
    pub(super) first: usize,
    pub(super) last: OctantBits,
    /// Sum of the fixed durations.
    pub(super) fixed: f64,
    pub(super) speed: f64,
    /// Range of the parameter.
    pub(super) range: (f64, f64),
    /// Whether the terminal arcs may be no longer than the parameter.
    pub(super) capped: bool,
    /// `c_first . P c_last = offset + amplitude cos(x - phase)`.
    pub(super) offset: f64,
    pub(super) amplitude: f64,
    pub(super) phase: f64,
    pub(super) even: Quat,
    pub(super) odd: Quat,
    pub(super) steps: Vec<InteriorArc>,
}

impl ClosedFormSequence {
    /// The sequence with these interior arcs, one of which has no duration.
    pub(super) fn new(
        c: &[f64; 3],
        first: usize,
        steps: Vec<InteriorArc>,
        last: OctantBits,
        range: (f64, f64),
        capped: bool,
    ) -> Option<Self> {
        let at = steps.iter().position(|step| step.duration.is_none())?;
        let turn = |step: &InteriorArc| {
            let speed = dot(&step.rate, &step.rate).sqrt();
            about(
                &step.rate.map(|r| r / speed),
                speed * step.duration.unwrap_or(0.0),
            )
        };
        let before = chain(&steps[..at].iter().map(turn).collect::<Vec<_>>());
        let after = chain(&steps[at..].iter().map(turn).collect::<Vec<_>>());
        let rate = steps[at].rate;
        let speed = dot(&rate, &rate).sqrt();
        let axis = rate.map(|r| r / speed);
        let from = rotate(&conjugate(&before), &corner(c, FIRST[first]));
        let to = rotate(&after, &corner(c, last));
        let offset = dot(&from, &axis) * dot(&axis, &to);
        let (cos, sin) = (dot(&from, &to) - offset, dot(&from, &cross(&axis, &to)));
        Some(Self {
            first,
            last,
            fixed: steps.iter().filter_map(|step| step.duration).sum(),
            speed,
            range,
            capped,
            offset,
            amplitude: cos.hypot(sin),
            phase: sin.atan2(cos),
            even: product(&before, &after),
            odd: product(&product(&before, &[axis[0], axis[1], axis[2], 0.0]), &after),
            steps,
        })
    }
}

/// The regular sequences of a gap: two axes flip alternately, and all interior arcs have one
/// duration.
#[derive(Debug, Clone)]
pub(super) struct SequenceFamily {
    /// The axis that never flips, near which the costate stays; `None` for the far side and for a
    /// single wall.
    pub(super) vertex: Option<usize>,
    /// The axes that flip, first and second, for each of [`FIRST`].
    pub(super) flips: [[usize; 2]; 2],
    /// Range of the length of the gap.
    pub(super) range: (f64, f64),
}

impl SequenceFamily {
    /// All families of a set of levels.
    pub(super) fn all(levels: &Levels) -> Vec<Self> {
        let c = &levels.c;
        let mut families: Vec<Self> = (0..3)
            .map(|i| {
                let (j, k) = others(i);
                Self {
                    vertex: Some(i),
                    flips: [[j, k], [k, j]],
                    range: (0.0, levels.longest_gap(i)),
                }
            })
            .collect();
        // Largest, middle and smallest rate: the walls vanish in this order.
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| c[j].total_cmp(&c[i]));
        let [a, b, z] = order;
        let (j, k) = others(a);
        let around = |h: f64| levels.far_gap(a, h);
        families.push(Self {
            vertex: None,
            flips: [[k, j], [j, k]],
            range: (
                around(levels.saddle[a]) - RANGE_SLACK,
                around(levels.saddle[b]) + RANGE_SLACK,
            ),
        });
        families.push(Self {
            vertex: None,
            flips: [[z, z]; 2],
            range: (
                levels.single_wall_gap(z, levels.saddle[b]) - RANGE_SLACK,
                TAU,
            ),
        });
        families
    }

    /// The octant after a number of flips.
    pub(super) fn octant(&self, first: usize, flips: usize) -> OctantBits {
        let [one, two] = self.flips[first];
        let mut octant = FIRST[first];
        if flips.div_ceil(2) % 2 == 1 {
            octant ^= 1 << one;
        }
        if flips / 2 % 2 == 1 {
            octant ^= 1 << two;
        }
        octant
    }

    /// The interior of the sequence with a number of flips.
    pub(super) fn steps(&self, c: &[f64; 3], first: usize, flips: usize) -> Vec<InteriorArc> {
        (1..flips)
            .map(|arc| InteriorArc {
                rate: corner(c, self.octant(first, arc)),
                duration: None,
            })
            .collect()
    }

    /// The sequence with two flips, whose parameter is the duration of one arc.
    pub(super) fn two_flips(&self, c: &[f64; 3], first: usize) -> Option<ClosedFormSequence> {
        let steps = self.steps(c, first, 2);
        ClosedFormSequence::new(c, first, steps, self.octant(first, 2), self.range, true)
    }
}
