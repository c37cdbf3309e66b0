//! The extremals of a cell, followed together.

use super::form::{Form, VectorForm, combined, cross, difference, each, length, long, sum};
use super::profile::{Piece, Profile, around};
use super::rests::fold;
use super::rounded_box::{Ranges, WAIST, WALL, level_form, level_of, support, support_form};
use crate::bounds::interval::Interval;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Error of a step by rounding of times and of the middle's matrix, rad.
const SLACK: f64 = 1e-13;
/// Error of the middle's matrix by one step.
const DRIFT: f64 = 1e-14;
/// Largest number of steps of a tube.
const MAX_STEPS: usize = 4000;
/// Coefficient of the double vector product in the equation of the deviation, for deviations below `pi`: at most
/// `1 / pi^2`.
pub(super) const DOUBLE: f64 = 0.1014;
/// Deviation up to which this holds, rad.
const FARTHEST: f64 = 3.0;

/// All extremals of a cell at one time.
#[derive(Debug, Clone)]
pub(super) struct Tube {
    /// The middle's turn since the begin.
    pub(super) middle: Matrix3<f64>,
    /// Rotation vectors of the turns from the middle's to the members', in the axes of the begin.
    pub(super) deviation: VectorForm,
    /// Costates at the begin.
    costate: VectorForm,
    /// The scale.
    scale: Form,
    /// The level so far: that of the begin and what grew with the limits. Its symbols are those of places alone, since
    /// the others have another meaning after every step.
    pub(super) level: Form,
    /// Whether the equation of the deviation held.
    is_followed: bool,
    /// Number of steps.
    pub(super) steps: usize,
}

/// A tube became too wide.
#[derive(Debug, Clone, Copy)]
pub(super) struct TooWide;

impl Tube {
    pub(super) fn new(costate: VectorForm, scale: Form, limits: [f64; 3]) -> Self {
        Self {
            level: level_of(&costate, limits),
            middle: Matrix3::identity(),
            deviation: [Form::ZERO; 3],
            costate,
            scale,
            is_followed: true,
            steps: 0,
        }
    }

    /// Costates seen from the middle's begin, so that the middle's turn takes them to body axes.
    fn seen(&self) -> VectorForm {
        let turned = cross(&self.deviation, &self.costate);
        let size = length(&self.deviation);
        difference(&self.costate, &turned).map(|x| x.inflated(0.5 * size * size))
    }

    /// Costates in body axes.
    pub(super) fn in_body(&self) -> VectorForm {
        into_body(&self.middle, &self.seen()).map(|x| x.inflated(self.steps as f64 * DRIFT))
    }

    /// The level after further pieces.
    pub(super) fn level_after(&self, pieces: &[Piece]) -> Form {
        if pieces.is_empty() {
            return self.level;
        }
        Profile::level_after(pieces, self.level, &self.in_body(), &self.scale)
    }

    /// Influence of each deviation from the middle of the cell.
    pub(super) fn influence(&self) -> [f64; 3] {
        let seen = self.costate;
        each(|k| {
            let of = |v: &VectorForm| {
                v.iter()
                    .fold(0.0, |most, x| f64::max(most, x.slopes[k].abs()))
            };
            of(&self.deviation) + of(&seen)
        })
    }

    /// Follows the members along a piece.
    pub(super) fn follow(
        &mut self,
        piece: &Piece,
        widest: f64,
        budget: &mut usize,
    ) -> Result<(), TooWide> {
        let mut at = 0.0;
        while at < piece.length {
            self.steps += 1;
            *budget = budget.saturating_sub(1);
            if *budget == 0 || self.steps > MAX_STEPS {
                return Err(TooWide);
            }
            let left = piece.length - at;
            let u = self.in_body();
            let step = self.step_length(&u, piece, at, left);
            let is_last = step.length >= left * 0.999_999;
            let h = if is_last { left } else { step.length };
            let part = Piece {
                length: h,
                limits: [
                    piece.at(at / piece.length),
                    piece.at(((at + h) / piece.length).min(1.0)),
                ],
            };
            if step.is_straight {
                self.straight(&u, &part);
            } else {
                self.curved(&u, &part);
            }
            at = if is_last { piece.length } else { at + h };
            if !self.is_followed || length(&self.deviation) > widest {
                return Err(TooWide);
            }
        }
        Ok(())
    }

