//! Clusters of single-gimbal control moment gyroscopes: momentum map and singular states.
//!
//! Rotor `i` has a momentum of one unit perpendicular to its gimbal axis `g_i`, turned by the gimbal
//! angle `d_i` from a direction `s_i` towards `t_i = g_i x s_i`:
//!
//! ```text
//!   h(d) = sum cos d_i s_i + sin d_i t_i,        dh / dd_i = g_i x h_i
//! ```
//!
//! A state is singular when all `dh / dd_i` are perpendicular to one direction `u`: no torque along `u`
//! is possible. Then every `h_i` lies in the plane of `g_i` and `u` (RW/CMG thesis, equations 256 to
//! 260):
//!
//! ```text
//!   h_i = e_i (g_i x u) x g_i / |g_i x u|,       e_i = +-1
//! ```
//!
//! so that the singular momenta are surfaces over the sphere of directions, one per pattern of signs;
//! the opposite pattern gives the same surface. Equal signs give the outer surface, where the momentum
//! along `u` is largest. The others are internal.
//!
//! # Which internal states can be passed
//!
//! Null motion, `sum dh/dd_i dd_i = 0`, changes the momentum along `u` in second order by
//! `-1/2 sum e_i |g_i x u| dd_i^2`. If this form is definite on the null space, no null motion leaves
//! the singular state: it is *elliptic* and impassable. If it is indefinite, null motion can: the
//! state is *hyperbolic*. Here the eigenvalues of the form decide ([`SingularState::passability`]).
//!
//! # Differences from the thesis, for its pyramid
//!
//! The thesis takes all states with one sign reversed for elliptic and gives 1.0069 h as the least
//! momentum among them, the radius of its guaranteed sphere. That number is the least over a 20 x 20
//! grid of directions. Near the gimbal axes the momenta tend to 1.0 h
//! ([`CmgCluster::least_with_one_reversed`]), as in the thesis's own reference. By the eigenvalues the
//! states there are hyperbolic; elliptic ones begin at `2 / sqrt(3) = 1.1547` h
//! ([`CmgCluster::least_elliptic`]).

mod extremes;

pub use extremes::Rim;

use nalgebra::{DMatrix, Matrix3xX, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Sine of the angle to a gimbal axis below which a direction counts as along it.
const ALONG: f64 = 1e-9;
/// Eigenvalue below which a second-order form is not definite.
const DEFINITE: f64 = 1e-9;

/// Greatest number of circles of latitude of a singular surface: 80,000 states, some 12 MB for four
/// gyroscopes.
pub const MAX_SURFACE_ROWS: usize = 200;

/// A rotor with its gimbal.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gimbal {
    /// `g`: gimbal axis, unit.
    axis: Vector3<f64>,
    /// `s`: direction of the rotor's momentum at the gimbal angle zero, unit.
    zero: Vector3<f64>,
}

/// Gyroscopes of equal momentum, taken as one unit each.
#[derive(Debug, Clone, PartialEq)]
pub struct CmgCluster {
    gimbals: Vec<Gimbal>,
}

/// Whether null motion can leave a singular state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Passability {
    /// On the outer surface: the momentum in that direction is the greatest.
    External,
    /// Internal and impassable.
    Elliptic,
    /// Internal, and null motion leads out of it.
    Hyperbolic,
}

/// A state in which no torque along one direction is possible.
#[derive(Debug, Clone, PartialEq)]
pub struct SingularState {
    /// `u`: the direction without torque, unit, body axes.
    pub direction: Vector3<f64>,
    /// Momentum of the cluster in units of a rotor's, body axes.
    pub momentum: Vector3<f64>,
    /// Gimbal angles, rad.
    pub angles: Vec<f64>,
    /// Whether null motion can leave it.
    pub passability: Passability,
}

/// A singular surface over a grid of directions.
#[derive(Debug, Clone, PartialEq)]
pub struct SingularSurface {
    /// Whether each rotor's momentum is along the direction (true) or against it.
    pub signs: Vec<bool>,
    /// Number of circles of latitude from pole to pole; each has twice as many points.
    pub rows: usize,
    /// The states row by row; `None` where the direction is along a gimbal axis.
    pub states: Vec<Option<SingularState>>,
}

impl CmgCluster {
    /// Four gyroscopes on the sides of a square pyramid, whose gimbal axes
    /// `(sin b, 0, cos b), (0, sin b, cos b), (-sin b, 0, cos b), (0, -sin b, cos b)` are at the skew
    /// angle `b` (rad) from its axis. At zero gimbal angles the momenta are horizontal.
    #[must_use]
    pub fn pyramid(skew: f64) -> Self {
        let (s, c) = skew.sin_cos();
        let gimbals = (0..4).map(|i| {
            let (y, x) = (FRAC_PI_2 * f64::from(i)).sin_cos();
            Gimbal {
                axis: Vector3::new(s * x, s * y, c),
                zero: Vector3::new(-y, x, 0.0),
            }
        });
        Self {
            gimbals: gimbals.collect(),
        }
    }

    /// The thesis's pyramid: its skew angle of 54.74 degrees has the cosine `1 / sqrt(3)`.
    #[must_use]
    pub fn thesis() -> Self {
        Self::pyramid(2.0_f64.sqrt().atan())
    }

