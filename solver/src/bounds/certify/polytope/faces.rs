//! The faces of a polytope of rates, in intervals.
//!
//! The half-spaces are moved outward, each by another share, so that three meet in every vertex; what takes a time
//! within the larger set takes it within the given one. A vertex is where three half-spaces `f . w = 1` meet within
//! all others. It maximises `m . w` for all `m` of the cone of their three normals. Two such cones share a side, the
//! triangles of normals that span them are oriented alike, and so they cover all directions: every direction has its
//! maximum at one of the vertices found, or none was missed.

use super::super::turn::{VectorInterval, cross, dot, minus, of_numbers, unit};
use crate::bounds::interval::Interval;
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::f64::consts::SQRT_2;

/// Half-spaces are moved outward by one to two of these shares.
const SPREAD: f64 = 1e-7;
/// Relative difference below which two half-spaces are one; only one of them is kept.
const SAME: f64 = 1e-6;
/// Largest number of half-spaces.
const MAX_POINTS: usize = 80;
/// By how much a half-space may be exceeded before it is tried in intervals.
const ROUGHLY: f64 = 1e-6;

/// An edge of a polytope, seen from one of its ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    /// The vertex at its other end.
    pub(super) to: usize,
    /// From here to there, of length one.
    pub(super) direction: VectorInterval,
}

/// A facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    /// Its normal, of length one.
    pub(super) normal: VectorInterval,
    /// Its distance.
    pub(super) distance: Interval,
    /// Distance of the foot of the perpendicular from the facet's border; negative if the foot is outside.
    pub(super) inside: Interval,
}

/// A polytope whose farthest vertex has about the length one.
#[derive(Debug, Clone)]
pub(super) struct Faces {
    pub(super) vertices: Vec<VectorInterval>,
    /// The three edges at every vertex.
    pub(super) edges: Vec<[Edge; 3]>,
    /// The three facets at every vertex.
    pub(super) around: Vec<[usize; 3]>,
    pub(super) facets: Vec<Facet>,
    /// Rates of the polytope, rad/s, in units of this are those of the faces.
    pub(super) unit_rad_s: f64,
    /// The half-spaces `f . w <= 1`, in the same units.
    pub(super) half_spaces: Vec<Vector3<f64>>,
}

impl Faces {
    /// The faces of a set that contains all `w` with `|f . w| <= 1`; `None` where no proof of that is found.
    pub(super) fn around(half_spaces: &[Vector3<f64>]) -> Option<Self> {
        let given = spread(half_spaces)?;
        let farthest = triples(&given)
            .filter_map(|triple| rough_vertex(&given, triple))
            .map(|vertex| vertex.norm());
        let unit_rad_s = farthest.fold(0.0, f64::max);
        if !(unit_rad_s.is_finite() && unit_rad_s > 0.0) {
            return None;
        }
        let points: Vec<_> = given.iter().map(|f| f * unit_rad_s).collect();
        let mut corners = Vec::new();
        for triple in triples(&points) {
            if rough_vertex(&points, triple).is_some() {
                corners.extend(corner(&points, triple).ok()?);
            }
        }
        Self::of(points, &corners, unit_rad_s)
    }

    fn of(points: Vec<Vector3<f64>>, corners: &[Corner], unit_rad_s: f64) -> Option<Self> {
        // Sides of the triangles of normals, in the sense in which they are run through.
        let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for (number, corner) in corners.iter().enumerate() {
            let [i, j, k] = corner.planes;
            for side in [[i, j], [j, k], [k, i]] {
                if sides.insert(side, number).is_some() {
                    return None;
                }
            }
        }
        let exactly = |point: usize| of_numbers(&points[point]);
        let edge = |[from, to]: [usize; 2]| {
            // Within both planes, away from the third one of this corner.
            let direction = unit(&cross(&exactly(to), &exactly(from)))?;
            let to = *sides.get(&[to, from])?;
            Some(Edge { to, direction })
        };
        let edges = corners.iter().map(|corner| {
            let [i, j, k] = corner.planes;
            Some([edge([i, j])?, edge([j, k])?, edge([k, i])?])
        });
        let edges = edges.collect::<Option<Vec<_>>>()?;
        let mut numbers = BTreeMap::new();
        for corner in corners {
            for plane in corner.planes {
                let next = numbers.len();
                numbers.entry(plane).or_insert(next);
            }
        }
        let mut planes: Vec<_> = numbers.iter().collect();
        planes.sort_by_key(|(_, number)| **number);
        let facets = planes.iter().map(|(plane, _)| {
            let f = exactly(**plane);
            let steepness = dot(&f, &f).sqrt();
            let foot = f.map(|x| x / dot(&f, &f));
            let beside = sides.keys().filter(|[from, _]| from == *plane);
            let inside = beside.map(|[_, other]| {
                let across = exactly(*other);
                let along = dot(&across, &foot);
                let within = minus(&across, &f.map(|x| x * along));
                (Interval::ONE - along) / dot(&within, &within).sqrt()
            });
            Some(Facet {
                normal: unit(&f)?,
                distance: Interval::ONE / steepness,
                inside: inside.reduce(Interval::least)?,
            })
        });
        Some(Self {
            vertices: corners.iter().map(|corner| corner.vertex).collect(),
            edges,
            around: corners
                .iter()
                .map(|corner| corner.planes.map(|plane| numbers[&plane]))
                .collect(),
            facets: facets.collect::<Option<_>>()?,
            unit_rad_s,
            half_spaces: points,
        })
    }

