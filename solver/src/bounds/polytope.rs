//! The least time of a turn with body rates in a polytope, enclosed by proved bounds.
//!
//! [`crate::bounds::kinematic`] does the same for boxes. The rates that an array of wheels reaches are a
//! zonotope, and limits that act together have no box either: the least time within a polytope `K` that
//! contains them is the larger. `K` is symmetric, `h_K(m) = max over K of m . w` its support function and `G`
//! its gauge, the norm whose unit ball it is. The conventions are those of [`crate::model::attitude`].
//!
//! # The extremals
//!
//! `R' = R S(w)`, `w` in `K`, is to reach a rotation in the least time. The set of rates is convex and compact and
//! contains a neighbourhood of zero, so every rotation is reached and a least time is attained. By Pontryagin's
//! principle there is a costate `M = R^T A`, `A` fixed in space, that is never zero, with `M' = M x w`, `w`
//! maximising `M . w`, and the maximum constant: `h = h_K(M) > 0` for `|M| = 1`. So `M` runs along a level curve
//! of `h_K` on the unit sphere.
//!
//! * Where one vertex `v` of `K` supports `M`, the rate is `v`, and `M` turns about it: the level curve is the
//!   circle `M . v = h`, run through at `|v|` rad/s (`level_curves`).
//! * Where two, `v` and `v'`, support it, `(M . (v - v'))' = - M . (v x v')` for every rate between them. Unless
//!   that is zero the flow passes from the one circle to the other. It is zero only where `M` is parallel to the
//!   perpendicular on the line through both. If its foot lies outside the edge, no rate of the edge is parallel to
//!   `M`, which passes. If it lies within, the point is a saddle of `h_K`, at which `M` may rest with the
//!   foot as the rate: a *dwell* (`dwells`).
//! * Where a facet supports it, `M` is normal to it. It rests if the foot of the perpendicular lies in the facet, a
//!   minimum of `h_K`, and the rate is the foot; otherwise it passes.
//!
//! So extremals are of three kinds. **Regular** ones flow along a curve of a level that is not that of a saddle.
//! **Dwelling** ones are on the level of a saddle. Turns at a constant rate about a vertex or across a facet are
//! limits of regular ones, around curves that shrink to a point.
//!
//! # One equation
//!
//! A turn `R` takes `M` at its beginning to `R^T M` at its end, and both must be on one curve. For two vertices
//! that support the first and the second, the costates with equal levels are a part of a great circle
//! (`pairs`): one free parameter. The flow from the one to the other is known, and differs from `R` by a turn about
//! the costate: one equation in one unknown, whose derivative is `-h` times that of the time (`cells`). Cells of
//! the parameter are bounded, and the one with the least bound is halved until a motion attains it (`search`).
//! Dwelling extremals have no free parameter: their dwell makes up for the turn about the costate.
//!
//! Ways that lead around a small curve very often are bounded together: their costates stay near an axis, about
//! which they twist no faster than `K` allows (`cells`).
//!
//! # General position and rounding
//!
//! Facets are moved outward by some 1e-7 of their distance, each by another share, so that three meet in every
//! vertex; a larger set of rates is no slower. The turn is changed by 1e-8 of itself about an axis that no
//! symmetry prefers, so that no vertex turns into another one; the time of that change at the distance of the
//! nearest facet is given away. What remains is rounding: times of flows are accurate to some 1e-13 and have a
//! margin of 1e-10 in the equation; results are reduced by 1e-9.
//!
//! # Sources
//!
//! Pontryagin's maximum principle is standard. The costate as the normal of the front of reached turns is
//! Hamilton-Jacobi theory. The enumeration is derived here. Boxes are a special case: the tests compare.

mod cells;
pub mod certificate;
mod dwells;
mod faces;
mod flow;
mod level_curves;
mod pairs;
mod search;
#[cfg(test)]
mod tests;
pub mod trapezoid;

use crate::model::attitude::Attitude;
use faces::Faces;
use level_curves::LevelCurves;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

/// Change of a turn, as a share of its angle.
const MOVED: f64 = 1e-8;
/// Share of a time below which a search is not worth its while.
const CLOSE_ENOUGH: f64 = 1e-3;
/// Relative reduction of a bound for the rounding of its last operations.
const DEFLATION: f64 = 1e-9;

