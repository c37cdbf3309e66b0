//! The sphere of directions and that of quaternions, with the cones that are forbidden there.

use super::sphere::{Arc, Point, angle, combined, dot, opposite, unit};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Rounding that an arc may lie inside a cone, rad.
const ROUNDING: f64 = 1e-10;

/// The cosine of the angle between a boresight and the axis of a cone, as a function on the sphere.
pub(super) trait Cosine<const D: usize> {
    /// Angle of rotation per angle on the sphere.
    const SCALE: f64;

    /// Its value.
    fn value(&self, x: &Point<D>) -> f64;

    /// Its gradient in the space around the sphere.
    fn gradient(&self, x: &Point<D>) -> Point<D>;

    /// `c`, `a`, `b` of the value `c + a cos t + b sin t` along an arc, with the angle of rotation
    /// `t`.
    fn along(&self, arc: &Arc<D>) -> [f64; 3];
}

/// On the sphere of a boresight's directions: `d . s`.
#[derive(Debug, Clone)]
pub(super) struct Linear(pub(super) Point<3>);

impl Cosine<3> for Linear {
    const SCALE: f64 = 1.0;

    fn value(&self, x: &Point<3>) -> f64 {
        dot(&self.0, x)
    }

    fn gradient(&self, _: &Point<3>) -> Point<3> {
        self.0
    }

    fn along(&self, arc: &Arc<3>) -> [f64; 3] {
        [0.0, dot(&self.0, &arc.from), dot(&self.0, &arc.tangent)]
    }
}

/// On the sphere of quaternions `(v, w)`: `s . R b`, the quadratic form
/// `w^2 s.b + v'(s b' + b s' - (s.b) I) v + 2 w v.(b x s)`.
#[derive(Debug, Clone)]
pub(super) struct Quadratic([Point<4>; 4]);

impl Quadratic {
    /// Of a boresight in body axes and a direction.
    pub(super) fn new(boresight: &Vector3<f64>, direction: &Vector3<f64>) -> Self {
        let aligned = boresight.dot(direction);
        let across = boresight.cross(direction);
        let mut form = [[0.0; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                form[i][j] = direction[i] * boresight[j] + boresight[i] * direction[j];
            }
            form[i][i] -= aligned;
            form[i][3] = across[i];
            form[3][i] = across[i];
        }
        form[3][3] = aligned;
        Self(form)
    }

    fn times(&self, x: &Point<4>) -> Point<4> {
        std::array::from_fn(|i| dot(&self.0[i], x))
    }
}

impl Cosine<4> for Quadratic {
    const SCALE: f64 = 2.0;

    fn value(&self, x: &Point<4>) -> f64 {
        dot(x, &self.times(x))
    }

    fn gradient(&self, x: &Point<4>) -> Point<4> {
        self.times(x)
    }

    fn along(&self, arc: &Arc<4>) -> [f64; 3] {
        let toward = self.times(&arc.tangent);
        let (first, last) = (self.value(&arc.from), dot(&arc.tangent, &toward));
        [
            f64::midpoint(first, last),
            (first - last) / 2.0,
            dot(&arc.from, &toward),
        ]
    }
}

/// A cone that is forbidden on a sphere.
#[derive(Debug, Clone)]
pub(super) struct Forbidden<F> {
    cosine: F,
    /// Half angle, rad.
    half_angle: f64,
    /// Cosine at its surface, up to rounding.
    surface: f64,
}

impl<F> Forbidden<F> {
    /// By its cosine and its half angle, rad.
    pub(super) fn new(cosine: F, half_angle: f64) -> Self {
        Self {
            cosine,
            half_angle,
            surface: (half_angle - ROUNDING).max(0.0).cos(),
        }
    }
}

/// A sphere with forbidden cones.
#[derive(Debug, Clone)]
pub(super) struct Space<const D: usize, F> {
    /// The cones.
    pub(super) cones: Vec<Forbidden<F>>,
    /// Whether opposite points are the same.
    pub(super) projective: bool,
}

/// The directions of a boresight.
pub(super) type Directions = Space<3, Linear>;
/// Attitudes as quaternions.
pub(super) type Attitudes = Space<4, Quadratic>;

