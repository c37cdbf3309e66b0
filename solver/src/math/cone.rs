//! Cones that a few directions span in space.

use nalgebra::{Matrix3, Vector3};

/// Squared sine of the angle between two directions, or the corresponding determinant of three,
/// below which they count as dependent.
const INDEPENDENT: f64 = 1e-18;

/// The point nearest to another one among the sums of directions with factors that are not
/// negative.
///
/// It is a sum of at most three of them (Carathéodory), so all choices are tried: there are only as
/// many directions as a spacecraft has wheels.
pub(crate) fn nearest(directions: &[Vector3<f64>], point: &Vector3<f64>) -> Vector3<f64> {
    let mut best = Vector3::zeros();
    let mut take = |candidate: Vector3<f64>| {
        if (candidate - point).norm_squared() < (best - point).norm_squared() {
            best = candidate;
        }
    };
    for (i, a) in directions.iter().enumerate() {
        let along = a.dot(point) / a.norm_squared();
        if along > 0.0 {
            take(a * along);
        }
        for (j, b) in directions.iter().enumerate().skip(i + 1) {
            if let Some(candidate) = between(a, b, point) {
                take(candidate);
            }
            for c in &directions[j + 1..] {
                if holds(&[*a, *b, *c], point) {
                    return *point;
                }
            }
        }
    }
    best
}

/// The nearest sum of two directions, where both have factors above zero.
fn between(a: &Vector3<f64>, b: &Vector3<f64>, point: &Vector3<f64>) -> Option<Vector3<f64>> {
    let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
    let determinant = aa * bb - ab * ab;
    if determinant <= INDEPENDENT * aa * bb {
        return None;
    }
    let (pa, pb) = (a.dot(point), b.dot(point));
    let (s, t) = (bb * pa - ab * pb, aa * pb - ab * pa);
    (s > 0.0 && t > 0.0).then(|| (a * s + b * t) / determinant)
}

/// Whether a point is a sum of three directions.
fn holds(directions: &[Vector3<f64>; 3], point: &Vector3<f64>) -> bool {
    let matrix = Matrix3::from_columns(directions);
    let size: f64 = directions.iter().map(Vector3::norm_squared).product();
    if matrix.determinant().powi(2) <= INDEPENDENT * size {
        return false;
    }
    let factors = matrix.lu().solve(point);
    factors.is_some_and(|factors| factors.min() >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::SplitMix;

    #[test]
    fn the_nearest_point_meets_the_conditions_of_moreau() {
        let mut random = SplitMix::new(7);
        let mut draw = || Vector3::from_fn(|_, _| random.normal());
        let mut kinds = [0; 3];
        for trial in 0..2000 {
            let mut directions: Vec<_> = (0..=trial % 5).map(|_| draw()).collect();
            if trial % 7 == 0 {
                directions.push(directions[0] * 2.0);
            }
            let point = draw();
            let found = nearest(&directions, &point);
            let left = point - found;
            // These two characterise the nearest point of a convex cone (Moreau).
            assert!(directions.iter().all(|d| d.dot(&left) <= 1e-12), "{trial}");
            assert!(found.dot(&left).abs() <= 1e-12, "{trial}");
            kinds[if found == point {
                2
            } else {
                usize::from(found.norm() > 0.0)
            }] += 1;
        }
        assert!(kinds.iter().all(|count| *count > 50), "{kinds:?}");
    }
}
