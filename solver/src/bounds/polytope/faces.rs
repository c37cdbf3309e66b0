//! Vertices and edges of a polytope that half-spaces give.
//!
//! The vertices of `{w : f_k . w <= 1}` are the facets of the convex hull of the points `f_k` (polar
//! duality): a hull facet through three points lies in the plane `v . f = 1`, and `v` is where their
//! half-spaces meet. Two vertices share an edge where their hull facets share two points.

use crate::math::random::SplitMix;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Largest number of pairs of half-spaces: hull facets are found by trying all triples.
const MAX_PAIRS: usize = 40;
/// Half-spaces are moved outward by one to two of these shares, each by another one, so that no four
/// of them meet in a point.
const SPREAD: f64 = 1e-7;
/// Number of shares.
const SHARES: usize = 1 << 32;
/// Relative difference below which two half-spaces are one.
const SAME: f64 = 1e-6;
/// Volume of three points, relative to the cube of the largest, below which they span no facet.
const FLAT: f64 = 1e-13;
/// A polytope that is symmetric about the origin, every vertex on three facets.
#[derive(Debug, Clone)]
pub(super) struct Faces {
    pub(super) vertices: Vec<Vector3<f64>>,
    /// For each vertex, the three at the other ends of its edges.
    pub(super) neighbours: Vec<[usize; 3]>,
    /// The facets `f . w = 1`.
    pub(super) facets: Vec<Vector3<f64>>,
}

impl Faces {
    /// The faces of a polytope slightly larger than `{w : |f . w| <= 1 for all f}`; `None` where that
    /// is unbounded or has too many faces.
    pub(super) fn of(half_spaces: &[Vector3<f64>]) -> Option<Self> {
        let points = spread(half_spaces)?;
        let triples = hull_facets(&points)?;
        let vertices: Vec<_> = triples.iter().map(|(_, vertex)| *vertex).collect();
        let mut sides: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (facet, ([i, j, k], _)) in triples.iter().enumerate() {
            for side in [[*i, *j], [*j, *k], [*i, *k]] {
                sides.entry(side).or_default().push(facet);
            }
        }
        let mut neighbours = vec![Vec::new(); vertices.len()];
        for pair in sides.values() {
            let [one, other] = pair.as_slice().try_into().ok()?;
            let (one, other): (usize, usize) = (one, other);
            neighbours[one].push(other);
            neighbours[other].push(one);
        }
        let neighbours = neighbours
            .into_iter()
            .map(|near| near.try_into().ok())
            .collect::<Option<Vec<[usize; 3]>>>()?;
        let mut used: Vec<usize> = triples.iter().flat_map(|(triple, _)| *triple).collect();
        used.sort_unstable();
        used.dedup();
        let facets: Vec<_> = used.into_iter().map(|index| points[index]).collect();
        // Euler's formula, with three edges at each vertex.
        (2 * facets.len() == vertices.len() + 4).then_some(Self {
            vertices,
            neighbours,
            facets,
        })
    }
}

/// Both half-spaces of every pair, moved outward; `None` if they are too many or not finite.
fn spread(half_spaces: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    let mut points: Vec<Vector3<f64>> = Vec::new();
    let mut shares = SplitMix::new(1);
    for f in half_spaces {
        if !f.iter().all(|x| x.is_finite()) || *f == Vector3::zeros() {
            return None;
        }
        let near = |other: &Vector3<f64>| (other - f).norm() <= SAME * f.norm();
        if points.iter().any(|known| near(known) || near(&-known)) {
            continue;
        }
        if points.len() == 2 * MAX_PAIRS {
            return None;
        }
        let share = shares.below(SHARES) as f64 / SHARES as f64;
        let moved = f / (1.0 + SPREAD * (1.0 + share));
        points.extend([moved, -moved]);
    }
    Some(points)
}

/// The triples of points that span facets of their hull, with the vertex `v . f = 1` that each stands
/// for. `None` where the hull does not have the origin in its interior.
fn hull_facets(points: &[Vector3<f64>]) -> Option<Vec<([usize; 3], Vector3<f64>)>> {
    let size = points.iter().map(Vector3::norm).fold(0.0, f64::max);
    let mut facets = Vec::new();
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            for k in j + 1..points.len() {
                let across = (points[j] - points[i]).cross(&(points[k] - points[i]));
                let offset = across.dot(&points[i]);
                if offset.abs() < FLAT * size.powi(3) {
                    continue;
                }
                let vertex = across / offset;
                let mut others = points.iter().enumerate();
                if others.all(|(at, f)| [i, j, k].contains(&at) || vertex.dot(f) < 1.0) {
                    facets.push(([i, j, k], vertex));
                }
            }
        }
    }
    (facets.len() >= 4).then_some(facets)
}
