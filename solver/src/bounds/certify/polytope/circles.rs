//! The circles on which a costate moves, in intervals.
//!
//! While the vertex `v` supports the costate `M`, `M' = M x v`: on the level `h = M . v` the costate runs on a circle
//! about `v`, backwards in azimuth at the speed `s = |v|`. It supports `M` as long as `M . d <= 0` for the three edges
//! `d` out of `v`. With `d` split into parts along and across `v`, `d_a = d . v / s < 0` where the other end is
//! nearer, that is
//!
//! ```text
//!   cos(azimuth - azimuth of d) <= - (d_a / |d_x|) h / sqrt(s^2 - h^2)
//! ```
//!
//! The edge is a *wall* of some half-width about its azimuth, or none.

use super::super::turn::{VectorInterval, cross, dot, minus, of_numbers, unit};
use super::faces::{Edge, Faces};
use crate::bounds::interval::Interval;
use nalgebra::Vector3;

/// What limits the circles about a vertex on the side of an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wall {
    /// The vertex beyond.
    pub(super) to: usize,
    /// Which wall of that vertex leads back.
    pub(super) back: usize,
    /// Azimuth of its middle.
    pub(super) azimuth: Interval,
    /// `- d_a / |d_x|`.
    slope: Interval,
    /// Whether the foot of the perpendicular on the edge may lie within it, so that the costate can rest there.
    pub(super) is_saddle: bool,
}

/// A wall on a level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Its half-width.
    pub(super) half_width: Interval,
    /// Whether it has one on all of the levels, or may be missing.
    pub(super) is_certain: bool,
}

/// The circles about a vertex.
#[derive(Debug, Clone)]
pub(super) struct Circles {
    pub(super) vertex: VectorInterval,
    /// Its length.
    pub(super) speed: Interval,
    /// `v / |v|` and two axes across it, from which azimuths count.
    axes: [VectorInterval; 3],
    pub(super) walls: [Wall; 3],
}

/// How a level meets a wall.
pub(super) enum Meeting {
    /// The circle does not reach the wall.
    Missed,
    /// All of the circle is within the wall: the vertex supports no costate of the level.
    Within,
    /// It is met, or may be.
    Met(Gap),
}

impl Circles {
    /// The circles about the vertices of a polytope. `None` where a vertex or an edge is not known well enough.
    pub(super) fn of(faces: &Faces) -> Option<Vec<Self>> {
        let count = faces.vertices.len();
        let frames = (0..count).map(|at| axes_along(&faces.vertices[at]));
        let frames = frames.collect::<Option<Vec<_>>>()?;
        let split = |at: usize, edge: &Edge| {
            let [axis, a, b] = &frames[at];
            let along = dot(&edge.direction, axis);
            let across = minus(&edge.direction, &axis.map(|x| x * along));
            let [x, y, z] = across;
            let slope = -along / x.length(y).length(z);
            (slope, Interval::angle(dot(&across, b), dot(&across, a)))
        };
        let wall = |at: usize, edge: &Edge| {
            let back = faces.edges[edge.to].iter().position(|edge| edge.to == at)?;
            let (slope, azimuth) = split(at, edge);
            let (beyond, _) = split(edge.to, &faces.edges[edge.to][back]);
            Some(Wall {
                to: edge.to,
                back,
                azimuth,
                slope,
                is_saddle: slope.high > 0.0 && beyond.high > 0.0,
            })
        };
        (0..count)
            .map(|at| {
                let [one, two, three] = &faces.edges[at];
                let [x, y, z] = faces.vertices[at];
                Some(Self {
                    vertex: faces.vertices[at],
                    speed: x.length(y).length(z),
                    axes: frames[at],
                    walls: [wall(at, one)?, wall(at, two)?, wall(at, three)?],
                })
            })
            .collect()
    }

    /// `v / |v|`.
    pub(super) fn axis(&self) -> &VectorInterval {
        &self.axes[0]
    }

    /// Azimuth of a costate.
    pub(super) fn azimuth_of(&self, costate: &VectorInterval) -> Interval {
        let [_, a, b] = &self.axes;
        Interval::angle(dot(costate, b), dot(costate, a))
    }

    /// `h / sqrt(s^2 - h^2)`, which has no upper limit where the level may be that of the vertex.
    pub(super) fn steepness(&self, level: Interval) -> Interval {
        let across = ((self.speed - level) * (self.speed + level)).sqrt();
        let least = Interval::exactly(level.low) / Interval::exactly(across.high);
        let most = Interval::exactly(level.high) / Interval::exactly(across.low);
        Interval {
            low: least.low.max(0.0),
            high: most.high.min(f64::MAX),
        }
    }

    /// How the circle of a steepness meets a wall.
    pub(super) fn meeting(&self, wall: usize, steepness: Interval) -> Meeting {
        let cosine = steepness * self.walls[wall].slope;
        if cosine.low > 1.0 {
            Meeting::Missed
        } else if cosine.high < -1.0 {
            Meeting::Within
        } else {
            Meeting::Met(Gap {
                half_width: cosine.acos(),
                is_certain: cosine.high <= 1.0,
            })
        }
    }
}

/// A right-handed system of axes of length one whose first is along a vector.
fn axes_along(vector: &VectorInterval) -> Option<[VectorInterval; 3]> {
    let axis = unit(vector)?;
    let rough = Vector3::from(axis.map(Interval::middle));
    let a = unit(&cross(
        &axis,
        &of_numbers(&Vector3::ith(rough.iamin(), 1.0)),
    ))?;
    let b = cross(&axis, &a);
    Some([axis, a, b])
}
