mod ramped;
mod table;

use super::*;
use proptest::prelude::*;
use slewplan_tests::motions::{MotionKind, end_of, motion};
use slewplan_tests::random::Generator;
use table::TABLE;

/// The rates of the published experiments' spacecraft, rad/s.
const PAPER: [f64; 3] = [0.018_098_04, 0.013_482_02, 0.012_460_02];

fn rate_box(rates: [f64; 3]) -> RateBox {
    RateBox::new(rates.into()).expect("ordinary rates")
}

fn turn(vector: [f64; 3]) -> Attitude {
    Attitude::from_rotation_vector(vector.into())
}

/// The attitude after some arcs.
fn attitude_after(arcs: &[(Vector3<f64>, f64)]) -> Attitude {
    let end = end_of(arcs);
    Attitude::from_xyzw(end.coords.into()).expect("a unit quaternion")
}

/// Queries a turn, checks the properties that every answer has, and returns the answer.
fn checked(rates: [f64; 3], table: &RateBox, target: &Attitude, tolerance: f64) -> ShortestTurn {
    let answer = table.query(target, tolerance);
    let arcs: Vec<_> = answer
        .arcs
        .iter()
        .map(|arc| (arc.rate_rad_s, arc.duration_s))
        .collect();
    let miss = attitude_after(&arcs).angle_to(target);
    assert!(miss < 1e-11, "misses by {miss} rad");
    for (rate, duration) in &arcs {
        assert!(*duration > 0.0);
        assert!(
            (0..3).all(|i| rate[i].abs() <= rates[i] * (1.0 + 1e-14)),
            "{rate} exceeds {rates:?}"
        );
    }
    let total: f64 = arcs.iter().map(|arc| arc.1).sum();
    assert!((total - answer.upper_s).abs() <= 1e-12 * total);
    assert!(answer.lower_s <= answer.upper_s);
    // Rounding increases the number of cells for turns below half a degree.
    let small = target.angle_to(&Attitude::identity()) < 0.01;
    assert!(small || answer.cells < 20_000, "{} cells", answer.cells);
    let gap = 1.0 - answer.lower_s / answer.upper_s;
    // Rounding hides misses of 1e-7 rad, which may have to be corrected at the slowest rate.
    let slowest = Vector3::from(rates).normalize().min();
    let allowed = tolerance + 3e-7 / (slowest * target.angle_to(&Attitude::identity()));
    assert!(gap <= allowed, "gap {gap} of {target:?} at {rates:?}");
    answer
}

#[test]
fn an_independent_implementation_agrees() {
    for (rates, rows) in TABLE {
        let table = rate_box(rates);
        for (vector, lower, upper) in rows {
            let answer = checked(rates, &table, &turn(vector), 1e-6);
            // The table has seven digits.
            assert!(
                answer.lower_s <= upper * (1.0 + 6e-7),
                "{vector:?} at {rates:?}: {answer:?}"
            );
            assert!(
                answer.upper_s >= lower * (1.0 - 6e-7),
                "{vector:?} at {rates:?}: {answer:?}"
            );
        }
    }
}

#[test]
fn half_turns_about_the_axes_beat_the_axes() {
    let table = rate_box(PAPER);
    for (axis, known) in [149.3, 179.2, 182.1].into_iter().enumerate() {
        let mut vector = [0.0; 3];
        vector[axis] = PI;
        let answer = checked(PAPER, &table, &turn(vector), 1e-5);
        assert!((answer.upper_s - known).abs() < 0.05, "{answer:?}");
        assert!(answer.upper_s < 0.9 * PI / PAPER[axis]);
    }
}

#[test]
fn corners_and_face_diagonals_are_fastest_about_their_own_axis() {
    for rates in [PAPER, [1.0, 1.0, 1.0], [1.0, 0.5, 0.25]] {
        let table = rate_box(rates);
        for direction in [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
            [1.0, 1.0, 0.0],
            [0.0, -1.0, 1.0],
        ] {
            let rate = Vector3::from_fn(|i, _| direction[i] * rates[i]);
            for angle in [0.01, 0.3, 1.0] {
                let time = angle / rate.norm();
                let target = Attitude::from_rotation_vector(rate * time);
                let answer = checked(rates, &table, &target, 1e-6);
                assert!(
                    (answer.upper_s / time - 1.0).abs() < 1e-9,
                    "{answer:?} against {time}"
                );
            }
        }
    }
}

#[test]
fn no_motion_beats_the_bound() {
    let mut generator = Generator::new(5);
    for rates in [
        PAPER,
        [1.0, 1.0, 1.0],
        [1.0, 0.5, 0.25],
        [0.3, 1.0, 1.0],
        [10.0, 2.0, 1.0],
        [1.0, 0.999, 0.9],
    ] {
        let table = rate_box(rates);
        for kind in (0..60).flat_map(|_| MotionKind::ALL) {
            let arcs = motion(&mut generator, kind, rates.into(), 4.5);
            let time: f64 = arcs.iter().map(|arc| arc.1).sum();
            let target = attitude_after(&arcs);
            let answer = table.query(&target, 1e-4);
            assert!(
                answer.lower_s <= time * (1.0 + 1e-12),
                "{answer:?} against {time}: {arcs:?}"
            );
            // Extremals are arc sequences: the search must find a motion that is as fast.
            if kind.is_extremal() {
                assert!(
                    answer.upper_s <= time * (1.0 + 1e-4) + 1e-6 / rates[0],
                    "{answer:?} against {time}"
                );
            }
        }
    }
}