/// A symmetric polytope of body rates with the level curves of its support function. Building it takes a
/// millisecond; it can be shared between threads.
#[derive(Debug, Clone)]
pub struct RatePolytope {
    curves: LevelCurves,
    /// Facets `f . w = 1` in normalised rates.
    facets: Vec<Vector3<f64>>,
    /// The largest rate, rad/s: normalised rates are the true ones divided by it.
    fastest: f64,
    /// The distance of the nearest facet, normalised.
    inner: f64,
}

/// The least time of a turn, enclosed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastTime {
    /// No motion within the polytope is faster, s.
    pub lower_s: f64,
    /// A motion within the polytope takes so long, s.
    pub upper_s: f64,
}

impl RatePolytope {
    /// The rates with `|f . w| <= 1` for all of these vectors `f`, in s/rad. `None` where these are not
    /// limited in all directions, or where there are more than forty vectors.
    #[must_use]
    pub fn within(half_spaces: &[Vector3<f64>]) -> Option<Self> {
        let faces = Faces::of(half_spaces)?;
        let fastest = faces.vertices.iter().map(Vector3::norm).fold(0.0, f64::max);
        let normalised = Faces {
            vertices: faces
                .vertices
                .iter()
                .map(|vertex| vertex / fastest)
                .collect(),
            facets: faces.facets.iter().map(|facet| facet * fastest).collect(),
            ..faces
        };
        let steepest = normalised.facets.iter().map(Vector3::norm);
        Some(Self {
            curves: LevelCurves::of(&normalised),
            inner: steepest.fold(0.0, f64::max).recip(),
            facets: normalised.facets,
            fastest,
        })
    }

    /// The least time of a turn (either sign of the quaternion) to a relative tolerance.
    #[must_use]
    pub fn least_time(&self, turn: &Attitude, tolerance: f64) -> LeastTime {
        let [x, y, z, w] = turn.xyzw();
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        let given = Unit::new_normalize(Quaternion::new(w, x, y, z) * sign);
        let angle = given.angle();
        let (straight, upper) = (self.straight(&given), self.gauge(&given.scaled_axis()));
        if straight >= upper * (1.0 - CLOSE_ENOUGH) {
            return LeastTime {
                lower_s: straight * (1.0 - DEFLATION) / self.fastest,
                upper_s: upper / self.fastest,
            };
        }
        let moved = MOVED * angle;
        let aside = Vector3::new(0.424, -0.633, 0.647).normalize() * moved;
        let turn = given * UnitQuaternion::from_scaled_axis(aside);
        let axis = turn.axis().unwrap_or(Vector3::x_axis());
        let found = search::search(self, turn, &axis, tolerance);
        let away = moved / self.inner;
        let lower = (found.lower - away).max(straight);
        LeastTime {
            lower_s: lower * (1.0 - DEFLATION) / self.fastest,
            upper_s: (found.upper + away) / self.fastest,
        }
    }

    /// The largest rate, rad/s.
    #[must_use]
    pub fn fastest_rad_s(&self) -> f64 {
        self.fastest
    }

    /// The time of a turn by a rotation vector, rad, at a constant rate, s.
    #[must_use]
    pub fn constant_rate_s(&self, vector: &Vector3<f64>) -> f64 {
        self.gauge(vector) / self.fastest
    }

    /// The longest time, s, that a turn by an angle, rad, takes about any axis at a constant rate.
    #[must_use]
    pub fn slowest_s(&self, angle: f64) -> f64 {
        angle / (self.inner * self.fastest)
    }

    /// A lower bound on the normalised time of a small turn, which is nearly as long as its rotation vector.
    ///
    /// The rotation vector `x` of a motion has `x' = w + (1/2) x X w + ...`, with `|x' - w| <= |w| (|x| / 2 + |x|^2 / 10)`
    /// for `|x| <= 1`. On the way of a turn by `a` in a time up to `u`, at rates up to one, `|x| <= (a + u) / 2 = l`.
    /// So `G(x) <= int G(x') dt <= V (1 + (l / 2 + l^2 / 10) / r)` with the distance `r` of the nearest facet.
    fn straight(&self, turn: &UnitQuaternion<f64>) -> f64 {
        let at_constant_rate = self.gauge(&turn.scaled_axis());
        let farthest = 0.5 * (turn.angle() + at_constant_rate);
        if farthest > 1.0 {
            return 0.0;
        }
        let bent = 0.5 * farthest + 0.1 * farthest * farthest;
        at_constant_rate / (1.0 + bent / self.inner)
    }

    /// The gauge of normalised rates.
    fn gauge(&self, vector: &Vector3<f64>) -> f64 {
        let shares = self.facets.iter().map(|facet| facet.dot(vector));
        shares.fold(0.0, f64::max)
    }
}
