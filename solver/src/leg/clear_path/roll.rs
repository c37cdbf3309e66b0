//! Attitudes along a path of one boresight, whose roll about itself is free.

use super::space::Attitudes;
use super::sphere::{Arc, Point};
use crate::math::quaternion::{Quat, conjugate, dot4, imaginary, product, quat};
use nalgebra::Vector3;

/// Longest turn of the boresight between two attitudes, rad.
const STEP: f64 = 0.05;
/// Longest roll between two attitudes, rad.
const ROLL: f64 = std::f64::consts::FRAC_PI_2;

/// Attitudes from one to another whose boresight follows some directions of the reference frame.
///
/// The boresight is turned along each arc about the arc's pole (parallel transport), and what is
/// left of the roll is spread over the path. Where both at once would enter a cone, it turns first
/// and rolls then, which is as clear as the directions are.
pub(super) fn lifted(
    space: &Attitudes,
    boresight: &Vector3<f64>,
    [from, to]: [&Quat; 2],
    directions: &[Point<3>],
) -> Vec<Quat> {
    let mut transported = vec![(0.0, *from)];
    for ends in directions.windows(2) {
        transport(&mut transported, &ends[0], &ends[1]);
    }
    let (length, last) = transported[transported.len() - 1];
    let left = product(&conjugate(&last), &space.aligned(to, &last));
    let roll = 2.0 * imaginary(&left).dot(boresight).atan2(left[3]);
    let rolled = |q: &Quat, roll: f64| {
        let (sine, cosine) = (roll / 2.0).sin_cos();
        product(q, &quat(&(boresight * sine), cosine))
    };
    let (mut path, mut done) = (vec![*from], 0.0);
    for (along, q) in transported.iter().skip(1) {
        let share = if length > 0.0 { along / length } else { 1.0 };
        let wanted = roll * share;
        let next = rolled(q, wanted);
        let clear = (wanted - done).abs() <= ROLL
            && path.last().is_some_and(|here| space.is_clear(here, &next));
        if !clear {
            path.push(rolled(q, done));
            while (wanted - done).abs() > ROLL {
                done += ROLL.copysign(wanted - done);
                path.push(rolled(q, done));
            }
        }
        path.push(next);
        done = wanted;
    }
    path.push(space.aligned(to, &path[path.len() - 1]));
    path
}

/// Adds attitudes along the arc of the boresight's direction, with the length of the path so far.
fn transport(path: &mut Vec<(f64, Quat)>, from: &Point<3>, to: &Point<3>) {
    let arc = Arc::between(from, to);
    let mut count = 1;
    while arc.length > STEP * f64::from(count) {
        count += 1;
    }
    let pole = Vector3::from(arc.from).cross(&Vector3::from(arc.tangent));
    let (begun, first) = path[path.len() - 1];
    path.extend((1..=count).map(|i| {
        let along = arc.length * f64::from(i) / f64::from(count);
        let (sine, cosine) = (along / 2.0).sin_cos();
        let turned = product(&quat(&(pole * sine), cosine), &first);
        let length = dot4(&turned, &turned).sqrt();
        (begun + along, turned.map(|component| component / length))
    }));
}
