//! Bounds on the times of the regular extremals whose costates lie in a part of a great circle.
//!
//! The flow from the costate `m` to `R^T m` makes a turn that takes the one to the other, as `R` does: the two
//! differ by a turn about the costate, of an angle `d(t)`, and an extremal reaches `R` where `d = 0` modulo a
//! full turn. Along the part, with the time `T(t)` of the flow and the level `h(t)`,
//!
//! ```text
//!   d' = - h T'
//! ```
//!
//! since the costate is normal to the front of the turns reached in a time: `M . (R^-1 dR) = h dT`. So all
//! extremals of a cell around `t_c` last
//!
//! ```text
//!   T_c + (d_c + 2 pi j) / h_c,    to within max abs(h - h_c) / h_c times the variation of T,
//! ```
//!
//! for whole numbers `j`, and this error shrinks with the square of the cell. `T` is a sum of azimuths at the two
//! ends and half-widths of walls, each monotone within the cell: their ends give its range and variation.
//! Ways that lead around the curve `k` times more last `k P` longer, and turn by `k e` less.

use super::flow::{Flow, angle_about, nearest};
use super::level_curves::LevelCurves;
use super::pairs::{CostatePair, LevelPair};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of ways around a curve from which [`narrow_curve`] bounds all others.
const MAX_AROUND: u32 = 300;
/// Share of its period by which a curve's period may fall within a cell that tells anything.
const MIN_PERIOD: f64 = 0.02;
/// Rounding of the time of a flow whose speeds are at most one.
const ROUNDING: f64 = 1e-10;
/// Rounding of the angle by which a turn moves an axis, rad.
const SWING_ROUNDING: f64 = 1e-6;

/// What a cell is evaluated for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target<'a> {
    pub(super) curves: &'a LevelCurves,
    pub(super) turn: UnitQuaternion<f64>,
    pub(super) back: Matrix3<f64>,
    /// A time in which the turn is known to be made.
    pub(super) upper: f64,
}

/// Range, relative to the middle of a cell, and variation of a sum of monotone terms.
#[derive(Debug, Clone, Copy, Default)]
struct Spread {
    low: f64,
    high: f64,
    variation: f64,
}

impl Spread {
    /// Adds a term with these values at the ends of the cell, relative to its middle.
    fn add(&mut self, [from, to]: [f64; 2]) {
        self.low += from.min(to).min(0.0);
        self.high += from.max(to).max(0.0);
        self.variation += (to - from).abs();
    }

    fn plus(self, times: f64, other: Self) -> Self {
        Self {
            low: self.low + times * other.low,
            high: self.high + times * other.high,
            variation: self.variation + times * other.variation,
        }
    }
}

