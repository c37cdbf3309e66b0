//! The terminal arcs with which a sequence reaches its target: closed forms, and bounds over a
//! cell.
//!
//! With `A = t_0 / 2`, `B = t_f / 2` and the interior `P`,
//!
//! ```text
//!   <q, exp(t_0 c_0) P exp(t_f c_f)> = C1 cos(A + B - u) + C2 cos(A - B - v),   C1 + C2 <= 1
//! ```
//!
//! where `C1 (cos u, sin u)` and `C2 (cos v, sin v)` are linear in `P`. The target is reached when
//! the absolute value of the sum is one, with both cosines of the same sign.

use super::sequences::{FIRST, OctantBits, corner};
use crate::math::quaternion::{Quat, dot4, product};
use std::f64::consts::{FRAC_PI_2, PI};

/// Allowance for rounding in `C1 + C2`. Each is the length of a pair of scalar products of four
/// terms of at most one, of quaternions that are unit to 1e-14; the sum is accurate to 5e-14.
const ROUNDING: f64 = 1e-13;
/// Rounding of the scalar products in `C1 (cos u, sin u)`: an error of this size over `C1` in `u`.
/// (Errors of the interior itself are within the margin by which cells are widened.)
const COMPONENT: f64 = 2e-15;

/// The target for sequences that begin and end in given octants.
#[derive(Debug, Clone, Copy)]
pub(super) struct Probe<'a> {
    image: &'a Image,
    /// Index of the last octant, or of its opposite.
    last: usize,
    /// Signs of the first and of the last octant.
    signs: [f64; 2],
    /// `c_0 . R c_f`.
    pub(super) target: f64,
}

/// An image of half the target's quaternion `q` under a half turn, with its products with the
/// corners. Opposite octants differ in signs only.
#[derive(Debug)]
struct Image {
    /// `q / 2` and `c_0 q / 2`.
    target: [Quat; 2],
    /// `q c_f / 2` and `c_0 q c_f / 2`.
    ends: [[Quat; 2]; 4],
    /// `c_0 . R c_f`.
    cosines: [f64; 4],
}

/// The four images of a target under half turns about the body axes.
#[derive(Debug)]
pub(super) struct Probes([Image; 4]);

/// Signs of the body axes under the half turns that make the images.
pub(super) const IMAGES: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];

/// An image of a turn under conjugation by a half turn about a body axis.
pub(super) fn image_of(q: &Quat, image: usize) -> Quat {
    let signs = &IMAGES[image];
    [q[0] * signs[0], q[1] * signs[1], q[2] * signs[2], q[3]]
}

impl Probes {
    pub(super) fn new(q: &Quat, c: &[f64; 3]) -> Self {
        let pure = |octant: OctantBits| {
            let [x, y, z] = corner(c, octant);
            [x, y, z, 0.0]
        };
        Self([0, 1, 2, 3].map(|image| {
            let half = image_of(q, image).map(|x| 0.5 * x);
            let before = product(&pure(FIRST[0]), &half);
            let ends = [0, 1, 2, 3].map(|last| {
                let end = pure(last);
                [product(&half, &end), product(&before, &end)]
            });
            Image {
                target: [half, before],
                cosines: ends.map(|[after, _]| 4.0 * dot4(&before, &after)),
                ends,
            }
        }))
    }

    pub(super) fn of(&self, image: usize, first: usize, last: OctantBits) -> Probe<'_> {
        let image = &self.0[image];
        let (last, sign) = if last < 4 {
            (last, 1.0)
        } else {
            (7 - last, -1.0)
        };
        let signs = [if first == 0 { 1.0 } else { -1.0 }, sign];
        Probe {
            image,
            last,
            signs,
            target: signs[0] * signs[1] * image.cosines[last],
        }
    }
}

/// Half durations of the terminal arcs, modulo half a turn, with bounds on their error over a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct TerminalArcs {
    u: f64,
    v: f64,
    du: f64,
    dv: f64,
    c1: f64,
    c2: f64,
    /// `A` and `B` at the cell's centre.
    pub(super) first: f64,
    pub(super) last: f64,
}

