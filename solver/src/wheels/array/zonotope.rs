//! Sums of segments: facets from pairs of generators.
//!
//! The zonotope `{c + sum t_i g_i : |t_i| <= 1}` has a pair of opposite facets perpendicular to the
//! normal of every plane that two generators span. On a facet every generator outside of its plane has
//! `t_i = 1` or `-1`, and those in the plane (two, or more when axes are coplanar) make its polygon.
//! The signs of all `t_i` identify a vertex, so that vertices shared by facets are found without a
//! tolerance.

use super::plane_axes;
use super::polytope::{Facet, Polytope};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Sine of the angle below which generators count as parallel to each other or to a plane.
const PARALLEL: f64 = 1e-9;

/// The zonotope about a centre.
pub(super) fn zonotope(centre: Vector3<f64>, generators: &[Vector3<f64>]) -> Polytope {
    let generators = merged(generators);
    let mut vertices = ZonotopeVertices::new(centre, &generators);
    let mut facets = Vec::new();
    for i in 0..generators.len() {
        for j in i + 1..generators.len() {
            let normal = generators[i].cross(&generators[j]).normalize();
            let flat: Vec<usize> = (0..generators.len())
                .filter(|&k| k == i || k == j || is_flat(&normal, &generators[k]))
                .collect();
            // Coplanar generators have one plane, which is taken at its first pair.
            if flat[..2] == [i, j] {
                facets.push(facet(normal, &flat, &mut vertices));
                facets.push(facet(-normal, &flat, &mut vertices));
            }
        }
    }
    Polytope::new(vertices.points, facets)
}

fn is_flat(normal: &Vector3<f64>, generator: &Vector3<f64>) -> bool {
    normal.dot(generator).abs() <= PARALLEL * generator.norm()
}

/// Generators of which no two are parallel, with the same zonotope.
fn merged(generators: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut merged: Vec<Vector3<f64>> = Vec::new();
    for generator in generators {
        let parallel = |other: &&mut Vector3<f64>| {
            other.cross(generator).norm() <= PARALLEL * other.norm() * generator.norm()
        };
        match merged.iter_mut().find(parallel) {
            Some(other) => *other += generator * generator.dot(other).signum(),
            None => merged.push(*generator),
        }
    }
    merged
}

/// The facet with an outward normal, whose polygon the generators `flat` make.
fn facet(normal: Vector3<f64>, flat: &[usize], vertices: &mut ZonotopeVertices) -> Facet {
    let generators = vertices.generators;
    let mut ends: Vec<bool> = generators.iter().map(|g| normal.dot(g) > 0.0).collect();
    let (first, second) = plane_axes(&normal);
    // Each generator or its opposite, whichever has its angle in [0, pi). `atan2` depends on the sign of
    // zeros, so that y = 0 is treated first.
    let mut turning: Vec<(f64, usize, bool)> = flat
        .iter()
        .map(|&k| {
            let (x, y) = (first.dot(&generators[k]), second.dot(&generators[k]));
            let sense = y > 0.0 || (y == 0.0 && x > 0.0);
            let angle = if sense { y.atan2(x) } else { (-y).atan2(-x) };
            (angle, k, sense)
        })
        .collect();
    turning.sort_by(|a, b| a.0.total_cmp(&b.0));
    for &(_, k, sense) in &turning {
        ends[k] = !sense;
    }
    // Around the polygon: in order of their angles every generator changes its sign, and then back.
    let mut corners = Vec::with_capacity(2 * flat.len());
    for &(_, k, _) in turning.iter().chain(&turning) {
        ends[k] = !ends[k];
        corners.push(vertices.at(&ends));
    }
    let heights = corners
        .iter()
        .map(|&corner| normal.dot(&vertices.points[corner]));
    Facet {
        normal,
        distance: heights.sum::<f64>() / corners.len() as f64,
        vertices: corners,
    }
}

/// The vertices found so far, by the signs of the generators.
struct ZonotopeVertices<'a> {
    centre: Vector3<f64>,
    generators: &'a [Vector3<f64>],
    points: Vec<Vector3<f64>>,
    known: BTreeMap<Vec<bool>, usize>,
}

impl<'a> ZonotopeVertices<'a> {
    fn new(centre: Vector3<f64>, generators: &'a [Vector3<f64>]) -> Self {
        Self {
            centre,
            generators,
            points: Vec::new(),
            known: BTreeMap::new(),
        }
    }

    /// Position of the vertex with these signs of the generators; true is 1.
    fn at(&mut self, ends: &[bool]) -> usize {
        if let Some(&position) = self.known.get(ends) {
            return position;
        }
        let signed = |(g, &end): (&Vector3<f64>, &bool)| if end { *g } else { -g };
        let offset: Vector3<f64> = self.generators.iter().zip(ends).map(signed).sum();
        self.points.push(self.centre + offset);
        self.known.insert(ends.to_vec(), self.points.len() - 1);
        self.points.len() - 1
    }
}