impl Target<'_> {
    /// The least time of the extremals of a cell that may be faster than `upper`; `None` where none is.
    pub(super) fn least_time(&self, pair: &LevelPair, [from, to]: [f64; 2]) -> Option<f64> {
        let places = [from, 0.5 * (from + to), to];
        let at = places.map(|t| pair.at(t, self.curves, &self.back));
        let level = at[1].level;
        let flow = self.curves.flow(at[1].ends[0], at[1].ends[1], level)?;
        let mut spread = self.spread_of_ends(&at);
        self.add_walls(&mut spread, &flow, &at);
        if flow.time + spread.low >= self.upper {
            return None;
        }
        let around = self.curves.around(at[1].ends[1], level)?;
        let mut of_period = Spread::default();
        self.add_walls(&mut of_period, &around, &at);
        if around.time + of_period.low <= MIN_PERIOD * around.time {
            return Some((flow.time + spread.low).max(0.0));
        }
        let missing = self.missing(&flow, &at[1]);
        let by_period = angle_about(&around.turn, &at[1].after);
        let off = [0, 2].map(|end| (at[end].level - level).abs() / level);
        let off = off[0].max(off[1]);
        let mut least: Option<f64> = None;
        for ways in 0.. {
            let k = f64::from(ways);
            let (time, spread) = (flow.time + k * around.time, spread.plus(k, of_period));
            let [low, high] = [time + spread.low, time + spread.high];
            if low >= least.unwrap_or(f64::INFINITY).min(self.upper) {
                break;
            }
            if ways > MAX_AROUND {
                let longest = around.time + of_period.high;
                let rest = self.narrow_curve(&around, at.map(|at| at.level), longest);
                return least.into_iter().chain(rest).reduce(f64::min);
            }
            let error = off * spread.variation + ROUNDING;
            let (base, step) = (time + (missing - k * by_period) / level, TAU / level);
            let first = base + ((low - error - base) / step).ceil() * step;
            if first <= high + error {
                let time = (first - error).max(low);
                least = Some(least.map_or(time, |known| known.min(time)));
            }
        }
        least
    }

    /// The time of a motion that makes the turn: the flow of the middle of a cell, and then what is
    /// missing about the costate, which takes so long by `gauge`.
    pub(super) fn attained(
        &self,
        pair: &LevelPair,
        [from, to]: [f64; 2],
        gauge: impl Fn(&Vector3<f64>) -> f64,
    ) -> Option<f64> {
        let at = pair.at(0.5 * (from + to), self.curves, &self.back);
        let flow = self.curves.flow(at.ends[0], at.ends[1], at.level)?;
        let missing = flow.turn.inverse() * self.turn;
        Some(flow.time + gauge(&missing.scaled_axis()))
    }

    /// The angle about the costate that is missing after a flow, rad, modulo a full turn.
    fn missing(&self, flow: &Flow, at: &CostatePair) -> f64 {
        angle_about(&(flow.turn.inverse() * self.turn), &at.after)
    }

    fn spread_of_ends(&self, at: &[CostatePair; 3]) -> Spread {
        let mut spread = Spread::default();
        for (end, sign) in [(0, 1.0), (1, -1.0)] {
            let middle = at[1].ends[end].azimuth;
            let speed = self.curves.circles[at[1].ends[end].vertex].speed;
            let moved = |at: &CostatePair| nearest(at.ends[end].azimuth, middle) - middle;
            spread.add([0, 2].map(|place| sign * moved(&at[place]) / speed));
        }
        spread
    }

    fn add_walls(&self, spread: &mut Spread, flow: &Flow, at: &[CostatePair; 3]) {
        for &(vertex, wall) in &flow.walls {
            let left = &self.curves.circles[vertex];
            let wall = &left.walls[wall];
            let entered = &self.curves.circles[wall.to];
            for (circles, wall) in [(left, wall), (entered, &entered.walls[wall.back])] {
                let half = at.map(|at| circles.half_width(wall, at.level));
                spread.add([0, 2].map(|place| (half[1] - half[place]) / circles.speed));
            }
        }
    }

    /// A bound on ways that lead many times around a small curve, which takes at most `period` once around.
    ///
    /// All along, the costate stays within an angle `e` of an axis `n`, which therefore swings by `2 e` at most
    /// and returns to there: the twist about it grows at `h_K(n) + tan(e) |w|` at most. Between two walls the
    /// costate, whose speed is at most one, goes no further from the nearer one than half a period. `None` where
    /// the turn swings the axis further, so that no such way makes it.
    fn narrow_curve(&self, around: &Flow, levels: [f64; 3], period: f64) -> Option<f64> {
        let corners = around.walls.iter().flat_map(|&(vertex, wall)| {
            let circles = &self.curves.circles[vertex];
            let wall = &circles.walls[wall];
            levels
                .map(|level| circles.costate(wall.azimuth + circles.half_width(wall, level), level))
        });
        let corners: Vec<Vector3<f64>> = corners.collect();
        let Some(axis) = corners.iter().sum::<Vector3<f64>>().try_normalize(0.0) else {
            return Some(0.0);
        };
        let widest = corners.iter().map(|corner| corner.angle(&axis));
        let cone = widest.fold(0.0, f64::max) + 0.5 * period;
        if cone >= FRAC_PI_2 {
            return Some(0.0);
        }
        let along = self.turn.imag().dot(&axis);
        let swing = 2.0 * (self.turn.imag() - axis * along).norm().min(1.0).asin();
        if swing > 2.0 * cone + SWING_ROUNDING {
            return None;
        }
        let twist = (2.0 * along.atan2(self.turn.w)).rem_euclid(TAU);
        let vertices = self.curves.circles.iter();
        let support = vertices.map(|circles| circles.vertex.dot(&axis));
        Some(twist / (support.fold(0.0, f64::max) + cone.tan()))
    }
}