impl Probe<'_> {
    /// The terminal arcs for an interior that is known within a turn of `2 half_eta`, rad; `None`
    /// when no terminal arcs reach the target.
    pub(super) fn terminal_arcs(&self, interior: &Quat, half_eta: f64) -> Option<TerminalArcs> {
        // <q, P>, <c_0* q, P>, <q c_f*, P> and <c_0* q c_f*, P>, halved.
        let [first, last] = self.signs;
        let [after, both] = &self.image.ends[self.last];
        let plain = dot4(&self.image.target[0], interior);
        let begun = -first * dot4(&self.image.target[1], interior);
        let ended = -last * dot4(after, interior);
        let both = first * last * dot4(both, interior);
        let (x1, y1, x2, y2) = (plain - both, begun + ended, plain + both, begun - ended);
        let (c1, c2) = ((x1 * x1 + y1 * y1).sqrt(), (x2 * x2 + y2 * y2).sqrt());
        // The sum must reach the cosine of half the turn within which the interior is known, where
        // cos x >= 1 - x^2 / 2. As the sum never exceeds one, its excess over this value is at most
        // `drop`, whatever its rounding.
        let drop = 0.5 * half_eta * half_eta;
        let excess = (c1 + c2 - (1.0 - drop) + ROUNDING).min(drop);
        if excess < 0.0 {
            return None;
        }
        let (u, v) = (y1.atan2(x1), y2.atan2(x2));
        Some(TerminalArcs {
            u,
            v,
            du: widest(excess, c1),
            dv: widest(excess, c2),
            c1,
            c2,
            first: (0.5 * (u + v)).rem_euclid(PI),
            last: (0.5 * (u - v)).rem_euclid(PI),
        })
    }
}

/// An upper bound on `acos(1 - excess / size)`, which is `2 asin(s)` with
/// `s^2 = excess / (2 size)`, from `asin s <= s + (pi / 2 - 1) s^3` (all terms of the series are
/// positive), with an allowance for rounding.
fn widest(excess: f64, size: f64) -> f64 {
    if excess >= 2.0 * size {
        return PI;
    }
    let s = (0.5 * excess / size).sqrt();
    (2.0 * s * (1.0 + (FRAC_PI_2 - 1.0) * s * s) + COMPONENT / size).min(PI)
}

impl TerminalArcs {
    /// Lower bound on `A + B` over the cell; `None` when a terminal arc must exceed `2 cap`.
    pub(super) fn least(&self, cap: f64) -> Option<f64> {
        let spread = 0.5 * (self.du + self.dv);
        if spread >= FRAC_PI_2 {
            // One of the angles is poorly known: use the other, which is known modulo pi.
            let (u, v) = (self.u.rem_euclid(PI), self.v.rem_euclid(PI));
            let by_sum = if u + self.du < PI { u - self.du } else { 0.0 };
            return Some(by_sum.max(v.min(PI - v) - self.dv).max(0.0));
        }
        // An angle near half a turn may be near zero within its error.
        let low_side = |x: f64| if x + spread >= PI { x - PI } else { x };
        let (first, last) = (low_side(self.first), low_side(self.last));
        let (least_first, least_last) = ((first - spread).max(0.0), (last - spread).max(0.0));
        if least_first > cap || least_last > cap {
            return None;
        }
        let by_parts = (first + last - self.du).max((first - last).abs() - self.dv);
        Some(by_parts.max(least_first + least_last))
    }

    /// Half durations of the terminal arcs to try, with the cosine of half the miss: those at the
    /// cell's centre, and zero in place of nearly half a turn.
    pub(super) fn candidates(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let choices = |x: f64| [Some(x), (x > 3.0).then_some(0.0)].into_iter().flatten();
        choices(self.first).flat_map(move |first| {
            choices(self.last).map(move |last| {
                let cosine = self.c1 * (first + last - self.u).cos()
                    + self.c2 * (first - last - self.v).cos();
                (first, last, cosine.abs())
            })
        })
    }
}