    /// Number of gyroscopes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.gimbals.len()
    }

    /// Momentum of the cluster in units of a rotor's, body axes, at gimbal angles, rad.
    ///
    /// # Panics
    ///
    /// When there are fewer angles than gyroscopes.
    #[must_use]
    pub fn momentum(&self, angles: &[f64]) -> Vector3<f64> {
        let gimbals = self.gimbals.iter().enumerate();
        gimbals.map(|(i, gimbal)| gimbal.momentum(angles[i])).sum()
    }

    /// Its derivatives by the gimbal angles as columns, 3 x K.
    ///
    /// # Panics
    ///
    /// When there are fewer angles than gyroscopes.
    #[must_use]
    pub fn jacobian(&self, angles: &[f64]) -> Matrix3xX<f64> {
        let gimbals = self.gimbals.iter().enumerate();
        let columns: Vec<_> = gimbals
            .map(|(i, gimbal)| gimbal.axis.cross(&gimbal.momentum(angles[i])))
            .collect();
        Matrix3xX::from_columns(&columns)
    }

    /// The patterns of signs, one of every two opposite ones: the first rotor is always along the
    /// direction, and the first pattern is that of the outer surface.
    #[must_use]
    pub fn sign_patterns(&self) -> Vec<Vec<bool>> {
        let free = self.count() - 1;
        (0..1_u64 << free)
            .map(|bits| {
                let others = (0..free).map(|i| (bits >> i) & 1 == 0);
                std::iter::once(true).chain(others).collect()
            })
            .collect()
    }

    /// The singular state of a unit direction and a pattern of signs, one per gyroscope. `None` when
    /// the direction is along a gimbal axis: then every gimbal angle of that rotor is singular ([`Rim`]).
    #[must_use]
    pub fn singular_state(
        &self,
        direction: &Vector3<f64>,
        signs: &[bool],
    ) -> Option<SingularState> {
        let mut angles = Vec::with_capacity(self.count());
        let mut along = Vec::with_capacity(self.count());
        for (gimbal, &sign) in self.gimbals.iter().zip(signs) {
            let size = gimbal.axis.cross(direction).norm();
            if size < ALONG {
                return None;
            }
            let sign = if sign { 1.0 } else { -1.0 };
            let side = gimbal.axis.cross(&gimbal.zero);
            let (x, y) = (gimbal.zero.dot(direction), side.dot(direction));
            angles.push((sign * y).atan2(sign * x));
            along.push(sign * size);
        }
        Some(SingularState {
            direction: *direction,
            momentum: self.momentum(&angles),
            passability: self.passability(&angles, &along),
            angles,
        })
    }

    /// Passability by the eigenvalues of the second-order form with the given diagonal, restricted to the
    /// null space of the Jacobian.
    fn passability(&self, angles: &[f64], along: &[f64]) -> Passability {
        if along.iter().all(|x| *x > 0.0) || along.iter().all(|x| *x < 0.0) {
            return Passability::External;
        }
        let count = self.count();
        let jacobian = self.jacobian(angles);
        let gram = jacobian.tr_mul(&jacobian).symmetric_eigen();
        // All columns are perpendicular to one direction: the rank is at most two.
        let null = gram.eigenvalues.iter().enumerate();
        let null: Vec<_> = null
            .filter(|(_, value)| **value < DEFINITE)
            .map(|(i, _)| gram.eigenvectors.column(i).into_owned())
            .collect();
        let null = DMatrix::from_fn(count, null.len(), |i, j| null[j][i]);
        let diagonal = DMatrix::from_fn(count, count, |i, j| if i == j { along[i] } else { 0.0 });
        let form = null.tr_mul(&(diagonal * &null)).symmetric_eigenvalues();
        if form.iter().all(|x| *x > DEFINITE) || form.iter().all(|x| *x < -DEFINITE) {
            Passability::Elliptic
        } else {
            Passability::Hyperbolic
        }
    }

    /// The singular surface of a pattern of signs over a grid with `rows` circles of latitude, without
    /// the poles, and twice as many meridians. `rows` is limited to [`MAX_SURFACE_ROWS`].
    #[must_use]
    pub fn singular_surface(&self, signs: &[bool], rows: usize) -> SingularSurface {
        let rows = rows.min(MAX_SURFACE_ROWS);
        let directions = grid(rows);
        SingularSurface {
            signs: signs.to_vec(),
            rows,
            states: directions.map(|u| self.singular_state(&u, signs)).collect(),
        }
    }
}

impl Gimbal {
    fn momentum(&self, angle: f64) -> Vector3<f64> {
        let (s, c) = angle.sin_cos();
        self.zero * c + self.axis.cross(&self.zero) * s
    }
}

/// Unit directions, row by row from one pole to the other.
fn grid(rows: usize) -> impl Iterator<Item = Vector3<f64>> {
    let columns = 2 * rows;
    (0..rows * columns).map(move |i| {
        let polar = std::f64::consts::PI * ((i / columns) as f64 + 0.5) / rows as f64;
        let (y, x) = (TAU * (i % columns) as f64 / columns as f64).sin_cos();
        let (s, c) = polar.sin_cos();
        Vector3::new(s * x, s * y, c)
    })
}

#[cfg(test)]
mod tests;
