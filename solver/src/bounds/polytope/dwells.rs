//! The extremals that dwell on a saddle.
//!
//! On the level of a saddle the flow reaches it in a finite time. There the costate may rest, with the rate
//! parallel to it, and leave along the circles of either vertex; at a later visit it may take either way too. A
//! dwell of length `d` is a turn by `d h` about the costate, the same axis in space at every visit: all of them
//! can be moved to the end of the way. So every way from the one costate to the other that visits a saddle gives
//! one extremal, the dwell making up the angle that is missing about the costate.

use super::cells::Target;
use super::flow::{OnCircle, angle_about, arc};
use super::pairs::CostatePair;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Largest number of arcs of a way. Around a maximum or minimum that all but touches a saddle there are ways of
/// very many short arcs.
const MAX_ARCS: usize = 200;

/// Relative saving from which a turn at a constant rate shows that a motion is not the shortest.
const CLEARLY_FASTER: f64 = 1e-6;

/// A way from the first costate.
#[derive(Clone, Copy)]
struct Way {
    at: OnCircle,
    time: f64,
    turn: UnitQuaternion<f64>,
    /// Time and turn at the first visit.
    first_visit: Option<(f64, UnitQuaternion<f64>)>,
    arcs: usize,
}

/// What is found of the extremals between two costates on the level of a saddle.
pub(super) struct Dwelling {
    /// The least time of those that were followed, if it is less than `target.upper`.
    pub(super) least: Option<f64>,
    /// All others last longer than this; infinite where there are none.
    pub(super) unfollowed: f64,
}

/// Follows the extremals between two costates on the level of a saddle.
pub(super) fn follow(
    target: &Target<'_>,
    pair: &CostatePair,
    level: f64,
    gauge: impl Fn(&Vector3<f64>) -> f64,
) -> Dwelling {
    let mut ways = Ways {
        gauge,
        target,
        pair,
        level,
        least: target.upper,
        unfollowed: f64::INFINITY,
    };
    ways.follow(Way {
        at: pair.ends[0],
        time: 0.0,
        turn: UnitQuaternion::identity(),
        first_visit: None,
        arcs: 0,
    });
    Dwelling {
        least: (ways.least < target.upper).then_some(ways.least),
        unfollowed: ways.unfollowed,
    }
}

struct Ways<'a, G> {
    gauge: G,
    target: &'a Target<'a>,
    pair: &'a CostatePair,
    level: f64,
    least: f64,
    unfollowed: f64,
}

impl<G: Fn(&Vector3<f64>) -> f64> Ways<'_, G> {
    fn follow(&mut self, way: Way) {
        if way.time >= self.least.min(self.unfollowed) || self.is_replaceable(&way) {
            return;
        }
        if way.arcs == MAX_ARCS {
            self.unfollowed = way.time;
            return;
        }
        let curves = self.target.curves;
        let circles = &curves.circles[way.at.vertex];
        let next = circles.next_wall(way.at.azimuth, self.level, Some(self.level));
        let end = self.pair.ends[1];
        if way.first_visit.is_some() && way.at.vertex == end.vertex {
            let ahead = (way.at.azimuth - end.azimuth).rem_euclid(TAU);
            if ahead <= next.map_or(TAU, |(_, angle)| angle) {
                let reached = way.turn * arc(circles, ahead);
                let missing =
                    angle_about(&(reached.inverse() * self.target.turn), &self.pair.after);
                let dwell = missing.rem_euclid(TAU) / self.level;
                self.least = self.least.min(way.time + ahead / circles.speed + dwell);
            }
        }
        let Some((number, angle)) = next else {
            return;
        };
        let wall = &circles.walls[number];
        let further = Way {
            time: way.time + angle / circles.speed,
            turn: way.turn * arc(circles, angle),
            arcs: way.arcs + 1,
            ..way
        };
        if !wall.touches(self.level) {
            let at = curves.beyond(way.at.vertex, number, self.level);
            self.follow(Way { at, ..further });
            return;
        }
        let here = OnCircle {
            azimuth: wall.azimuth,
            ..way.at
        };
        if !wall.is_saddle {
            self.follow(Way {
                at: here,
                ..further
            });
            return;
        }
        let beyond = OnCircle {
            vertex: wall.to,
            azimuth: curves.circles[wall.to].walls[wall.back].azimuth,
        };
        let first_visit = way.first_visit.or(Some((further.time, further.turn)));
        for at in [here, beyond] {
            self.follow(Way {
                at,
                first_visit,
                ..further
            });
        }
    }

    /// Whether a turn at a constant rate is clearly faster than what follows the first visit.
    fn is_replaceable(&self, way: &Way) -> bool {
        way.first_visit.is_some_and(|(time, turn)| {
            let since = (turn.inverse() * way.turn).scaled_axis();
            (self.gauge)(&since) < (way.time - time) * (1.0 - CLEARLY_FASTER)
        })
    }
}
