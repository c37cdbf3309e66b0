//! The flow of the costate along a level curve, and the turn that it makes.

use super::level_curves::{Circles, LevelCurves};
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Azimuths closer than this, rad, are one: a way all around does not end where it begins.
const AT_ONCE: f64 = 1e-12;

/// A costate on the circles about a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnCircle {
    pub(super) vertex: usize,
    pub(super) azimuth: f64,
}

/// The way from one costate to another on the same level.
#[derive(Debug, Clone)]
pub(super) struct Flow {
    /// The walls through which circles are left, in order: vertex and number of the wall.
    pub(super) walls: Vec<(usize, usize)>,
    /// Its duration.
    pub(super) time: f64,
    /// The turn that it makes.
    pub(super) turn: UnitQuaternion<f64>,
}

impl LevelCurves {
    /// The way between two costates; `None` where they are on different curves of the level.
    pub(super) fn flow(&self, from: OnCircle, to: OnCircle, level: f64) -> Option<Flow> {
        self.follow(from, to, level, false)
    }

    /// The way from a costate once around its curve.
    pub(super) fn around(&self, at: OnCircle, level: f64) -> Option<Flow> {
        self.follow(at, at, level, true)
    }

    fn follow(&self, from: OnCircle, to: OnCircle, level: f64, around: bool) -> Option<Flow> {
        let mut flow = Flow {
            walls: Vec::new(),
            time: 0.0,
            turn: UnitQuaternion::identity(),
        };
        let (mut at, mut leaving) = (from, around);
        loop {
            let circles = &self.circles[at.vertex];
            let next = circles.next_wall(at.azimuth, level, None);
            if at.vertex == to.vertex {
                let ahead = (at.azimuth - to.azimuth).rem_euclid(TAU);
                let ahead = if leaving && ahead < AT_ONCE {
                    TAU
                } else {
                    ahead
                };
                if ahead <= next.map_or(TAU, |(_, angle)| angle) {
                    flow.time += ahead / circles.speed;
                    flow.turn *= arc(circles, ahead);
                    return Some(flow);
                }
            }
            leaving = false;
            let (wall, angle) = next?;
            flow.time += angle / circles.speed;
            flow.turn *= arc(circles, angle);
            flow.walls.push((at.vertex, wall));
            // A curve crosses every edge between two vertices twice at most: it has come around.
            if flow.walls.len() > 3 * self.circles.len() {
                return None;
            }
            at = self.beyond(at.vertex, wall, level);
        }
    }

    /// Where a circle is entered through a wall of another one.
    pub(super) fn beyond(&self, vertex: usize, wall: usize, level: f64) -> OnCircle {
        let wall = &self.circles[vertex].walls[wall];
        let entered = &self.circles[wall.to];
        let gate = &entered.walls[wall.back];
        OnCircle {
            vertex: wall.to,
            azimuth: gate.azimuth - entered.half_width(gate, level),
        }
    }
}

/// The turn by an angle about a vertex.
pub(super) fn arc(circles: &Circles, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    let vector = circles.axes[0] * sin;
    Unit::new_unchecked(Quaternion::from_parts(cos, vector))
}

/// The angle, rad, modulo a full turn, of a turn about a unit vector.
pub(super) fn angle_about(turn: &UnitQuaternion<f64>, axis: &Vector3<f64>) -> f64 {
    2.0 * turn.imag().dot(axis).atan2(turn.w)
}

/// The angle nearest to another one that is equal modulo a full turn.
pub(super) fn nearest(angle: f64, to: f64) -> f64 {
    angle - TAU * ((angle - to) / TAU).round()
}
