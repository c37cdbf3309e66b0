//! The level curves of the support function on the sphere of costates.
//!
//! Where vertex `v` supports the costate `m`, `|m| = 1`, the level `h` is the circle `m . v = h` about
//! `v`. The flow `m' = m x v` runs down in azimuth about it, at `|v|` rad/s, until another vertex `v'`
//! supports as well. That is so within the *wall* `m . (v - v') < 0`, an arc of the circle about the
//! azimuth of `v'` with the half-width `acos k`,
//!
//! ```text
//!   k = h (v.v - v.v') / (|v| r sqrt(v.v - h^2)),    r the distance of v' from the line along v.
//! ```
//!
//! `k` is monotone in `h`. It is one, or minus one, at the distance of the line through `v` and `v'` from
//! the origin: there the wall vanishes, or is all of the circle. Where the foot of the perpendicular lies
//! between the two, that level is a saddle of the support function.

use super::faces::Faces;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Relative difference of levels below which they are one: edges that symmetry makes equally far from the
/// origin differ by rounding.
const SAME_LEVEL: f64 = 1e-13;
/// Angle, rad, below which a wall is not ahead but just left.
const LEFT: f64 = 1e-13;

/// What limits the circles about a vertex on the side of another one.
#[derive(Debug, Clone)]
pub(super) struct Wall {
    /// The other vertex.
    pub(super) to: usize,
    /// Number of the wall between the same two among those of the other vertex.
    pub(super) back: usize,
    /// Azimuth of its middle, rad.
    pub(super) azimuth: f64,
    /// `(v.v - v.v') / (|v| r)`.
    slope: f64,
    /// Where it vanishes or is all of the circle.
    pub(super) level: f64,
    /// Whether that level is a saddle.
    pub(super) is_saddle: bool,
}

impl Wall {
    /// Whether a level, one of [`LevelCurves::critical`], is its own.
    pub(super) fn touches(&self, level: f64) -> bool {
        self.level.total_cmp(&level).is_eq()
    }
}

/// The circles about a vertex.
#[derive(Debug, Clone)]
pub(super) struct Circles {
    pub(super) vertex: Vector3<f64>,
    /// `|v|`.
    pub(super) speed: f64,
    /// `v / |v|` and two axes across it, from which azimuths count.
    pub(super) axes: [Vector3<f64>; 3],
    pub(super) walls: Vec<Wall>,
}

impl Circles {
    /// Azimuth of a costate, rad.
    pub(super) fn azimuth_of(&self, costate: &Vector3<f64>) -> f64 {
        let [_, a, b] = &self.axes;
        costate.dot(b).atan2(costate.dot(a))
    }

    /// The costate of an azimuth and a level.
    pub(super) fn costate(&self, azimuth: f64, level: f64) -> Vector3<f64> {
        let [axis, a, b] = &self.axes;
        let along = level / self.speed;
        let across = (1.0 - along * along).max(0.0).sqrt();
        axis * along + (a * azimuth.cos() + b * azimuth.sin()) * across
    }

    /// Half-width of a wall on a level, rad.
    pub(super) fn half_width(&self, wall: &Wall, level: f64) -> f64 {
        (self.steepness(level) * wall.slope).clamp(-1.0, 1.0).acos()
    }

    fn steepness(&self, level: f64) -> f64 {
        let across = self.speed * self.speed - level * level;
        level / across.max(f64::MIN_POSITIVE).sqrt()
    }

    /// The next wall down from an azimuth, and the angle to it, rad. Walls whose own level is
    /// `touching` have no width and are met nevertheless.
    pub(super) fn next_wall(
        &self,
        azimuth: f64,
        level: f64,
        touching: Option<f64>,
    ) -> Option<(usize, f64)> {
        let steepness = self.steepness(level);
        let mut next: Option<(usize, f64)> = None;
        for (index, wall) in self.walls.iter().enumerate() {
            let cosine = steepness * wall.slope;
            let half_width = if touching.is_some_and(|level| wall.touches(level)) {
                0.0
            } else if cosine >= 1.0 {
                continue;
            } else {
                cosine.max(-1.0).acos()
            };
            let angle = (azimuth - wall.azimuth - half_width).rem_euclid(TAU);
            let angle = if angle < LEFT { TAU } else { angle };
            if next.is_none_or(|(_, least)| angle < least) {
                next = Some((index, angle));
            }
        }
        next
    }
}

/// The level curves of a polytope.
#[derive(Debug, Clone)]
pub(super) struct LevelCurves {
    pub(super) circles: Vec<Circles>,
    /// The levels on which curves touch, meet or vanish.
    pub(super) critical: Vec<CriticalLevel>,
}

/// A level on which curves touch, meet or vanish.
#[derive(Debug, Clone, Copy)]
pub(super) struct CriticalLevel {
    pub(super) level: f64,
    /// Whether it has a saddle, on which a costate may rest.
    pub(super) has_saddle: bool,
}

impl LevelCurves {
    pub(super) fn of(faces: &Faces) -> Self {
        let mut critical = Levels::default();
        let circles: Vec<Circles> = (0..faces.vertices.len())
            .map(|at| circles(faces, at, &mut critical))
            .collect();
        for facet in &faces.facets {
            critical.shared(1.0 / facet.norm(), false);
        }
        Self {
            circles,
            critical: critical.0,
        }
    }
}

/// Different levels.
#[derive(Default)]
struct Levels(Vec<CriticalLevel>);

impl Levels {
    /// The level that stands for all that are the same up to rounding.
    fn shared(&mut self, level: f64, has_saddle: bool) -> f64 {
        let same = |known: &&mut CriticalLevel| (known.level - level).abs() <= SAME_LEVEL * level;
        if let Some(known) = self.0.iter_mut().find(same) {
            known.has_saddle |= has_saddle;
            return known.level;
        }
        self.0.push(CriticalLevel { level, has_saddle });
        level
    }
}

fn circles(faces: &Faces, at: usize, critical: &mut Levels) -> Circles {
    let vertex = faces.vertices[at];
    let speed = vertex.norm();
    let axis = vertex / speed;
    let a = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    let b = axis.cross(&a);
    let wall = |&to: &usize| {
        let other = faces.vertices[to];
        // From the same end for both walls of an edge, so that their levels are equal.
        let [low, high] = if at < to {
            [vertex, other]
        } else {
            [other, vertex]
        };
        let edge = high - low;
        let across = other - axis * axis.dot(&other);
        let product = vertex.dot(&other);
        let is_saddle = speed * speed > product && other.norm_squared() > product;
        let back = faces.neighbours[to].iter().position(|&near| near == at);
        Wall {
            to,
            back: back.expect("edges lead both ways"),
            azimuth: across.dot(&b).atan2(across.dot(&a)),
            slope: (speed * speed - product) / (speed * across.norm()),
            level: critical.shared(low.cross(&edge).norm() / edge.norm(), is_saddle),
            is_saddle,
        }
    };
    let walls = faces.neighbours[at].iter().map(wall).collect();
    Circles {
        vertex,
        speed,
        axes: [axis, a, b],
        walls,
    }
}