    fn step_length(&self, u: &VectorForm, piece: &Piece, at: f64, left: f64) -> Step {
        let hulls = each(|i| u[i].hull());
        let m = [0, 1].map(|end| {
            if end == 0 {
                piece.at(at / piece.length)
            } else {
                piece.limits[1]
            }
        });
        let scale = self.scale.hull().high;
        let most = each(|i| scale * m[0][i].max(m[1][i]));
        let distance = hulls.map(|x| x.abs().low - WALL);
        let is_clear = distance.iter().all(|d| *d > 0.0);
        if is_clear {
            // Up to a wall every rate has its sign, and at least so much of its limit.
            let is_constant = piece.is_constant();
            let least = if is_constant {
                self.scale.hull().low
            } else {
                0.0
            };
            let rates = each(|i| {
                let size = Interval {
                    low: least * m[0][i] * (1.0 - 1e-12),
                    high: most[i] * (1.0 + 1e-12),
                };
                if hulls[i].low > 0.0 { size } else { -size }
            });
            let total = long(most) * (1.0 + 1e-12);
            let acceleration = total * total + piece.steepness() * scale;
            let mut h = left;
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let change = hulls[j] * rates[k] - hulls[k] * rates[j];
                let speed = if hulls[i].low > 0.0 {
                    -change.low
                } else {
                    change.high
                };
                h = h.min(time_to(distance[i], speed.max(0.0), acceleration));
            }
            if !is_constant {
                h = h.min(0.4 * piece.length);
            }
            if h >= left || h * total > 0.002 {
                return Step {
                    length: h,
                    is_straight: true,
                };
            }
        }
        let radius = u.iter().fold(0.0, |most, x| f64::max(most, x.radius()));
        let middle = each(|i| u[i].middle);
        let rate = support(middle, m[0]).map(|w| w * self.scale.middle);
        let change = Vector3::from(middle).cross(&Vector3::from(rate)).norm();
        let fine = (FINE * radius).clamp(FINEST, COARSEST);
        let total = long(most);
        let h = f64::min(fine / change.max(1e-300), 4.0 * fine / total).min(left);
        Step {
            length: h,
            is_straight: false,
        }
    }

    /// A step on which all components of all costates stay outside the walls.
    fn straight(&mut self, u: &VectorForm, part: &Piece) {
        let h = part.length;
        let signs = each(|i| u[i].middle.signum());
        let m = part.at(0.5);
        let high = self.scale.hull().high;
        let scale = self.scale.middle;
        let corner = Vector3::from(each(|i| m[i] * signs[i]));
        let rate = corner * scale;
        let off = self.scale.minus(&Form::exactly(scale));
        let half = rotation(&(rate * (0.5 * h)));
        let middle = self.middle * half;
        // The axis of the middle's turn is the corner: it is the same all the time.
        let mut change = each(|i| off.scaled(corner[i] * h));
        let steep = Vector3::from(each(|i| {
            (part.limits[1][i] - part.limits[0][i]) / h * signs[i]
        }));
        let mut size = off.radius() * corner.norm() * (1.0 + 1e-12);
        if !part.is_constant() {
            // int exp(tau w) s tau dt = h^3 / 12 w x s, up to |w|^2 |s| h^4 / 64.
            let second = rate.cross(&steep) * (h * h * h / 12.0);
            let w = rate.norm();
            let rest = w * w * steep.norm() * h * h * h * h / 64.0 * high * (1.0 + 1e-12);
            for i in 0..3 {
                change[i] = change[i].plus(&self.scale.scaled(second[i])).inflated(rest);
            }
            size += high * steep.norm() * h * 0.5 * (1.0 + 1e-12);
        }
        let change = into_start(&middle, &change);
        self.advance(&change, size, h);
        self.middle = middle * half;
        if !part.is_constant() {
            // The sizes of the costate's components are smooth: between the values at both ends and h^3 / 12 u''.
            let then = self.in_body();
            let total = high * long(each(|i| part.limits[0][i].max(part.limits[1][i])));
            let bent = h * h / 12.0 * (total * total + high * steep.norm()) * (1.0 + 1e-12);
            for i in 0..3 {
                let growth = part.limits[1][i] - part.limits[0][i];
                if growth != 0.0 {
                    let mean = u[i].plus(&then[i]).scaled(0.5 * signs[i]).inflated(bent);
                    self.level = self.level.plus(&mean.of_places().scaled(growth));
                }
            }
        }
    }

    /// A step on which costates may be in walls.
    fn curved(&mut self, u: &VectorForm, part: &Piece) {
        let h = part.length;
        let (begin, mid, end) = (part.limits[0], part.at(0.5), part.limits[1]);
        let scale = self.scale.hull();
        let middle = Vector3::from(each(|i| u[i].middle)).normalize();
        // The middle's rate: that of its costate half way.
        let first = Vector3::from(support(middle.into(), begin)) * self.scale.middle;
        let half_way = rotation(&(first * (-0.5 * h))) * middle;
        let rate = Vector3::from(support(half_way.into(), mid)) * self.scale.middle;
        let r = rate.map(Interval::exactly);
        let r = [r[0], r[1], r[2]];
        // What the members do on the way.
        let m = each(|i| {
            let [a, b] = [around(begin)[i], around(end)[i]];
            Interval {
                low: a.low.min(b.low),
                high: a.high.max(b.high),
            }
        });
        let dm = each(|i| {
            (Interval::exactly(end[i]) - Interval::exactly(begin[i])) / Interval::exactly(h)
        });
        let all: f64 = m.iter().map(|x| x.high).sum();
        let most = scale.high * long(m.map(|x| x.high + WAIST * (all - x.high))) * (1.0 + 1e-12);
        let hulls = each(|i| u[i].hull());
        let span = Interval { low: 0.0, high: h };
        let far = hulls.map(|x| Interval {
            low: x.low - h * most - 1e-15,
            high: x.high + h * most + 1e-15,
        });
        let w = Ranges::over(&far).support(&far, &m).map(|x| x * scale);
        let du = crossed(&far, &w);
        let near = each(|i| hulls[i] + span * du[i]);
        let near = each(|i| near[i].common(far[i]).unwrap_or(far[i]));
        let ranges = Ranges::over(&near);
        let w = ranges.support(&near, &m).map(|x| x * scale);
        let du = crossed(&near, &w);
        let off = each(|i| w[i] - r[i]);
        let size = long(off.map(Interval::size));
        let change = ranges.change(&near, &du, &m, &dm);
        let turned = crossed(&r, &off);
        let z = each(|i| turned[i] + scale * change[i]);
        let aside = rate.norm() * 0.5 * h * long(z.map(Interval::size)) * (1.0 + 1e-12);
        let z = z.map(|x| Interval {
            low: x.low - aside,
            high: x.high + aside,
        });
        // The costates half way, from the middle's axes at the begin.
        let now = support_form(u, begin);
        let moved = each(|i| {
            let off = now[i].times(&self.scale).minus(&Form::exactly(rate[i]));
            let bent = z[i] * Interval::exactly(h * h / 8.0);
            off.scaled(0.5 * h).plus(&enclosing(bent))
        });
        let around_it = cross(u, &moved);
        let second = 0.5 * (0.5 * h * size) * (0.5 * h * size) * (1.0 + 1e-12);
        let seen = sum(u, &around_it).map(|x| x.inflated(second));
        let half = rotation(&(rate * (0.5 * h)));
        let there = into_body(&half, &seen);
        let then = support_form(&there, mid);
        let change = each(|i| {
            let off = then[i].times(&self.scale).minus(&Form::exactly(rate[i]));
            let bent = (z[i].high - z[i].low).next_up() * h * h / 8.0;
            off.scaled(h).inflated(bent * (1.0 + 1e-12) + SLACK)
        });
        let middle = self.middle * half;
        let change = into_start(&middle, &change);
        self.advance(&change, size, h);
        self.middle = middle * half;
        fold(&mut self.deviation);
        for i in 0..3 {
            let growth = end[i] - begin[i];
            if growth != 0.0 {
                // Within the change of the costate in half a step, since the level's slope is at most one.
                let mean = level_form(&there[i])
                    .of_places()
                    .inflated(0.5 * h * du[i].size());
                self.level = self.level.plus(&mean.scaled(growth));
            }
        }
    }

    /// Adds a change of the deviation over a step on which it changes by so much at most in a second.
    fn advance(&mut self, change: &VectorForm, size: f64, h: f64) {
        let before = length(&self.deviation);
        let largest = before + h * size;
        self.is_followed &= largest < FARTHEST;
        let bent = h * size * (0.5 * largest + DOUBLE * largest * largest) * (1.0 + 1e-12);
        self.deviation = sum(&self.deviation, change).map(|x| x.inflated(bent + SLACK));
    }
}

