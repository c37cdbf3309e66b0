//! Legs at whose ends only an axis is pointed.

use super::*;
use crate::bounds::certified::CertifiedBounds;
use crate::math::random::SplitMix;
use crate::model::random::{direction, spacecraft};
use crate::model::roll::FreeRoll;
use std::f64::consts::TAU;

/// A body axis that is pointed where it points at an attitude.
fn pointed(attitude: Attitude, axis: Vector3<f64>, range: Option<[f64; 2]>) -> Waypoint {
    let axis = axis.normalize();
    Waypoint {
        roll: Some(FreeRoll { axis, range }.into()),
        ..at_rest(attitude)
    }
}

/// Turn, rad, from a waypoint with a free roll to the nearest attitude that it admits.
fn missed(end: &Waypoint, reached: &Attitude) -> f64 {
    end.rolled_towards(reached).attitude.angle_to(reached)
}

#[test]
fn a_free_roll_is_no_slower_than_any_given_one() {
    let dynamics = dynamics(|_| {});
    let from = at_rest(Attitude::identity());
    let turned = Attitude::from_rotation_vector(Vector3::new(0.4, -0.9, 0.7));
    let axis = Vector3::new(0.3, 0.2, 1.0);
    let free = pointed(turned, axis, None);
    let (found, reached) = solve_between(&dynamics, &from, &free, Arrival::Rotation);
    assert!(missed(&free, &reached) < 1e-7);
    let given = (0..24).map(|i| free.rolled(TAU * f64::from(i) / 24.0).pinned());
    let given = given.map(|to| solve_between(&dynamics, &from, &to, Arrival::Rotation).0);
    let least = given.fold(f64::INFINITY, f64::min);
    assert!(found < least * (1.0 + 1e-5), "{found} {least}");
    assert!(found > 0.99 * least, "{found} {least}");

    // Where the best roll is not admissible, the nearest limit is.
    let about = FreeRoll {
        axis: axis.normalize(),
        range: None,
    };
    let best = about.between(&turned, &reached);
    let limited = pointed(turned, axis, Some([best + 0.2, best + 1.0]));
    let (slower, reached) = solve_between(&dynamics, &from, &limited, Arrival::Rotation);
    let roll = about.between(&turned, &reached);
    assert!(slower > found);
    assert!((roll - best - 0.2).abs() < 1e-4, "{roll} {best}");
}

#[test]
fn between_two_directions_the_leg_is_the_same_forth_and_back() {
    let dynamics = dynamics(|_| {});
    let from = pointed(Attitude::identity(), Vector3::z(), None);
    let turned = Attitude::from_rotation_vector(Vector3::new(1.1, 0.3, -0.8));
    let to = pointed(turned, Vector3::z(), Some([-0.5, 0.5]));
    let (forth, reached) = solve_between(&dynamics, &from, &to, Arrival::Rotation);
    let (back, there) = solve_between(&dynamics, &to, &from, Arrival::Rotation);
    assert!((forth - back).abs() < 1e-4 * forth, "{forth} {back}");
    assert!(missed(&to, &reached) < 1e-7 && missed(&from, &there) < 1e-7);
}

#[test]
fn the_same_direction_takes_no_time() {
    let dynamics = dynamics(|_| {});
    let from = at_rest(Attitude::from_rotation_vector(Vector3::new(0.2, 0.1, -0.4)));
    let to = pointed(
        from.attitude.retract(Vector3::x() * 2.0),
        Vector3::x(),
        None,
    );
    assert!(solve_between(&dynamics, &from, &to, Arrival::Rotation).0 < 1e-9);
}

#[test]
fn bounds_over_rolls_are_below_those_of_every_roll_and_below_the_leg() {
    let mut random = SplitMix::new(26);
    for case in 0..8 {
        let scenario = spacecraft(&mut random, case % 4 == 3);
        let dynamics = scenario.dynamics();
        let bounds = CertifiedBounds::of(&dynamics);
        let mut end = |range| {
            let attitude = Attitude::from_rotation_vector(direction(&mut random) * 1.7);
            pointed(attitude, direction(&mut random), range)
        };
        let (from, to) = (end(None), end((case % 2 == 0).then_some([-0.4, 1.3])));
        let from = if case < 4 { from.pinned() } else { from };
        let bound = bounds
            .leg(&from, &to, &dynamics.momentum)
            .expect("rates are limited");
        for i in 0..60 {
            let roll = TAU * f64::from(i) / 60.0;
            let nearest =
                |end: &Waypoint, roll| end.roll.as_ref().map_or(0.0, |free| free.nearest(roll));
            let begin = from.rolled(nearest(&from, 2.0 * roll)).pinned();
            let arrival = to.rolled(nearest(&to, roll)).pinned();
            let given = bounds
                .leg(&begin, &arrival, &dynamics.momentum)
                .expect("as above");
            // With momentum the direction of the momentum makes the bound of a given roll larger or, as
            // the frames differ, a little smaller.
            if !dynamics.has_momentum() {
                assert!(bound <= given * (1.0 + 3e-4), "{bound} {given}");
            }
        }
        if !dynamics.has_momentum() {
            let (found, _) = solve_between(&dynamics, &from, &to, Arrival::Rotation);
            assert!(bound <= found, "{bound} {found}");
        }
    }
}