impl<const D: usize, F: Cosine<D>> Space<D, F> {
    /// Angle to the surface of a cone, rad, negative inside.
    fn clearance_of(&self, cone: usize, x: &Point<D>) -> f64 {
        let Forbidden {
            cosine, half_angle, ..
        } = &self.cones[cone];
        cosine.value(x).clamp(-1.0, 1.0).acos() - half_angle
    }

    /// Angle to the nearest surface of a cone, rad, negative inside. It changes by no more than the
    /// angle of rotation.
    pub(super) fn clearance(&self, x: &Point<D>) -> f64 {
        let all = (0..self.cones.len()).map(|cone| self.clearance_of(cone, x));
        all.fold(PI, f64::min)
    }

    /// Least clearance along an arc, rad.
    pub(super) fn arc_clearance(&self, from: &Point<D>, to: &Point<D>) -> f64 {
        let arc = Arc::between(from, &self.aligned(to, from));
        let clearances = self.cones.iter().map(|cone| {
            let most = largest(cone.cosine.along(&arc), arc.length * F::SCALE);
            most.clamp(-1.0, 1.0).acos() - cone.half_angle
        });
        clearances.fold(PI, f64::min)
    }

    /// Whether no point of an arc is inside a cone, up to rounding.
    pub(super) fn is_clear(&self, from: &Point<D>, to: &Point<D>) -> bool {
        let arc = Arc::between(from, &self.aligned(to, from));
        self.cones.iter().all(|cone| {
            let [mean, a, b] = cone.cosine.along(&arc);
            // The whole circle is clear of most cones.
            let excess = cone.surface - mean;
            (excess >= 0.0 && a * a + b * b <= excess * excess)
                || largest([mean, a, b], arc.length * F::SCALE) <= cone.surface
        })
    }

    /// Angle of rotation between two points, rad.
    pub(super) fn turn(&self, from: &Point<D>, to: &Point<D>) -> f64 {
        F::SCALE * angle(from, &self.aligned(to, from))
    }

    /// The point with the sign of another one, where opposite points are the same.
    pub(super) fn aligned(&self, x: &Point<D>, to: &Point<D>) -> Point<D> {
        if self.projective && dot(x, to) < 0.0 {
            opposite(x)
        } else {
            *x
        }
    }

    /// Unit tangents along which the boresights leave the cones that are nearer than some angle.
    pub(super) fn ways_out(&self, x: &Point<D>, within: f64) -> Vec<Point<D>> {
        let near = (0..self.cones.len()).filter(|cone| self.clearance_of(*cone, x) < within);
        let ways = near.filter_map(|cone| {
            let gradient = self.cones[cone].cosine.gradient(x);
            unit(&combined(-1.0, &gradient, dot(&gradient, x), x))
        });
        ways.collect()
    }

    /// A point turned until every boresight is so far from its cones, rad, where that is possible by
    /// leaving one cone after the other.
    pub(super) fn pushed_out(&self, x: &Point<D>, wanted: f64) -> Option<Point<D>> {
        const PUSHES: usize = 12;
        let mut x = *x;
        for _ in 0..PUSHES {
            let all = (0..self.cones.len()).map(|cone| (self.clearance_of(cone, &x), cone));
            let Some((clearance, nearest)) = all.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                return Some(x);
            };
            if clearance >= wanted - ROUNDING {
                return Some(x);
            }
            let gradient = self.cones[nearest].cosine.gradient(&x);
            let tangent = unit(&combined(-1.0, &gradient, dot(&gradient, &x), &x))?;
            let (sine, cosine) = ((wanted - clearance) / F::SCALE).sin_cos();
            x = combined(cosine, &x, sine, &tangent);
        }
        None
    }
}

/// Largest value of `mean + a cos t + b sin t` with `t` from 0 to an end, at most 2 pi.
fn largest([mean, a, b]: [f64; 3], end: f64) -> f64 {
    // Where the sinusoid peaks, in [0, 2 pi).
    let peak = b.atan2(a).rem_euclid(TAU);
    if peak <= end {
        mean + a.hypot(b)
    } else {
        let (sine, cosine) = end.sin_cos();
        (mean + a).max(mean + a * cosine + b * sine)
    }
}
