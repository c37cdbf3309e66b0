//! The greatest and the least singular momenta.
//!
//! A grid gives the starting points, a search with shrinking steps the extremes. Where the direction
//! tends to a gimbal axis, a surface ends in a rim: a circle of momenta, whose nearest point has a
//! closed form.

use super::{CmgCluster, Passability, SingularState, grid};
use nalgebra::{Rotation3, Vector3};

/// Rows of the grid on which a search begins.
const ROWS: usize = 40;
/// Step at which a search ends, rad.
const MIN_STEP: f64 = 1e-11;

/// The boundary of a singular surface: the direction is along a gimbal axis, and that gimbal's angle is
/// arbitrary. The momenta are a circle of radius one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// Index of the gyroscope with an arbitrary gimbal angle.
    pub gyroscope: usize,
    /// The direction without torque, unit: its gimbal axis or the opposite.
    pub direction: Vector3<f64>,
    /// Centre of the circle in units of a rotor's momentum, body axes: the sum of the other rotors.
    pub centre: Vector3<f64>,
}

impl Rim {
    /// Distance of the circle's nearest point from the origin.
    #[must_use]
    pub fn least_momentum(&self) -> f64 {
        let height = self.centre.dot(&self.direction);
        let across = (self.centre - self.direction * height).norm();
        (across - 1.0).hypot(height)
    }
}

impl CmgCluster {
    /// The rims of the singular surface of a pattern of signs.
    #[must_use]
    pub fn rims(&self, signs: &[bool]) -> Vec<Rim> {
        let axes = self.gimbals.iter().enumerate();
        axes.flat_map(|(i, gimbal)| [(i, gimbal.axis), (i, -gimbal.axis)])
            .map(|(gyroscope, direction)| {
                let others = self.gimbals.iter().zip(signs).enumerate();
                let centre = others
                    .filter(|(i, _)| *i != gyroscope)
                    .map(|(_, (other, &sign))| {
                        let along = direction - other.axis * other.axis.dot(&direction);
                        along.normalize() * if sign { 1.0 } else { -1.0 }
                    })
                    .sum();
                Rim {
                    gyroscope,
                    direction,
                    centre,
                }
            })
            .collect()
    }

    /// The greatest momentum that the cluster has in any direction.
    #[must_use]
    pub fn greatest_momentum(&self) -> f64 {
        let outer = vec![true; self.count()];
        -self.least(&outer, |state| Some(-state.momentum.norm()))
    }

    /// The least momentum among elliptic singular states: within the sphere of this radius null motion
    /// leaves every singular state. Infinite when there are none.
    #[must_use]
    pub fn least_elliptic(&self) -> f64 {
        let elliptic = |state: &SingularState| {
            (state.passability == Passability::Elliptic).then(|| state.momentum.norm())
        };
        let patterns = self.sign_patterns();
        let least = patterns[1..]
            .iter()
            .map(|signs| self.least(signs, elliptic));
        least.fold(f64::INFINITY, f64::min)
    }

    /// The infimum of the momentum among singular states with one sign reversed, rims included: the
    /// radius of the thesis's guaranteed sphere.
    #[must_use]
    pub fn least_with_one_reversed(&self) -> f64 {
        let surfaces = (0..self.count()).map(|reversed| {
            let signs: Vec<bool> = (0..self.count()).map(|i| i != reversed).collect();
            let inside = self.least(&signs, |state| Some(state.momentum.norm()));
            let rims = self.rims(&signs);
            rims.iter().map(Rim::least_momentum).fold(inside, f64::min)
        });
        surfaces.fold(f64::INFINITY, f64::min)
    }

    /// Least value over a singular surface, from the best direction of a grid.
    fn least(&self, signs: &[bool], value: impl Fn(&SingularState) -> Option<f64>) -> f64 {
        let at = |u: &Vector3<f64>| {
            let state = self.singular_state(u, signs);
            state.as_ref().and_then(&value).unwrap_or(f64::INFINITY)
        };
        let start = grid(ROWS)
            .map(|u| (at(&u), u))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((mut least, mut best)) = start.filter(|(least, _)| least.is_finite()) else {
            return f64::INFINITY;
        };
        let mut step = std::f64::consts::PI / ROWS as f64;
        while step > MIN_STEP {
            let turned = [Vector3::x(), Vector3::y(), Vector3::z()]
                .into_iter()
                .flat_map(|axis| [axis * step, axis * -step])
                .map(|turn| Rotation3::new(turn) * best)
                .map(|u| (at(&u), u))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match turned {
                Some((value, u)) if value < least => (least, best) = (value, u),
                _ => step *= 0.5,
            }
        }
        least
    }
}
