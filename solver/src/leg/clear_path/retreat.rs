//! From a point with little clearance into the open.

use super::space::{Cosine, Space};
use super::sphere::{Point, combined, dot, opposite, unit};

/// Longest step, rad of rotation.
const LONGEST: f64 = 0.1;
/// Shortest step, rad of rotation.
const SHORTEST: f64 = 1e-5;
/// Steps at most.
const STEPS: usize = 60;

/// A way from a point, along which the clearance grows, to one that has as much as is wanted, or to
/// one from which no step gives more. Both ends are included.
///
/// It is a search along patterns (Hooke and Jeeves 1961): of the directions that leave the near
/// cones, their sum, and both senses of all axes, the one that gives most.
pub(super) fn retreat<const D: usize, F: Cosine<D>>(
    space: &Space<D, F>,
    from: &Point<D>,
    wanted: f64,
) -> Vec<Point<D>> {
    let mut way = vec![*from];
    let (mut x, mut clearance) = (*from, space.clearance(from));
    let mut step = LONGEST.min(wanted);
    for _ in 0..STEPS {
        if clearance >= wanted || step < SHORTEST {
            break;
        }
        let tried = directions(space, &x, clearance + 2.0 * step);
        let found = tried.iter().map(|tangent| {
            let (sine, cosine) = (step / F::SCALE).sin_cos();
            let next = combined(cosine, &x, sine, tangent);
            (space.clearance(&next), next)
        });
        let best = found.max_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            // A tenth of what a step away from a single cone gives.
            Some((more, next)) if more > clearance + 0.1 * step && space.is_clear(&x, &next) => {
                (x, clearance) = (next, more);
                way.push(x);
            }
            _ => step /= 2.0,
        }
    }
    way
}

/// Tangents to try from a point.
fn directions<const D: usize, F: Cosine<D>>(
    space: &Space<D, F>,
    x: &Point<D>,
    within: f64,
) -> Vec<Point<D>> {
    let mut found = space.ways_out(x, within);
    let sum = found
        .iter()
        .fold([0.0; D], |sum, way| combined(1.0, &sum, 1.0, way));
    found.extend(unit(&sum));
    for axis in 0..D {
        let mut along = [0.0; D];
        along[axis] = 1.0;
        if let Some(tangent) = unit(&combined(1.0, &along, -dot(&along, x), x)) {
            found.extend([tangent, opposite(&tangent)]);
        }
    }
    found
}
