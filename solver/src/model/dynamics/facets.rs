//! Orthonormal frames in which a box fits what the wheels can reach.
//!
//! The rates that the wheels can reach are a zonotope, and so are the accelerations. A short turn
//! takes as long as the facet that it meets lets it, and a box is as narrow there only where one of its
//! axes is the normal of that facet. The facet that the wheels `i` and `j` span is across
//! `J_eff^-1 a_i x J_eff^-1 a_j`; limits of the rates about body axes have facets of their own.

use super::Dynamics;
use nalgebra::{Matrix3, Vector3};

/// Sine of the angle below which two directions are one.
const SAME_DIRECTION: f64 = 1e-2;
/// Facets by which a turn is expected to be limited, each the first axis of frames.
const FIRST: usize = 3;
/// Frames with the same first axis in which the box is narrow across it.
const NARROW: usize = 2;

/// The facets of what a spacecraft reaches, without momentum.
#[derive(Debug, Clone)]
pub(crate) struct Facets {
    facets: Vec<Facet>,
}

/// A direction across a facet, with what is reached along it.
#[derive(Debug, Clone)]
struct Facet {
    normal: Vector3<f64>,
    /// rad/s.
    rate: f64,
    /// rad/s².
    acceleration: f64,
    /// The other facets, that with the narrowest box across this normal first.
    seconds: Vec<usize>,
}

/// A frame: the facet of its first axis, and the one whose normal, projected across that, is the
/// second.
pub(crate) type FrameKey = [usize; 2];

impl Facets {
    /// Those of a spacecraft.
    pub(crate) fn of(dynamics: &Dynamics) -> Self {
        let levers: Vec<_> = dynamics
            .actuators
            .iter()
            .map(|wheel| dynamics.inertia_inverse * wheel.axis)
            .collect();
        let pairs = (0..levers.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
        let spanned = pairs.map(|[i, j]| levers[j].normalize().cross(&levers[i].normalize()));
        let limited = (0..3).filter(|axis| dynamics.max_rate[*axis].is_finite());
        let limited = limited.map(|axis| Vector3::ith(axis, 1.0));
        let mut normals: Vec<Vector3<f64>> = Vec::new();
        for direction in limited.chain(spanned) {
            // Parallel wheels span none.
            let Some(normal) = direction.try_normalize(SAME_DIRECTION) else {
                continue;
            };
            let same = |known: &Vector3<f64>| known.cross(&normal).norm() < SAME_DIRECTION;
            if !normals.iter().any(same) {
                normals.push(normal);
            }
        }
        let facets = (0..normals.len()).map(|first| Facet {
            normal: normals[first],
            rate: dynamics.greatest_rate(&normals[first]),
            acceleration: dynamics.reachable_acceleration(&normals[first]),
            seconds: narrowest_first(dynamics, &normals, first),
        });
        Self {
            facets: facets.collect(),
        }
    }

    /// Unit vectors across the facets, body axes, one of each pair.
    pub(crate) fn normals(&self) -> Vec<Vector3<f64>> {
        self.facets.iter().map(|facet| facet.normal).collect()
    }

    /// Frames that are expected to fit a turn by a rotation vector, rad, the most promising first.
    pub(crate) fn frames(&self, turn: &Vector3<f64>) -> Vec<FrameKey> {
        let time = |index: &usize| self.facets[*index].time(turn);
        let mut slowest: Vec<usize> = (0..self.facets.len()).collect();
        slowest.sort_by(|one, other| time(other).total_cmp(&time(one)));
        let mut frames = Vec::new();
        for first in slowest.iter().take(FIRST) {
            let narrow = self.facets[*first].seconds.iter().take(NARROW);
            let narrow: Vec<usize> = narrow.copied().collect();
            let mut others = slowest.iter().filter(|other| *other != first);
            let other = others.find(|other| !narrow.contains(other)).copied();
            frames.extend(
                narrow
                    .into_iter()
                    .chain(other)
                    .map(|second| [*first, second]),
            );
        }
        frames
    }

    /// The axes of a frame as columns, in body axes.
    pub(crate) fn axes(&self, [first, second]: FrameKey) -> Matrix3<f64> {
        frame(&self.facets[first].normal, &self.facets[second].normal)
    }
}

impl Facet {
    /// The time in which a turn by a rotation vector, rad, gets that far along the normal, s, from rest
    /// to rest.
    fn time(&self, turn: &Vector3<f64>) -> f64 {
        let angle = self.normal.dot(turn).abs();
        let ramp = self.rate / self.acceleration;
        let coast = angle / self.rate;
        if coast >= ramp {
            coast + ramp
        } else {
            2.0 * (angle / self.acceleration).sqrt()
        }
    }
}

/// The other normals, sorted by the area that rates reach across the first in the frame of the two.
fn narrowest_first(dynamics: &Dynamics, normals: &[Vector3<f64>], first: usize) -> Vec<usize> {
    let mut seconds: Vec<_> = (0..normals.len())
        .filter(|second| *second != first)
        .map(|second| {
            let axes = frame(&normals[first], &normals[second]);
            let reached =
                [1, 2].map(|axis| dynamics.greatest_rate(&axes.column(axis).into_owned()));
            (reached[0] * reached[1], second)
        })
        .collect();
    seconds.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    seconds.into_iter().map(|(_, second)| second).collect()
}

/// The frame with an axis along one direction and another in the plane of both.
fn frame(first: &Vector3<f64>, second: &Vector3<f64>) -> Matrix3<f64> {
    let second = (second - first * first.dot(second)).normalize();
    // Once more, as the first difference may have cancelled digits.
    let second = (second - first * first.dot(&second)).normalize();
    Matrix3::from_columns(&[*first, second, first.cross(&second)])
}

#[cfg(test)]
mod tests;
