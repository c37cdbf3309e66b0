//! Boxes, random motions of other polytopes, and the properties of a least time.

use super::*;
use crate::bounds::kinematic::RateBox;
use slewplan_tests::extremals::{extremal, vertices};
use slewplan_tests::motions::half_spaces;
use slewplan_tests::random::Generator;
use std::f64::consts::PI;

/// What the moved facets and the moved turn may cost, relative.
const GENERAL_POSITION: f64 = 1e-6;

fn polytope(half_spaces: &[Vector3<f64>]) -> RatePolytope {
    RatePolytope::within(half_spaces).expect("limited in all directions")
}

fn axis_limits(rates: &Vector3<f64>) -> Vec<Vector3<f64>> {
    (0..3).map(|i| Vector3::ith(i, 1.0 / rates[i])).collect()
}

fn rates(random: &mut Generator) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.logarithmic(0.2, 1.0))
}

fn turn(random: &mut Generator) -> Attitude {
    let angle = random.logarithmic(3e-2, PI);
    Attitude::from_rotation_vector(Vector3::from(random.direction()) * angle)
}

#[test]
fn boxes_have_the_least_times_that_their_own_search_finds() {
    let mut random = Generator::new(1);
    for _ in 0..60 {
        let rates = rates(&mut random);
        let boxed = RateBox::new(rates).expect("ordinary rates");
        let limited = polytope(&axis_limits(&rates));
        for _ in 0..5 {
            let turn = turn(&mut random);
            let known = boxed.query(&turn, 1e-6);
            let found = limited.least_time(&turn, 1e-5);
            assert!(
                found.lower_s <= known.upper_s,
                "{turn:?} at {rates}: {found:?}, {known:?}"
            );
            // Small turns take so many cells that the search may end early.
            let angle = turn.angle_to(&Attitude::identity());
            let tolerance = if angle < 0.2 { 5e-3 } else { 1e-4 };
            assert!(
                found.lower_s >= known.lower_s * (1.0 - tolerance),
                "{turn:?} at {rates}: {found:?}, {known:?}"
            );
        }
    }
}

#[test]
fn quarter_and_half_turns_about_the_axes_of_a_box_have_bounds_too() {
    let rates = Vector3::new(0.018, 0.0135, 0.0125);
    let boxed = RateBox::new(rates).expect("ordinary rates");
    let limited = polytope(&axis_limits(&rates));
    for axis in 0..3 {
        for angle in [0.5 * PI, PI, 1e-3] {
            let turn = Attitude::from_rotation_vector(Vector3::ith(axis, angle));
            let (known, found) = (boxed.query(&turn, 1e-6), limited.least_time(&turn, 1e-4));
            assert!(found.lower_s <= known.upper_s);
            assert!(
                found.lower_s >= known.lower_s * 0.997,
                "{found:?}, {known:?}"
            );
        }
    }
    let none = limited.least_time(&Attitude::identity(), 1e-4);
    assert_eq!((none.lower_s, none.upper_s), (0.0, 0.0));
}

#[test]
fn no_extremal_is_faster_than_the_bound_on_its_turn() {
    let mut random = Generator::new(2);
    let mut loose = 0;
    let mut all = 0;
    for number in 0..150 {
        let half_spaces = half_spaces(number, &mut random);
        let Some(limited) = RatePolytope::within(&half_spaces) else {
            continue;
        };
        let vertices = vertices(&half_spaces);
        let slowest = half_spaces.iter().map(Vector3::norm).fold(0.0, f64::max);
        for _ in 0..4 {
            let duration = random.between(0.05, 3.0) * slowest;
            let costate = Vector3::from(random.direction());
            let turn = extremal(&vertices, costate, duration);
            let turn = Attitude::from_xyzw(turn.coords.into()).expect("a unit quaternion");
            let found = limited.least_time(&turn, 1e-4);
            assert!(
                found.lower_s <= duration * (1.0 + 1e-9),
                "polytope {number}: {found:?} of a motion of {duration} s"
            );
            all += 1;
            loose += usize::from(found.lower_s < found.upper_s * (1.0 - 2e-4));
        }
    }
    assert!(all > 500, "{all} motions");
    assert!(
        loose * 20 < all,
        "{loose} of {all} least times are not enclosed"
    );
}

#[test]
fn a_least_time_is_that_of_the_inverse_and_obeys_the_triangle_inequality() {
    let mut random = Generator::new(3);
    for number in 0..60 {
        let half_spaces = half_spaces(number, &mut random);
        let Some(limited) = RatePolytope::within(&half_spaces) else {
            continue;
        };
        let [one, other] = [turn(&mut random), turn(&mut random)];
        let identity = Attitude::identity();
        let time = |turn: &Attitude| limited.least_time(turn, 1e-5);
        let (there, back) = (time(&one), time(&one.turn_to(&identity)));
        assert!(
            there.lower_s <= back.upper_s && back.lower_s <= there.upper_s,
            "polytope {number}, {one:?}: {there:?}, {back:?} {half_spaces:?}"
        );
        let both = time(&one.then_in_body(&other));
        assert!(both.lower_s <= there.upper_s + time(&other).upper_s);
    }
}

#[test]
fn a_larger_set_of_rates_is_no_slower() {
    let mut random = Generator::new(4);
    for number in 0..60 {
        let half_spaces = half_spaces(number, &mut random);
        let wider: Vec<_> = half_spaces
            .iter()
            .map(|f| f / random.between(1.0, 1.5))
            .collect();
        let sets = [&half_spaces, &wider].map(|set| RatePolytope::within(set));
        let [Some(narrow), Some(wide)] = sets else {
            continue;
        };
        let turn = turn(&mut random);
        let [narrow, wide] = [narrow, wide].map(|set| set.least_time(&turn, 1e-5));
        assert!(wide.lower_s <= narrow.upper_s * (1.0 + GENERAL_POSITION));
    }
}

#[test]
fn rates_without_a_limit_in_some_direction_are_no_polytope() {
    let flat = [Vector3::x(), Vector3::y(), Vector3::x() + Vector3::y()];
    assert!(RatePolytope::within(&flat).is_none());
    assert!(RatePolytope::within(&[]).is_none());
    let endless = [Vector3::x(), Vector3::y(), Vector3::new(0.0, 0.0, f64::NAN)];
    assert!(RatePolytope::within(&endless).is_none());
}