    /// The gauge of a vector: the least time, normalised, in which it is passed at a constant rate. Rounded up.
    pub(super) fn gauge(&self, vector: &VectorInterval) -> f64 {
        let shares = self.half_spaces.iter();
        let shares = shares.map(|f| dot(&of_numbers(f), vector).high);
        shares.fold(0.0, f64::max)
    }

    /// The longest time, normalised, of a turn by an angle about any axis.
    pub(super) fn slowest(&self, angle: f64) -> f64 {
        self.gauge_of_sphere() * angle
    }

    fn gauge_of_sphere(&self) -> f64 {
        let steepest = self.half_spaces.iter().map(Vector3::norm);
        steepest.fold(0.0, f64::max).next_up().next_up()
    }
}

/// Intervals do not tell whether there is a corner.
struct Undecided;

/// A vertex with the three half-spaces that meet there, in counter-clockwise order from outside.
struct Corner {
    planes: [usize; 3],
    vertex: VectorInterval,
}

fn triples(points: &[Vector3<f64>]) -> impl Iterator<Item = [usize; 3]> + use<> {
    let count = points.len();
    (0..count)
        .flat_map(move |i| (i + 1..count).flat_map(move |j| (j + 1..count).map(move |k| [i, j, k])))
}

/// Where three half-spaces meet, in ordinary arithmetic, if that is nearly within all.
fn rough_vertex(points: &[Vector3<f64>], [i, j, k]: [usize; 3]) -> Option<Vector3<f64>> {
    let across = (points[j] - points[i]).cross(&(points[k] - points[i]));
    let vertex = across / across.dot(&points[i]);
    let within = |f: &Vector3<f64>| vertex.dot(f) <= 1.0 + ROUGHLY;
    (vertex.iter().all(|x| x.is_finite()) && points.iter().all(within)).then_some(vertex)
}

/// The corner of three half-spaces if it is within all others, nothing if it is beyond one of them.
fn corner(points: &[Vector3<f64>], [i, j, k]: [usize; 3]) -> Result<Option<Corner>, Undecided> {
    let exactly = |point: usize| of_numbers(&points[point]);
    let across = cross(
        &minus(&exactly(j), &exactly(i)),
        &minus(&exactly(k), &exactly(i)),
    );
    let offset = dot(&across, &exactly(i));
    if offset.contains_zero() {
        return Err(Undecided);
    }
    let vertex = across.map(|x| x / offset);
    let others = (0..points.len()).filter(|at| ![i, j, k].contains(at));
    let mut open = false;
    for other in others {
        let share = dot(&vertex, &exactly(other));
        if share.low > 1.0 {
            return Ok(None);
        }
        open |= share.high >= 1.0;
    }
    let planes = if offset.low > 0.0 {
        [i, j, k]
    } else {
        [i, k, j]
    };
    if open {
        return Err(Undecided);
    }
    Ok(Some(Corner { planes, vertex }))
}

/// Both half-spaces of every pair, moved outward; `None` if they are too many or not finite.
fn spread(half_spaces: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    let mut points: Vec<Vector3<f64>> = Vec::new();
    for f in half_spaces {
        if !f.iter().all(|x| x.is_finite()) || *f == Vector3::zeros() {
            return None;
        }
        let near = |other: &Vector3<f64>| (other - f).norm() <= SAME * f.norm();
        if points.iter().any(|known| near(known) || near(&-known)) {
            continue;
        }
        // Squares, so that no shares are in arithmetic progression.
        let number = (points.len() / 2 + 1) as f64;
        let share = (number * number * SQRT_2).fract();
        let moved = f / (1.0 + SPREAD * (1.0 + share));
        points.extend([moved, -moved]);
    }
    (points.len() <= MAX_POINTS).then_some(points)
}
