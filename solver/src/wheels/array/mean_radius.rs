//! The mean over all directions of the distance from the origin to the surface of a polytope.
//!
//! In the cone of a facet at distance `d` from the origin, `r` is the distance of the facet's point in
//! a direction, and an element `dA` of the facet fills the solid angle `d dA / r^3`. With the distance
//! `p` of an edge from the foot of the perpendicular, and `t` along that edge, Green's theorem gives
//!
//! ```text
//!   sum over facets  d / 2  sum over edges  p  integral  ln(1 + (p^2 + t^2) / d^2) / (p^2 + t^2)  dt
//! ```
//!
//! which divided by `4 pi` is the mean. The integrand's singularities nearest to the real axis are
//! `t = +-i s` with `s = sqrt(p^2 + d^2)`. With `t = s sinh(v)` they are at the distance `pi / 2` from the
//! real axis for every `v`, so that Gauss's rule on pieces of unit length in `v` is exact to rounding.
//! An edge `1e9` times as long as the distance of its facet has some forty pieces.

use super::plane_axes;
use super::polytope::{Facet, Polytope};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;

/// Nodes of Gauss's rule: an error of `6.4^(-2 NODES)` on a piece.
const NODES: usize = 13;
/// Greatest number of pieces: `v` spans less than this for any finite numbers.
const MAX_PIECES: u32 = 3000;
/// Newton steps from Chebyshev's to Legendre's nodes, more than convergence needs.
const NEWTON_STEPS: usize = 8;

/// The mean radius.
pub(super) fn mean_radius(polytope: &Polytope) -> f64 {
    let rule = gauss();
    let total: f64 = polytope
        .facets()
        .iter()
        .map(|facet| over_facet(facet, polytope.vertices(), &rule))
        .sum();
    total / (4.0 * PI)
}

fn over_facet(facet: &Facet, vertices: &[Vector3<f64>], rule: &[(f64, f64)]) -> f64 {
    let (first, second) = plane_axes(&facet.normal);
    let in_plane = |i: &usize| Vector2::new(first.dot(&vertices[*i]), second.dot(&vertices[*i]));
    let corners: Vec<_> = facet.vertices.iter().map(in_plane).collect();
    let next = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(next);
    let sum: f64 = edges
        .map(|(a, b)| over_edge(a, b, facet.distance, rule))
        .sum();
    0.5 * facet.distance * sum
}

fn over_edge(a: &Vector2<f64>, b: &Vector2<f64>, d: f64, rule: &[(f64, f64)]) -> f64 {
    let along = (b - a).normalize();
    let p = a.perp(&along);
    let scale = p.hypot(d);
    let (begin, end) = (
        (a.dot(&along) / scale).asinh(),
        (b.dot(&along) / scale).asinh(),
    );
    let integrand = |v: f64| {
        let t = scale * v.sinh();
        let x = (p * p + t * t) / (d * d);
        // ln(1 + x) / x tends to one.
        let ratio = if x > 0.0 { x.ln_1p() / x } else { 1.0 };
        ratio / (d * d) * scale * v.cosh()
    };
    let pieces = (end - begin).ceil().max(1.0);
    let half = 0.5 * (end - begin) / pieces;
    let sum: f64 = (0..MAX_PIECES)
        .map(f64::from)
        .take_while(|piece| *piece < pieces)
        .map(|piece| {
            let middle = begin + half * (2.0 * piece + 1.0);
            let nodes = rule.iter();
            nodes
                .map(|(node, weight)| weight * integrand(middle + half * node))
                .sum::<f64>()
        })
        .sum();
    p * half * sum
}

/// Nodes in `[-1, 1]` and weights of Gauss's rule.
fn gauss() -> Vec<(f64, f64)> {
    (0..NODES)
        .map(|i| {
            let mut node = (PI * (i as f64 + 0.75) / (NODES as f64 + 0.5)).cos();
            for _ in 0..NEWTON_STEPS {
                let (value, slope) = legendre(node);
                node -= value / slope;
            }
            let slope = legendre(node).1;
            (node, 2.0 / ((1.0 - node * node) * slope * slope))
        })
        .collect()
}

/// Legendre's polynomial of degree [`NODES`] with its derivative.
fn legendre(x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for degree in 2..=NODES {
        let n = degree as f64;
        (before, value) = (
            value,
            ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n,
        );
    }
    let slope = NODES as f64 * (x * value - before) / (x * x - 1.0);
    (value, slope)
}
