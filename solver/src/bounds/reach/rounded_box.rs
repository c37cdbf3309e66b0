//! A box of rates, rounded outwards so that every costate is supported by one point, which depends on it smoothly.
//!
//! The box with half-widths `m` is the sum of its three segments `[-m_i, m_i] e_i`. Each is replaced by a body of
//! revolution around it whose outline are two arcs of circles through its tips, with a waist `e m_i`: arcs of radius
//! `m_i R` about centres that lie `m_i C` beyond the axis, `R = (1 + e^2) / 2 e`, `C = (1 - e^2) / 2 e`. For a costate `u`
//! of length one its support function is
//!
//! ```text
//!   m_i |u_i|                             where |u_i| >= WALL = 2 e / (1 + e^2), with the support point sign(u_i) m_i e_i
//!   m_i (R - C sqrt(1 - u_i^2))           elsewhere, with m_i (R u_i e_i + (R - C / sqrt(1 - u_i^2)) u_perp)
//! ```
//!
//! where `u_perp` is `u` without its component `i`. Both agree at the wall, since `R WALL = 1` and
//! `sqrt(1 - WALL^2) = C / R`. So outside all walls the support point of the sum is the corner of the box itself.

use super::form::{Form, VectorForm, each};
use crate::bounds::interval::Interval;
use nalgebra::Vector3;

/// The waist `e`.
pub(super) const WAIST: f64 = 0.03;
/// Radius and distance of the arcs.
const RADIUS: f64 = (1.0 + WAIST * WAIST) / (2.0 * WAIST);
const DISTANCE: f64 = (1.0 - WAIST * WAIST) / (2.0 * WAIST);
/// Half-width of the walls.
pub(super) const WALL: f64 = 2.0 * WAIST / (1.0 + WAIST * WAIST);
/// Rounding of the functions of this file, whose parts are below 20.
const ROUNDING: f64 = 1e-13;

/// `R u` in the wall, the sign outside.
fn tip(u: f64) -> f64 {
    (u / WALL).clamp(-1.0, 1.0)
}

/// `R - C / sqrt(1 - u^2)` in the wall, 0 outside.
fn waist(u: f64) -> f64 {
    if u.abs() >= WALL {
        return 0.0;
    }
    (RADIUS - DISTANCE / (1.0 - u * u).sqrt()).max(0.0)
}

fn waist_slope(u: f64) -> f64 {
    if u.abs() >= WALL {
        return 0.0;
    }
    -DISTANCE * u / (1.0 - u * u).powf(1.5)
}

fn level(u: f64) -> f64 {
    if u.abs() >= WALL {
        return u.abs();
    }
    RADIUS - DISTANCE * (1.0 - u * u).sqrt()
}

/// The support function across a vector of any length, for each axis per unit of its half-width.
pub(super) fn box_supports(across: &Vector3<f64>) -> [f64; 3] {
    let length = across.norm();
    each(|i| length * level(across[i] / length))
}

/// The point that supports a costate of length one.
pub(super) fn support(u: [f64; 3], m: [f64; 3]) -> [f64; 3] {
    let waists = each(|j| m[j] * waist(u[j]));
    let all: f64 = waists.iter().sum();
    each(|k| m[k] * tip(u[k]) + u[k] * (all - waists[k]))
}

/// A function near its chord, at most so far from it.
fn near_chord(
    u: &Form,
    hull: Interval,
    f: impl Fn(f64) -> f64,
    residual: impl Fn(f64) -> Interval,
) -> Form {
    let width = hull.high - hull.low;
    let slope = if width > 1e-12 {
        (f(hull.high) - f(hull.low)) / width
    } else {
        0.0
    };
    u.along_line(slope, residual(slope)).inflated(ROUNDING)
}

fn hull_of(values: &[f64]) -> Interval {
    Interval {
        low: values.iter().copied().fold(f64::INFINITY, f64::min),
        high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    }
}

/// The part of a range within the wall; `None` if there is none.
fn in_wall(hull: Interval) -> Option<Interval> {
    hull.common(Interval {
        low: -WALL,
        high: WALL,
    })
}

fn tip_form(u: &Form) -> Form {
    let hull = u.hull();
    if hull.low >= WALL {
        return Form::exactly(1.0);
    }
    if hull.high <= -WALL {
        return Form::exactly(-1.0);
    }
    near_chord(u, hull, tip, |slope| {
        let at = |x: f64| tip(x) - slope * x;
        let kinks = [-WALL, WALL].map(|x| at(x.clamp(hull.low, hull.high)));
        hull_of(&[at(hull.low), at(hull.high), kinks[0], kinks[1]])
    })
}

fn waist_form(u: &Form) -> Form {
    let hull = u.hull();
    let Some(wall) = in_wall(hull).filter(|wall| wall.low < wall.high) else {
        return Form::within(0.0, ROUNDING);
    };
    near_chord(u, hull, waist, |slope| {
        let at = |x: f64| waist(x) - slope * x;
        let ends = hull_of(&[at(hull.low), at(hull.high), at(wall.low), at(wall.high)]);
        // Concave in the wall: below its tangent.
        let middle = wall.middle();
        let tangent = (waist_slope(middle) - slope).abs() * 0.5 * (wall.high - wall.low);
        Interval {
            low: ends.low,
            high: ends.high.max(at(middle) + tangent),
        }
    })
}

