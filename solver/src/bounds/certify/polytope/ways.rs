//! The extremals that begin in a cell of costates, followed in intervals.
//!
//! An extremal leaves the circle about a vertex through the first wall ahead, and is on the circle about the vertex
//! beyond, at the near end of the wall that leads back. Where intervals do not tell which wall is the first, or
//! whether there is one on the level at all, all possible ways are followed. At a wall that may just vanish the
//! costate may pass a saddle and rest there; how long is open, so the rest, a turn about the costate, makes up at
//! the end for what is missing of the turn.
//!
//! An arc about a vertex by more than half a turn is no part of a shortest motion: the opposite vertex makes the same
//! turn faster. So every arc is within `[0, pi]`.

use super::super::turn::{
    IDENTITY, QuatInterval, VectorInterval, about, angle_of, conjugate, dot, least_turn, product,
};
use super::circles::{Circles, Gap, Meeting};
use crate::bounds::interval::Interval;

/// Number of arcs in a cell from which it is left open.
const MAX_ARCS: usize = 1000;

/// The angles of arcs that may be part of a shortest motion.
const HALF_A_TURN: Interval = Interval {
    low: 0.0,
    high: Interval::PI.high,
};

/// What is to be refuted of a cell: extremals on these levels, from a costate to another one.
pub(super) struct Ways<'a> {
    pub(super) circles: &'a [Circles],
    /// The turn to be made.
    pub(super) turn: &'a QuatInterval,
    /// The time in which it cannot be made, normalised.
    pub(super) time: f64,
    pub(super) level: Interval,
    /// The vertex that supports the last costate, with its azimuth.
    pub(super) last: (usize, Interval),
    /// The last costate.
    pub(super) after: VectorInterval,
    /// Steepness of the level about every vertex, once it is known.
    pub(super) steepness: Vec<Option<Interval>>,
    /// Number of arcs followed.
    pub(super) arcs: usize,
    /// The way found that ends nearest to the turn: its time, and the turn that is missing then.
    pub(super) nearest: Option<(Interval, QuatInterval)>,
}

/// A way up to a costate about a vertex.
#[derive(Clone, Copy)]
pub(super) struct Way {
    vertex: usize,
    place: Place,
    time: Interval,
    turn: QuatInterval,
    /// Whether it has left a circle.
    has_passed: bool,
    /// Whether the costate may have rested.
    may_rest: bool,
}

/// Where a costate is on its circle.
#[derive(Clone, Copy)]
enum Place {
    /// At an azimuth.
    At(Interval),
    /// Where the circle is entered through a wall.
    Beyond(usize),
}

/// A wall that may end an arc.
struct Exit {
    wall: usize,
    gap: Gap,
    /// Angle to it, if it is within half a turn.
    ahead: Option<Interval>,
}

impl Way {
    /// Begins at a costate that a vertex supports.
    pub(super) fn from(vertex: usize, azimuth: Interval) -> Self {
        Self {
            vertex,
            place: Place::At(azimuth),
            time: Interval::ZERO,
            turn: IDENTITY,
            has_passed: false,
            may_rest: false,
        }
    }
}