/// Steps in walls: as a share of the tube's radius, and within these limits, rad.
const FINE: f64 = 0.5;
const FINEST: f64 = 0.006;
const COARSEST: f64 = 0.03;

struct Step {
    length: f64,
    is_straight: bool,
}

/// A time before which something that moves at a speed and is accelerated no more than so has not come so far.
fn time_to(distance: f64, speed: f64, acceleration: f64) -> f64 {
    2.0 * distance / (speed + (speed * speed + 2.0 * acceleration * distance).sqrt()) * (1.0 - 1e-9)
}

impl Piece {
    /// Norm of the change of the limits with time.
    fn steepness(&self) -> f64 {
        long(each(|i| {
            ((self.limits[1][i] - self.limits[0][i]) / self.length).abs()
        })) * (1.0 + 1e-12)
    }
}

fn enclosing(x: Interval) -> Form {
    let middle = x.middle();
    Form::within(middle, (x.high - middle).max(middle - x.low).next_up())
}

fn crossed(a: &[Interval; 3], b: &[Interval; 3]) -> [Interval; 3] {
    each(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn rotation(vector: &Vector3<f64>) -> Matrix3<f64> {
    Rotation3::new(*vector).into_inner()
}

fn into_body(turn: &Matrix3<f64>, v: &VectorForm) -> VectorForm {
    each(|i| combined([turn[(0, i)], turn[(1, i)], turn[(2, i)]], v).inflated(DRIFT))
}

fn into_start(turn: &Matrix3<f64>, v: &VectorForm) -> VectorForm {
    each(|i| combined([turn[(i, 0)], turn[(i, 1)], turn[(i, 2)]], v))
}