pub(super) fn level_form(u: &Form) -> Form {
    let hull = u.hull();
    if hull.low >= WALL {
        return *u;
    }
    if hull.high <= -WALL {
        return u.scaled(-1.0);
    }
    near_chord(u, hull, level, |slope| {
        let at = |x: f64| level(x) - slope * x;
        // Convex: below its chord, above its tangent.
        let ends = hull_of(&[at(hull.low), at(hull.high)]);
        let middle = hull.middle();
        let tangent =
            (DISTANCE * middle / (1.0 - middle * middle).max(1e-3).sqrt()).clamp(-1.0, 1.0);
        let tangent = if middle.abs() >= WALL {
            middle.signum()
        } else {
            tangent
        };
        let below = (tangent - slope).abs() * 0.5 * (hull.high - hull.low);
        Interval {
            low: ends.low.min(at(middle) - below),
            high: ends.high,
        }
    })
}

/// The support point of costates of length one.
pub(super) fn support_form(u: &VectorForm, m: [f64; 3]) -> VectorForm {
    let waists = each(|j| waist_form(&u[j]).scaled(m[j]));
    each(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let others = waists[i].plus(&waists[j]);
        let across = if others.size() <= 4.0 * ROUNDING * (m[i] + m[j]) {
            Form::within(0.0, others.size())
        } else {
            u[k].times(&others)
        };
        tip_form(&u[k]).scaled(m[k]).plus(&across)
    })
}

/// The support function of costates of length one.
pub(super) fn level_of(u: &VectorForm, m: [f64; 3]) -> Form {
    let parts = each(|i| level_form(&u[i]).scaled(m[i]));
    parts[0].plus(&parts[1]).plus(&parts[2])
}

/// Ranges of the parts of the support point at costates within a box.
pub(super) struct Ranges {
    pub(super) tips: [Interval; 3],
    pub(super) tip_slopes: [Interval; 3],
    pub(super) waists: [Interval; 3],
    pub(super) waist_slopes: [Interval; 3],
}

impl Ranges {
    pub(super) fn over(u: &[Interval; 3]) -> Self {
        let wide = |range: Interval| {
            Interval::around(range.middle(), 0.5 * (range.high - range.low) + ROUNDING)
        };
        let walls = u.map(|x| in_wall(x).filter(|wall| wall.low < wall.high));
        let inside = each(|i| u[i].low >= -WALL && u[i].high <= WALL);
        Self {
            tips: u.map(|x| wide(hull_of(&[tip(x.low), tip(x.high)]))),
            tip_slopes: each(|i| match walls[i] {
                None => Interval::ZERO,
                Some(_) => Interval {
                    low: if inside[i] {
                        (1.0 / WALL).next_down()
                    } else {
                        0.0
                    },
                    high: (1.0 / WALL).next_up(),
                },
            }),
            waists: each(|i| match walls[i] {
                None => Interval::ZERO,
                Some(wall) => {
                    let mut range = hull_of(&[waist(wall.low), waist(wall.high)]);
                    if wall.contains_zero() {
                        range.high = WAIST;
                    }
                    if !inside[i] {
                        range.low = 0.0;
                    }
                    wide(range)
                }
            }),
            waist_slopes: each(|i| match walls[i] {
                None => Interval::ZERO,
                Some(wall) => {
                    let mut range = hull_of(&[
                        waist_slope(wall.low.max(-WALL * 0.999_999_999)),
                        waist_slope(wall.high.min(WALL * 0.999_999_999)),
                    ]);
                    if !inside[i] {
                        range.low = range.low.min(0.0);
                        range.high = range.high.max(0.0);
                    }
                    // Beyond the wall's very edge by a billionth the slope, below 1.1, changes by less than this.
                    Interval::around(range.middle(), 0.5 * (range.high - range.low) + 1e-7)
                }
            }),
        }
    }

    /// The support points.
    pub(super) fn support(&self, u: &[Interval; 3], m: &[Interval; 3]) -> [Interval; 3] {
        let waists = each(|j| m[j] * self.waists[j]);
        each(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            m[k] * self.tips[k] + u[k] * (waists[i] + waists[j])
        })
    }

    /// Their change with time where costates change by `du` and the box by `dm`.
    pub(super) fn change(
        &self,
        u: &[Interval; 3],
        du: &[Interval; 3],
        m: &[Interval; 3],
        dm: &[Interval; 3],
    ) -> [Interval; 3] {
        let waists = each(|j| m[j] * self.waists[j]);
        let changes = each(|j| dm[j] * self.waists[j] + m[j] * self.waist_slopes[j] * du[j]);
        each(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            dm[k] * self.tips[k]
                + m[k] * self.tip_slopes[k] * du[k]
                + du[k] * (waists[i] + waists[j])
                + u[k] * (changes[i] + changes[j])
        })
    }
}