impl Ways<'_> {
    /// Whether no continuation of a way makes the turn in less than the time.
    pub(super) fn refuted(&mut self, way: &Way) -> bool {
        if way.time.low >= self.time {
            return true;
        }
        self.arcs += 1;
        if self.arcs > MAX_ARCS {
            return false;
        }
        let circles = &self.circles[way.vertex];
        let Some((azimuth, exits)) = self.exits(way) else {
            return true;
        };
        // The arc ends at the latest at the first wall that is there for certain.
        let certain = exits.iter().filter(|exit| exit.gap.is_certain);
        let certain = certain.filter_map(|exit| exit.ahead);
        let latest = certain.fold(Interval::PI.high, |least, ahead| least.min(ahead.high));
        let may_rest_within = |angle: f64| {
            way.may_rest
                || exits.iter().any(|exit| {
                    let is_saddle = circles.walls[exit.wall].is_saddle;
                    let near = exit.ahead.is_some_and(|ahead| ahead.low <= angle);
                    is_saddle && !exit.gap.is_certain && near
                })
        };
        let along = |ahead: Interval| Way {
            time: way.time + ahead / circles.speed,
            turn: product(&way.turn, &about(circles.axis(), ahead)),
            may_rest: may_rest_within(ahead.high),
            ..*way
        };
        if way.vertex == self.last.0 {
            let ahead = within_half_a_turn(azimuth - self.last.1);
            if let Some(ahead) = ahead.filter(|ahead| ahead.low <= latest)
                && !self.end_is_refuted(&along(ahead))
            {
                return false;
            }
        }
        for exit in &exits {
            let wall = &circles.walls[exit.wall];
            if let Some(ahead) = exit.ahead.filter(|ahead| ahead.low <= latest) {
                let next = Way {
                    vertex: wall.to,
                    place: Place::Beyond(wall.back),
                    has_passed: true,
                    ..along(ahead)
                };
                if !self.refuted(&next) {
                    return false;
                }
            }
        }
        true
    }

    /// The azimuth of a way on its circle and the walls of that; `None` where its vertex supports no costate of the
    /// level.
    fn exits(&mut self, way: &Way) -> Option<(Interval, Vec<Exit>)> {
        let circles = &self.circles[way.vertex];
        let level = self.level;
        let steepness = *self.steepness[way.vertex].get_or_insert_with(|| circles.steepness(level));
        let mut met = Vec::with_capacity(3);
        for wall in 0..3 {
            match circles.meeting(wall, steepness) {
                Meeting::Missed => {}
                Meeting::Within => return None,
                Meeting::Met(gap) => met.push((wall, gap)),
            }
        }
        let from = match way.place {
            Place::At(azimuth) => azimuth,
            Place::Beyond(entered) => {
                let (_, gap) = met.iter().find(|(wall, _)| *wall == entered)?;
                circles.walls[entered].azimuth - gap.half_width
            }
        };
        let exits = met.into_iter().map(|(wall, gap)| {
            let ahead = match way.place {
                // Around the circle to the other end of the wall, but not beyond it at once.
                Place::Beyond(entered) if entered == wall => {
                    (Interval::PI - gap.half_width).twice().common(HALF_A_TURN)
                }
                _ => within_half_a_turn(from - circles.walls[wall].azimuth - gap.half_width),
            };
            Exit { wall, gap, ahead }
        });
        Some((from, exits.collect()))
    }

    /// Whether a way that is at the last costate does not make the turn in less than the time.
    fn end_is_refuted(&mut self, way: &Way) -> bool {
        if way.time.low >= self.time {
            return true;
        }
        // A single arc about a vertex is refuted by itself.
        if !way.has_passed && !way.may_rest {
            return true;
        }
        // The turn that is missing takes the last costate to itself.
        let missing = product(&conjugate(&way.turn), self.turn);
        let along = dot(&[missing[0], missing[1], missing[2]], &self.after);
        if !way.may_rest && !along.contains_zero() {
            return true;
        }
        let rest = least_turn(Interval::angle(along, missing[3]).twice());
        let rest = Interval::exactly(rest) / Interval::exactly(self.level.high);
        if way.may_rest && (way.time + Interval::exactly(rest.low)).low >= self.time {
            return true;
        }
        let miss = |missing: &QuatInterval| angle_of(missing).high;
        if self
            .nearest
            .is_none_or(|(_, known)| miss(&missing) < miss(&known))
        {
            self.nearest = Some((way.time, missing));
        }
        false
    }
}

/// All angles in `[0, pi]` that equal one of an interval modulo a full turn.
fn within_half_a_turn(angle: Interval) -> Option<Interval> {
    let full = Interval::PI.twice();
    let turns = Interval::exactly((angle.low / full.high).floor());
    let angle = angle - full * turns;
    match (
        angle.common(HALF_A_TURN),
        (angle - full).common(HALF_A_TURN),
    ) {
        (Some(one), Some(other)) => Some(Interval {
            low: one.low.min(other.low),
            high: one.high.max(other.high),
        }),
        (one, other) => one.or(other),
    }
}
