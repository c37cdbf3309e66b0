//! The covering of all extremals by cells.

use super::form::{Form, VectorForm, combined, difference, each, length};
use super::meeting::Left;
use super::profile::Profile;
use super::tube::{DOUBLE, Tube};
use crate::bounds::interval::Interval;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Parts of an edge of a cube's face to begin with.
const PARTS: u32 = 8;
/// Width of a cell below which the covering is given up.
const NARROW: f64 = 1e-4;
/// Share of a cell that is left from which on it is halved.
const MUCH: f64 = 0.6;

/// Costates at the begin in a direction through a face of the cube, and scales.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    /// Axis of the face, and its sign.
    face: (usize, f64),
    /// Ranges of the two other components and of the scale.
    low: [f64; 3],
    high: [f64; 3],
}

/// What a covering proves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Covered {
    /// No extremal makes the turn.
    Excluded,
    /// One with this scale may make it.
    Open(f64),
    /// Too many steps.
    GivenUp,
}

/// Deviations beyond which a tube is not followed through the ramps, and after them, rad.
const WIDE: [f64; 2] = [1.2, 1.5];

enum Verdict {
    Refuted,
    Shrunk(Cell),
    Halved([Cell; 2]),
}

/// A turn to be excluded.
pub(super) struct Covering<'a> {
    profile: &'a Profile,
    turn: Matrix3<f64>,
    /// By how much the turn may be another one, rad.
    missed: f64,
    /// Steps that are left.
    budget: usize,
}

impl<'a> Covering<'a> {
    pub(super) fn new(
        profile: &'a Profile,
        turn: Matrix3<f64>,
        missed: f64,
        budget: usize,
    ) -> Self {
        Self {
            profile,
            turn,
            missed,
            budget,
        }
    }

    /// Tries to exclude all scales in a range.
    pub(super) fn exclude(&mut self, from: f64, to: f64) -> Covered {
        let mut open = Cell::all(from, to);
        while let Some(cell) = open.pop() {
            self.budget = self.budget.saturating_sub(1);
            if self.budget == 0 {
                return Covered::GivenUp;
            }
            match self.verdict(&cell) {
                Verdict::Refuted => {}
                Verdict::Shrunk(cell) => open.push(cell),
                Verdict::Halved(halves) => {
                    if (0..3).all(|k| cell.high[k] - cell.low[k] < NARROW) {
                        return Covered::Open(cell.low[2]);
                    }
                    open.extend(halves);
                }
            }
        }
        Covered::Excluded
    }

    fn verdict(&mut self, cell: &Cell) -> Verdict {
        let (costate, scale) = (cell.costate(), cell.scale());
        let back = self.turn.transpose();
        let at_end = each(|i| {
            let row = [-back[(i, 0)], -back[(i, 1)], -back[(i, 2)]];
            combined(row, &costate).inflated(self.missed)
        });
        let profile = self.profile;
        let begin = |side: usize| profile.sides[side][0].limits[0];
        let mut tubes = [
            Tube::new(costate, scale, begin(0)),
            Tube::new(at_end, scale, begin(1)),
        ];
        let mut left = Left::ALL;
        let mut from = [0; 2];
        if let Some(ramps) = profile.ramps {
            from = ramps;
            let mut done = [0; 2];
            let mut levels = [0, 1].map(|side| self.level(&tubes[side], side, done[side]));
            loop {
                match left.vanishing(&levels[0].minus(&levels[1])) {
                    None => return Verdict::Refuted,
                    Some(less) => left = less,
                }
                if left.share() < MUCH {
                    return Verdict::Shrunk(cell.part(&left));
                }
                // The side of which less is known.
                let open = (0..2).filter(|side| done[*side] < ramps[*side]);
                let Some(side) = open.max_by(|i, j| levels[*i].rest.total_cmp(&levels[*j].rest))
                else {
                    break;
                };
                let piece = &profile.sides[side][done[side]];
                if tubes[side]
                    .follow(piece, WIDE[0], &mut self.budget)
                    .is_err()
                {
                    return cell.halved(influence(&tubes));
                }
                done[side] += 1;
                levels[side] = self.level(&tubes[side], side, done[side]);
            }
            if self.is_parted(&tubes, levels[0].hull().high.min(levels[1].hull().high)) {
                return Verdict::Refuted;
            }
        }
        for side in 0..2 {
            for piece in &profile.sides[side][from[side]..] {
                if tubes[side]
                    .follow(piece, WIDE[1], &mut self.budget)
                    .is_err()
                {
                    return cell.halved(influence(&tubes));
                }
            }
        }
        match self.missing(&tubes) {
            None => return Verdict::Refuted,
            Some(missing) => match left.all_vanishing(&missing) {
                None => return Verdict::Refuted,
                Some(less) => left = less,
            },
        }
        if left.share() < MUCH {
            return Verdict::Shrunk(cell.part(&left));
        }
        cell.part(&left).halved(influence(&tubes))
    }

    /// Whether a level curve no higher than this cannot lead from one side to the other.
    fn is_parted(&self, tubes: &[Tube; 2], level: f64) -> bool {
        let Some(limits) = self.profile.constant_limits() else {
            return false;
        };
        // Backwards in time, costates have the other sign.
        let there = tubes[1].in_body().map(|u| u.scaled(-1.0));
        let sides = [tubes[0].in_body(), there].map(|u| u.each_ref().map(Form::hull));
        let shares = sides.map(|u| each(|i| u[i] / Interval::exactly(limits[i])));
        let inside = |side: usize, axis: usize, sign: f64| {
            let own = shares[side][axis];
            let own = if sign > 0.0 { own.low } else { -own.high };
            own > 0.0 && (0..3).all(|j| j == axis || own > shares[side][j].size())
        };
        let outside = |side: usize, axis: usize, sign: f64| {
            let own = shares[side][axis];
            let own = if sign > 0.0 { own.high } else { -own.low };
            own < 0.0 || (0..3).any(|j| j != axis && own < shares[side][j].abs().low)
        };
        (0..3).any(|axis| {
            let saddle = (0..3)
                .filter(|j| *j != axis)
                .map(|j| limits[axis].hypot(limits[j]));
            let saddle = saddle.fold(f64::INFINITY, f64::min) * (1.0 - 1e-12);
            level < saddle
                && [1.0, -1.0].into_iter().any(|sign| {
                    (inside(0, axis, sign) && outside(1, axis, sign))
                        || (inside(1, axis, sign) && outside(0, axis, sign))
                })
        })
    }