#[test]
fn the_identity_takes_no_time_and_signs_do_not_matter() {
    let table = rate_box(PAPER);
    for q in [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, -1.0]] {
        let answer = table.query(&Attitude::from_xyzw(q).expect("a unit quaternion"), 1e-4);
        assert_eq!((answer.lower_s, answer.upper_s), (0.0, 0.0));
        assert_eq!(answer.arcs, []);
    }
    let target = turn([0.5, -1.0, 1.3]);
    let (one, other) = (
        table.query(&target, 1e-6),
        table.query(&target.negated(), 1e-6),
    );
    assert!((one.upper_s - other.upper_s).abs() < 1e-9 * one.upper_s);
}

#[test]
fn rates_whose_levels_coincide_are_solved() {
    // A saddle on the level of a vertex: the gap between two walls vanishes.
    for rates in [[1.0, 0.8, 0.6], [0.6, 0.8, 1.0], [0.8, 1.0, 0.600_000_001]] {
        checked(rates, &rate_box(rates), &turn([0.4, 1.1, -0.9]), 1e-6);
    }
}

#[test]
fn bad_rates_are_refused() {
    for rates in [
        [0.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, f64::NAN, 1.0],
        [f64::INFINITY, 1.0, 1.0],
    ] {
        assert!(RateBox::new(rates.into()).is_none(), "{rates:?}");
    }
}

#[test]
fn nearly_equal_rates_give_the_times_of_equal_ones() {
    let target = turn([0.4, 1.1, -0.9]);
    let equal = rate_box([1.0; 3]).query(&target, 1e-6);
    for near in [1e-12, 1e-9, 9e-8, 2e-7, 1e-5] {
        let rates = [1.0, 1.0 - near, 1.0 - 1.5 * near];
        let answer = checked(rates, &rate_box(rates), &target, 1e-6);
        assert!(answer.upper_s >= equal.lower_s);
        assert!(answer.lower_s <= equal.upper_s * (1.0 + 2.0 * near));
    }
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [-2.0..2.0, -2.0..2.0, -2.0..2.0_f64]
}

fn rates() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        3 => [0.15..1.0, 0.15..1.0, 0.15..1.0_f64],
        1 => Just([1.0, 1.0, 1.0]),
        1 => Just([1.0, 0.4, 0.4]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn inversion_and_half_turns_change_nothing(rates in rates(), vector in vector()) {
        let table = rate_box(rates);
        let answer = checked(rates, &table, &turn(vector), 1e-6);
        let [x, y, z] = vector;
        for other in [[-x, -y, -z], [x, -y, -z], [-x, y, -z], [-x, -y, z]] {
            let same = checked(rates, &table, &turn(other), 1e-6);
            prop_assert!(same.lower_s <= answer.upper_s && answer.lower_s <= same.upper_s);
        }
    }

    #[test]
    fn the_triangle_inequality_holds(rates in rates(), first in vector(), second in vector()) {
        let table = rate_box(rates);
        let (a, b) = (turn(first), turn(second));
        let detour = table.query(&a, 1e-6).upper_s + table.query(&b, 1e-6).upper_s;
        prop_assert!(table.query(&a.then_in_body(&b), 1e-6).lower_s <= detour);
    }

    #[test]
    fn a_larger_rate_does_not_lengthen_a_turn(rates in rates(), vector in vector(), axis in 0..3_usize, more in 1.0..1.5) {
        let mut larger = rates;
        larger[axis] *= more;
        let slow = rate_box(rates).query(&turn(vector), 1e-6);
        prop_assert!(rate_box(larger).query(&turn(vector), 1e-6).lower_s <= slow.upper_s);
    }

    #[test]
    fn small_turns_and_turns_near_an_axis_are_enclosed(rates in rates(), vector in vector(), axis in 0..3_usize, size in -4.0..0.0) {
        let mut near = vector.map(|x| x * 10.0_f64.powf(size));
        near[axis] += 1.0;
        let table = rate_box(rates);
        checked(rates, &table, &turn(near), 1e-5);
        checked(rates, &table, &turn(vector.map(|x| x * 10.0_f64.powf(size))), 1e-5);
    }
}

#[test]
fn rates_of_very_different_size_give_a_bound_within_the_cell_limit() {
    for rates in [[1.0, 3e-4, 2e-4], [1.0, 2e-3, 1e-3]] {
        let table = RateBox::new(Vector3::from(rates)).expect("valid rates");
        for angle in [0.4, 1.7, 3.0] {
            let turn = Vector3::new(0.6, -0.5, 0.62).normalize() * angle;
            let answer = table.query(&Attitude::from_rotation_vector(turn), 1e-4);
            assert!(answer.cells <= 100_000, "{} cells", answer.cells);
            let share = answer.lower_s / answer.upper_s;
            assert!((0.99..=1.0).contains(&share), "{rates:?}, {angle}: {share}");
        }
    }
}
