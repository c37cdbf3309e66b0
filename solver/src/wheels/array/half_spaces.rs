//! Intersections of half spaces with the origin inside: vertices from triples of planes.

use super::polytope::{Facet, Polytope};
use super::{plane_axes, rows};
use nalgebra::Vector3;

/// Volume spanned by three unit normals below which their planes count as not meeting in a point.
const MIN_SPAN: f64 = 1e-9;
/// Distance relative to the body's size within which points are the same, or on a plane.
const SAME: f64 = 1e-9;

/// The body `{y : normal . y <= distance}` of planes given by unit normals and distances above zero.
///
/// The planes must bound it in all directions.
pub(super) fn polytope(planes: &[(Vector3<f64>, f64)]) -> Polytope {
    let planes = tightest(planes);
    let vertices = vertices(&planes);
    let size = vertices.iter().map(Vector3::norm).fold(0.0, f64::max);
    // A plane with fewer than three vertices has no facet.
    let facets = planes
        .iter()
        .map(|&(normal, distance)| {
            let on_plane = |v: &Vector3<f64>| (normal.dot(v) - distance).abs() <= SAME * size;
            let corners = (0..vertices.len())
                .filter(|&i| on_plane(&vertices[i]))
                .collect();
            Facet {
                normal,
                distance,
                vertices: around(&normal, corners, &vertices),
            }
        })
        .filter(|facet| facet.vertices.len() > 2)
        .collect();
    Polytope::new(vertices, facets)
}

/// Of all planes with the same normal the one nearest to the origin.
fn tightest(planes: &[(Vector3<f64>, f64)]) -> Vec<(Vector3<f64>, f64)> {
    let mut tightest: Vec<(Vector3<f64>, f64)> = Vec::new();
    for &(normal, distance) in planes {
        match tightest
            .iter_mut()
            .find(|(other, _)| (other - normal).norm() <= SAME)
        {
            Some((_, least)) => *least = least.min(distance),
            None => tightest.push((normal, distance)),
        }
    }
    tightest
}

/// The points in which three planes meet and that lie within all others.
fn vertices(planes: &[(Vector3<f64>, f64)]) -> Vec<Vector3<f64>> {
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    for (i, first) in planes.iter().enumerate() {
        for (j, second) in planes.iter().enumerate().skip(i + 1) {
            for third in &planes[j + 1..] {
                let normals = rows([&first.0, &second.0, &third.0]);
                if normals.determinant().abs() < MIN_SPAN {
                    continue;
                }
                let distances = Vector3::new(first.1, second.1, third.1);
                let Some(point) = normals.lu().solve(&distances) else {
                    continue;
                };
                let near = SAME * point.norm();
                let inside = planes.iter().all(|(n, d)| n.dot(&point) <= d + near);
                // More than three planes may meet in a point, which counts once.
                if inside && vertices.iter().all(|known| (known - point).norm() > near) {
                    vertices.push(point);
                }
            }
        }
    }
    vertices
}

/// Corners of a facet counter-clockwise about its normal.
fn around(normal: &Vector3<f64>, mut corners: Vec<usize>, vertices: &[Vector3<f64>]) -> Vec<usize> {
    let middle = corners.iter().map(|&i| vertices[i]).sum::<Vector3<f64>>() / corners.len() as f64;
    let (first, second) = plane_axes(normal);
    let angle = |i: usize| {
        let arm = vertices[i] - middle;
        second.dot(&arm).atan2(first.dot(&arm))
    };
    corners.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    corners
}
