//! A convex body with flat facets that has the origin inside.

use super::mean_radius::mean_radius;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// One facet of a polytope.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Outward unit normal.
    pub normal: Vector3<f64>,
    /// Distance of its plane from the origin, above zero.
    pub distance: f64,
    /// Its corners as positions in the list of vertices, counter-clockwise seen from outside.
    pub vertices: Vec<usize>,
}

/// A convex polytope with the origin inside, given by its vertices and its facets.
#[derive(Debug, Clone, PartialEq)]
pub struct Polytope {
    vertices: Vec<Vector3<f64>>,
    facets: Vec<Facet>,
}

/// How large a polytope is, in the unit of its vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Radius of the largest sphere about the origin inside it: what is there in every direction.
    pub inscribed_radius: f64,
    /// Distance of the farthest vertex from the origin.
    pub greatest_radius: f64,
    /// Volume.
    pub volume: f64,
    /// Radius of the sphere of the same volume.
    pub equal_volume_radius: f64,
    /// Mean over all directions of what is there.
    pub mean_radius: f64,
}

impl Polytope {
    /// A polytope of facets that are known to bound it.
    pub(super) fn new(vertices: Vec<Vector3<f64>>, facets: Vec<Facet>) -> Self {
        Self { vertices, facets }
    }

    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// The facets.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The edges as pairs of positions in the list of vertices, the lower one first, in order.
    #[must_use]
    pub fn edges(&self) -> Vec<(usize, usize)> {
        let sides = self.facets.iter().flat_map(|facet| {
            let next = facet.vertices.iter().cycle().skip(1);
            facet.vertices.iter().zip(next)
        });
        // Every edge has a facet on either side, which run along it in opposite senses.
        let mut edges: Vec<_> = sides
            .filter(|(a, b)| a < b)
            .map(|(a, b)| (*a, *b))
            .collect();
        edges.sort_unstable();
        edges
    }

    /// The share of the polytope that a vector uses: 1 on its surface, less inside. The vector
    /// divided by it is the surface point in the same direction.
    #[must_use]
    pub fn share(&self, vector: &Vector3<f64>) -> f64 {
        self.facets
            .iter()
            .map(|facet| facet.normal.dot(vector) / facet.distance)
            .fold(0.0, f64::max)
    }

    /// How far the polytope reaches along a direction (of any length but zero).
    #[must_use]
    pub fn reach(&self, direction: &Vector3<f64>) -> f64 {
        direction.norm() / self.share(direction)
    }

    /// Volume: pyramids from the origin over the facets, each a fan of triangles.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let triple = |a: usize, b: usize, c: usize| {
            let [a, b, c] = [a, b, c].map(|i| &self.vertices[i]);
            a.cross(b).dot(c) / 6.0
        };
        self.facets
            .iter()
            .flat_map(|facet| {
                let corners = &facet.vertices;
                corners[1..]
                    .windows(2)
                    .map(|pair| triple(corners[0], pair[0], pair[1]))
            })
            .sum()
    }

    /// How large it is.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let volume = self.volume();
        let distances = self.facets.iter().map(|facet| facet.distance);
        let lengths = self.vertices.iter().map(Vector3::norm);
        Figures {
            inscribed_radius: distances.fold(f64::INFINITY, f64::min),
            greatest_radius: lengths.fold(0.0, f64::max),
            volume,
            equal_volume_radius: (0.75 * volume / PI).cbrt(),
            mean_radius: mean_radius(self),
        }
    }
}