    /// The level after the ramps of a side, of which some pieces are done.
    fn level(&self, tube: &Tube, side: usize, done: usize) -> Form {
        let ramps = self.profile.ramps.map_or(0, |ramps| ramps[side]);
        let pieces = &self.profile.sides[side][done..ramps];
        tube.level_after(pieces).of_places()
    }

    /// The turn that is missing between the two sides, up to the rest; `None` if it cannot vanish.
    fn missing(&self, tubes: &[Tube; 2]) -> Option<VectorForm> {
        let [forward, backward] = tubes;
        let between = self.turn * backward.middle * forward.middle.transpose();
        let gap = Rotation3::from_matrix_unchecked(between);
        let gap = log(gap.matrix());
        let behind = each(|i| {
            let row = [self.turn[(i, 0)], self.turn[(i, 1)], self.turn[(i, 2)]];
            combined(row, &backward.deviation).of_places()
        });
        let (a, b) = (length(&behind), length(&forward.deviation));
        if gap.norm() > (a + b + self.missed) * (1.0 + 1e-9) + 1e-9 {
            return None;
        }
        let both = a + b;
        let bent = a.min(b) * (0.5 * both + DOUBLE * both * both) * (1.0 + 1e-9);
        let rest = (bent + self.missed) * 1.01 + 1e-10;
        let apart = difference(&forward.deviation.map(Form::of_places), &behind);
        Some(each(|i| {
            apart[i].minus(&Form::exactly(gap[i])).inflated(rest)
        }))
    }
}

/// The rotation vector of a turn.
fn log(turn: &Matrix3<f64>) -> Vector3<f64> {
    let q =
        nalgebra::UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*turn));
    q.scaled_axis()
}

fn influence(tubes: &[Tube; 2]) -> [f64; 3] {
    let [a, b] = [tubes[0].influence(), tubes[1].influence()];
    each(|k| a[k].max(b[k]))
}

impl Cell {
    /// Cells of all costates with scales in a range.
    fn all(from: f64, to: f64) -> Vec<Self> {
        let part = |number: u32| -1.0 + 2.0 * f64::from(number) / f64::from(PARTS);
        let parts = || (0..PARTS).flat_map(|a| (0..PARTS).map(move |b| (a, b)));
        let faces = (0..3).flat_map(|axis| [-1.0, 1.0].map(|sign| (axis, sign)));
        let cells = faces.flat_map(|face| {
            parts().map(move |(a, b)| Self {
                face,
                low: [part(a), part(b), from],
                high: [part(a + 1), part(b + 1), to],
            })
        });
        cells.collect()
    }

    fn side(&self, k: usize) -> Form {
        let middle = 0.5 * (self.low[k] + self.high[k]);
        let radius = (self.high[k] - middle).max(middle - self.low[k]).next_up();
        let mut form = Form::exactly(middle);
        form.slopes[k] = radius;
        form
    }

    fn scale(&self) -> Form {
        self.side(2)
    }

    /// Costates of length one.
    fn costate(&self) -> VectorForm {
        let (axis, sign) = self.face;
        let (a, b) = (self.side(0), self.side(1));
        let squares = a.times(&a).plus(&b.times(&b)).plus(&Form::exactly(1.0));
        // 1 / sqrt(x) near its tangent; its second derivative falls with x, which is 1 at least.
        let x = squares.middle;
        let off = squares.minus(&Form::exactly(x));
        let radius = off.radius();
        let least = (x - radius).max(1.0);
        let rest = 0.375 * radius * radius / least.powf(2.5) * (1.0 + 1e-9) + 1e-14;
        let shorter = off
            .scaled(-0.5 / x.powf(1.5))
            .plus(&Form::exactly(1.0 / x.sqrt()))
            .inflated(rest);
        let mut costate = [Form::ZERO; 3];
        costate[axis] = shorter.scaled(sign);
        costate[(axis + 1) % 3] = a.times(&shorter);
        costate[(axis + 2) % 3] = b.times(&shorter);
        costate
    }

    /// A part, given by deviations.
    fn part(&self, left: &Left) -> Self {
        let mut part = *self;
        for k in 0..3 {
            let middle = 0.5 * (self.low[k] + self.high[k]);
            let radius = (self.high[k] - middle).max(middle - self.low[k]).next_up();
            part.low[k] = (middle + left.low[k] * radius - 1e-14).max(self.low[k]);
            part.high[k] = (middle + left.high[k] * radius + 1e-14).min(self.high[k]);
        }
        part
    }

    fn halved(&self, influence: [f64; 3]) -> Verdict {
        let width = |k: usize| self.high[k] - self.low[k];
        let k = (0..3)
            .filter(|k| width(*k) > 1e-9)
            .max_by(|i, j| influence[*i].total_cmp(&influence[*j]))
            .unwrap_or(0);
        let middle = 0.5 * (self.low[k] + self.high[k]);
        let (mut first, mut second) = (*self, *self);
        first.high[k] = middle;
        second.low[k] = middle;
        Verdict::Halved([second, first])
    }
}
