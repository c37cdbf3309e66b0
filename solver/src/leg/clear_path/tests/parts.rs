//! Geometry by its definitions.

use super::*;
use crate::leg::clear_path::retreat::retreat;
use crate::leg::clear_path::space::Cosine;
use crate::leg::clear_path::sphere::{Arc, angle};
use crate::math::random::SplitMix;

fn unit_vector(random: &mut SplitMix) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.normal()).normalize()
}

fn attitude(random: &mut SplitMix) -> Attitude {
    Attitude::from_xyzw(std::array::from_fn(|_| random.normal())).expect("a direction")
}

#[test]
fn the_deepest_point_of_an_arc_is_that_of_dense_samples() {
    let mut random = SplitMix::new(51);
    for trial in 0..300 {
        let cones = [cone(
            unit_vector(&mut random),
            unit_vector(&mut random),
            40.0,
        )];
        let (from, to) = (attitude(&mut random), attitude(&mut random));
        // Full turns as well as half ones.
        let signed = trial % 2 == 0;
        let problem = PathProblem {
            signed,
            ..problem(&cones, from, to)
        };
        let space = attitudes(&cones, !signed);
        let found = space.arc_clearance(&from.xyzw(), &to.xyzw());
        let to = if signed { to } else { to.nearest_sign(&from) };
        let least = sampled(&cones, &from, &to, 2000);
        assert!(
            found <= least + 1e-9 && found > least - 1e-5,
            "{found} {least}"
        );
        let (directions, ends) = directions(&cones, &cones[0].axis, &problem);
        let arc = Arc::between(&ends[0], &ends[1]);
        let points = arc.points(2000).map(|point| directions.clearance(&point));
        let least = points.fold(directions.clearance(&ends[0]), f64::min);
        let found = directions.arc_clearance(&ends[0], &ends[1]);
        assert!(
            found <= least + 1e-9 && found > least - 1e-5,
            "{found} {least}"
        );
    }
}

#[test]
fn the_form_of_a_cone_is_the_cosine_of_its_angle() {
    let mut random = SplitMix::new(52);
    for _ in 0..100 {
        let (boresight, axis) = (unit_vector(&mut random), unit_vector(&mut random));
        let q = attitude(&mut random);
        let form = Quadratic::new(&boresight, &axis);
        let cosine = q.to_reference(boresight).dot(&axis);
        assert!((form.value(&q.xyzw()) - cosine).abs() < 1e-12);
        assert!((form.value(&q.negated().xyzw()) - cosine).abs() < 1e-12);
    }
}

#[test]
fn a_retreat_gains_clearance_step_by_step_until_there_is_enough() {
    let mut random = SplitMix::new(53);
    for _ in 0..50 {
        let (boresight, axis) = (unit_vector(&mut random), unit_vector(&mut random));
        let from = attitude(&mut random);
        // A cone on whose surface the attitude is.
        let far = from.to_reference(boresight).angle(&axis);
        let cones = [cone(boresight, axis, far.to_degrees().min(150.0))];
        let space = attitudes(&cones, true);
        let way = retreat(&space, &from.xyzw(), 0.15);
        let clearances: Vec<f64> = way.iter().map(|x| space.clearance(x)).collect();
        assert!(clearances.windows(2).all(|pair| pair[1] > pair[0]));
        assert!(clearances[clearances.len() - 1] >= 0.15, "{clearances:?}");
        assert!(
            way.windows(2)
                .all(|ends| space.is_clear(&ends[0], &ends[1]))
        );
    }
}

#[test]
fn a_detour_is_pulled_tight_to_the_arc_where_nothing_is_in_the_way() {
    let cones = [cone(Vector3::x(), Vector3::z(), 20.0)];
    let (from, to) = (toward(0.0, -30.0), toward(50.0, -20.0));
    let space = attitudes(&cones, true);
    let detour = [from, toward(100.0, 40.0), toward(-50.0, 0.0), to].map(|q| q.xyzw());
    let mut path = Path::through(&space, &detour);
    let before = path.turn();
    path.pull_tight();
    let direct = space.turn(&detour[0], &detour[3]);
    assert!(before > 3.0 * direct);
    assert!(
        path.turn() < direct * (1.0 + 1e-3),
        "{} {direct}",
        path.turn()
    );
}

#[test]
fn a_path_along_a_cone_is_given_room() {
    let cones = [cone(Vector3::x(), Vector3::z(), 40.0)];
    let along: Vec<_> = (0..=60)
        .map(|i| toward(2.0 * f64::from(i), 49.95).xyzw())
        .collect();
    let space = attitudes(&cones, true);
    let mut path = Path::through(&space, &along);
    path.make_room();
    let inner = &path.points[5..path.points.len() - 5];
    let least = inner
        .windows(2)
        .map(|ends| space.arc_clearance(&ends[0], &ends[1]))
        .fold(PI, f64::min);
    assert!(least > 0.4_f64.to_radians(), "{}", least.to_degrees());
    assert!(angle(&path.points[0], &along[0]) == 0.0);
}

#[test]
fn opposite_boresights_are_one() {
    let axis = direction(30.0, 20.0);
    let cones = [
        cone(axis, Vector3::z(), 20.0),
        cone(-axis, Vector3::x(), 10.0),
        cone(Vector3::y(), Vector3::x(), 10.0),
    ];
    assert_eq!(boresights(&cones), [cones[0].axis, Vector3::y()]);
    let q = toward(77.0, -12.0);
    let problem = problem(&cones, q, q);
    let (space, ends) = directions(&cones, &cones[0].axis, &problem);
    let expected = clearance(&cones[..2], &q);
    assert_eq!(space.cones.len(), 2);
    assert!((space.clearance(&ends[0]) - expected).abs() < 1e-12);
}
