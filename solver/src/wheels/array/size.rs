//! Radii and volume of a polytope.

use super::mean_radius::mean_radius;
use super::polytope::Polytope;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Radii and volume of a polytope, in the unit of its vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolytopeSize {
    /// Radius of the largest sphere about the origin inside it.
    pub inscribed_radius: f64,
    /// Distance of the farthest vertex from the origin.
    pub greatest_radius: f64,
    /// Volume.
    pub volume: f64,
    /// Radius of the sphere of the same volume.
    pub equal_volume_radius: f64,
    /// Mean over all directions of the distance of the surface from the origin.
    pub mean_radius: f64,
}

impl Polytope {
    /// Its radii and volume.
    #[must_use]
    pub fn size(&self) -> PolytopeSize {
        let volume = self.volume();
        let distances = self.facets().iter().map(|facet| facet.distance);
        let lengths = self.vertices().iter().map(Vector3::norm);
        PolytopeSize {
            inscribed_radius: distances.fold(f64::INFINITY, f64::min),
            greatest_radius: lengths.fold(0.0, f64::max),
            volume,
            equal_volume_radius: (0.75 * volume / PI).cbrt(),
            mean_radius: mean_radius(self),
        }
    }
}
