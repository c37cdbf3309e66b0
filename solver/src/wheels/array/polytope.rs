//! A convex polytope with the origin inside.

use nalgebra::Vector3;

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

impl Polytope {
    /// A polytope of vertices and facets, which must belong together.
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
        // Every edge belongs to two facets, which have it in opposite directions.
        let mut edges: Vec<_> = sides
            .filter(|(a, b)| a < b)
            .map(|(a, b)| (*a, *b))
            .collect();
        edges.sort_unstable();
        edges
    }

    /// The length of a vector over the distance of the surface in its direction: 1 on the surface, less
    /// inside.
    #[must_use]
    pub fn share(&self, vector: &Vector3<f64>) -> f64 {
        self.facets
            .iter()
            .map(|facet| facet.normal.dot(vector) / facet.distance)
            .fold(0.0, f64::max)
    }

    /// Distance of the surface in a direction, given by a vector of any length but zero.
    #[must_use]
    pub fn reach(&self, direction: &Vector3<f64>) -> f64 {
        direction.norm() / self.share(direction)
    }

    /// Volume, as the sum of tetrahedra from the origin over the triangles of every facet.
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
}
