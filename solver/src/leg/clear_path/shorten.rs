//! Paths pulled tight around the cones.

use super::space::{Cosine, Space};
use super::sphere::{Arc, Point};

/// Longest step of a path, rad of rotation.
pub(super) const STEP: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Clearance that a path keeps where there is room, rad.
pub(super) const MARGIN: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// Rounds of shortening at most, and the relative gain below which a round is the last.
const ROUNDS: usize = 16;
const LAST_GAIN: f64 = 1e-3;
/// Relative gain for which a part is replaced.
const GAIN: f64 = 1e-4;
/// Attempts to bend a part around what it cuts.
const BENDS: usize = 4;
/// Rounds in which points are moved away from the cones.
const MOVES: usize = 6;

/// A path whose arcs are clear.
pub(super) struct Path<'a, const D: usize, F> {
    space: &'a Space<D, F>,
    /// Its points, with continuous signs.
    pub(super) points: Vec<Point<D>>,
}

impl<'a, const D: usize, F: Cosine<D>> Path<'a, D, F> {
    /// Through points, in steps of at most [`STEP`].
    pub(super) fn through(space: &'a Space<D, F>, points: &[Point<D>]) -> Self {
        let mut path = Self {
            space,
            points: points.first().copied().into_iter().collect(),
        };
        for next in points.iter().skip(1) {
            let Some(here) = path.points.last().copied() else {
                break;
            };
            let more = path.steps(&here, next);
            path.points.extend(more);
        }
        path
    }

    /// Its length, rad of rotation.
    pub(super) fn turn(&self) -> f64 {
        self.turn_of(&self.points)
    }

    fn turn_of(&self, points: &[Point<D>]) -> f64 {
        let arcs = points.windows(2);
        arcs.map(|arc| self.space.turn(&arc[0], &arc[1])).sum()
    }

    fn clearance_of(&self, points: &[Point<D>]) -> f64 {
        let arcs = points.windows(2);
        arcs.map(|arc| self.space.arc_clearance(&arc[0], &arc[1]))
            .fold(f64::INFINITY, f64::min)
    }

    /// An arc in steps, its beginning left out.
    fn steps(&self, from: &Point<D>, to: &Point<D>) -> Vec<Point<D>> {
        let arc = Arc::between(from, &self.space.aligned(to, from));
        let mut count = 1;
        while arc.length * F::SCALE > STEP * count as f64 {
            count += 1;
        }
        arc.points(count).collect()
    }

    /// Replaces parts by shorter ones, long parts first, until that gains little.
    ///
    /// A part keeps its least clearance, or [`MARGIN`] where it has more.
    pub(super) fn pull_tight(&mut self) {
        for _ in 0..ROUNDS {
            let before = self.turn();
            let mut stride = self.points.len().saturating_sub(1);
            while stride >= 2 {
                self.sweep(stride);
                stride /= 2;
            }
            if self.turn() > before * (1.0 - LAST_GAIN) {
                break;
            }
        }
    }

    /// One pass over all parts of so many steps.
    fn sweep(&mut self, stride: usize) {
        let mut first = 0;
        while first + 2 < self.points.len() {
            let last = (first + stride).min(self.points.len() - 1);
            if let Some(shorter) = self.shorter(&self.points[first..=last]) {
                let mut part = Vec::new();
                for arc in shorter.windows(2) {
                    let here = part.last().copied().unwrap_or(arc[0]);
                    part.extend(self.steps(&here, &arc[1]));
                }
                self.points.splice(first + 1..=last, part);
                self.continue_signs(first);
            }
            first += (stride / 2).max(1);
        }
    }

    /// Gives the points behind a replaced part the sign of those before.
    fn continue_signs(&mut self, first: usize) {
        for i in first + 1..self.points.len() {
            self.points[i] = self.space.aligned(&self.points[i], &self.points[i - 1]);
        }
    }

    /// A shorter way from the first to the last of some points: straight, or with one bend.
    fn shorter(&self, part: &[Point<D>]) -> Option<Vec<Point<D>>> {
        let (from, to) = (part.first()?, part.last()?);
        let allowed = self.turn_of(part) * (1.0 - GAIN);
        let straight = self.space.turn(from, to);
        if straight >= allowed {
            return None;
        }
        let level = self.clearance_of(part).min(MARGIN);
        if self.space.arc_clearance(from, to) >= level {
            return Some(vec![*from, *to]);
        }
        let halfway = |a: &Point<D>, b: &Point<D>| {
            let arc = Arc::between(a, &self.space.aligned(b, a));
            arc.at(arc.length / 2.0)
        };
        let middle = halfway(from, to);
        let present = &part[part.len() / 2];
        let bends =
            [middle, halfway(&middle, present)].map(|bend| self.bent(from, &bend, to, level));
        let shortest = bends
            .into_iter()
            .flatten()
            .map(|way| (self.turn_of(&way), way));
        let shortest = shortest.min_by(|a, b| a.0.total_cmp(&b.0));
        shortest
            .filter(|(turn, _)| *turn < allowed)
            .map(|(_, way)| way)
    }

    /// The way through a point that is pushed out of the cones until both arcs have some clearance.
    fn bent(
        &self,
        from: &Point<D>,
        bend: &Point<D>,
        to: &Point<D>,
        level: f64,
    ) -> Option<Vec<Point<D>>> {
        let (mut bend, mut wanted) = (*bend, level);
        for _ in 0..BENDS {
            bend = self.space.pushed_out(&bend, wanted)?;
            let way = [*from, bend, *to];
            let clearance = self.clearance_of(&way);
            if clearance >= level {
                return Some(way.to_vec());
            }
            // What the arcs lack, the bend has to gain at about twice the distance.
            wanted = self.space.clearance(&bend) + 2.0 * (level - clearance);
        }
        None
    }

    /// Moves points away from the cones, up to [`MARGIN`], where there is room.
    pub(super) fn make_room(&mut self) {
        for _ in 0..MOVES {
            for i in 1..self.points.len().saturating_sub(1) {
                if let Some(moved) = self.moved_out(i) {
                    self.points[i] = moved;
                }
            }
        }
    }

    /// A point with more clearance whose arcs have no less.
    fn moved_out(&self, index: usize) -> Option<Point<D>> {
        let present = &self.points[index];
        let clearance = self.space.clearance(present);
        let around = &self.points[index - 1..=index + 1];
        let arcs = self.clearance_of(around);
        // Arcs between points on a circle around a cone are nearer to it than the points.
        if arcs >= MARGIN {
            return None;
        }
        let wanted = clearance.max(0.0) + MARGIN - arcs;
        [1.0, 0.5, 0.25].into_iter().find_map(|share| {
            let target = clearance + share * (wanted - clearance);
            let moved = self.space.pushed_out(present, target)?;
            let moved = self.space.aligned(&moved, present);
            (self.clearance_of(&[around[0], moved, around[2]]) >= arcs).then_some(moved)
        })
    }
}
