//! The turn against closed forms and finite differences.

use super::*;
use crate::math::quaternion::{dot4, quat, rotate_back};

fn inputs(z: &[f64; INPUTS]) -> TurnInputs {
    TurnInputs {
        begin: Vector3::new(z[0], z[1], z[2]),
        end: Vector3::new(z[3], z[4], z[5]),
        momentum: Vector3::new(z[6], z[7], z[8]),
    }
}

fn inverse() -> Matrix3<f64> {
    let inertia = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.5, 0.2, -0.1, 0.2, 2.5);
    inertia.try_inverse().expect("well conditioned")
}

fn map(with_momentum: bool, substeps: usize) -> TurnMap {
    TurnMap::RungeKutta(RungeKutta::new(inverse(), with_momentum, substeps))
}

const Z: [f64; INPUTS] = [0.3, -0.2, 0.5, 0.1, 0.6, -0.4, 0.4, -0.7, 0.2];

#[test]
fn a_constant_rate_turns_by_its_angle() {
    let rate = Vector3::new(0.3, -0.4, 0.2);
    let z = TurnInputs {
        begin: rate,
        end: rate,
        momentum: Vector3::zeros(),
    };
    let p = map(false, 2).turn(&z);
    let angle = rate.norm();
    let expected = quat(&(rate * ((angle / 2.0).sin() / angle)), (angle / 2.0).cos());
    for (got, want) in p.iter().zip(expected) {
        assert!((got - want).abs() < 1e-9, "{got} against {want}");
    }
}

#[test]
fn the_method_has_order_six() {
    let z = inputs(&Z);
    let fine = map(true, 32).turn(&z);
    let error = |substeps| {
        let p = map(true, substeps).turn(&z);
        p.iter()
            .zip(&fine)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    let order = (error(1) / error(2)).log2();
    assert!(order > 5.5, "observed order {order}");
}

#[test]
fn the_exact_turn_is_that_of_many_steps() {
    for with_momentum in [false, true] {
        let z = inputs(&Z);
        let exact = exact_turn(inverse(), with_momentum, &z);
        let fine = map(with_momentum, 32).turn(&z);
        for (got, want) in exact.iter().zip(&fine) {
            assert!((got - want).abs() < 1e-10, "{got} against {want}");
        }
    }
}

#[test]
fn the_fast_map_without_momentum_has_order_six_too() {
    let error = |length: f64| {
        // Rate and acceleration stay, the interval shrinks.
        let z = inputs(&Z);
        let z = TurnInputs {
            begin: z.begin * length,
            end: (z.begin + (z.end - z.begin) * length) * length,
            momentum: Vector3::zeros(),
        };
        let exact = map(false, 32).turn(&z);
        let fast = TurnMap::fast(Matrix3::identity(), false).turn(&z);
        fast.iter()
            .zip(&exact)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max)
    };
    // The error of one step of a method of order six shrinks with the seventh power.
    let order = (error(1.0) / error(0.5)).log2();
    assert!(order > 6.5, "observed order {order}");
    assert!(error(0.5) < 1e-6);
}

#[test]
fn the_expansion_with_momentum_is_the_turn_of_short_intervals() {
    let error = |length: f64| {
        let z = inputs(&Z);
        let z = TurnInputs {
            begin: z.begin * length,
            end: (z.begin + (z.end - z.begin) * length) * length,
            momentum: z.momentum * length,
        };
        let exact = map(true, 32).turn(&z);
        let expanded = TurnMap::fast(inverse(), true).turn(&z);
        let off = expanded.iter().zip(&exact).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max)
    };
    let order = (error(0.8) / error(0.4)).log2();
    assert!(order > 5.5, "observed order {order}");
    assert!(error(0.2) < 1e-6);
}

#[test]
fn the_rate_in_the_middle_is_that_after_half_the_interval() {
    let error = |length: f64| {
        let z = inputs(&Z);
        let (begin, end) = (
            z.begin * length,
            (z.begin + (z.end - z.begin) * length) * length,
        );
        let momentum = z.momentum * length;
        let wheels = (begin + end) * 0.5;
        // The same motion over the first half.
        let half = TurnInputs {
            begin: begin * 0.5,
            end: wheels * 0.5,
            momentum: momentum * 0.5,
        };
        let rate = wheels + inverse() * rotate_back(&map(true, 32).turn(&half), &momentum);
        let z = TurnInputs {
            begin,
            end,
            momentum,
        };
        (rate - TurnMap::fast(inverse(), true).middle(&z)).norm()
    };
    let order = (error(0.8) / error(0.4)).log2();
    assert!(order > 5.5, "observed order {order}");
    assert!(error(0.2) < 1e-6);
}

#[test]
fn derivatives_match_finite_differences() {
    let fast = [false, true].map(|momentum| TurnMap::fast(inverse(), momentum));
    let [without, with] = fast;
    for map in [map(false, 2), map(true, 2), map(true, 3), without, with] {
        let weights = [0.7, -0.3, 0.9, 0.4];
        let pull = if map.inputs() == INPUTS {
            Vector3::new(0.4, -0.8, 0.5)
        } else {
            Vector3::zeros()
        };
        let exact = map.derivatives(&inputs(&Z), &weights, &pull);
        let at = |index: usize, by: f64| {
            let mut z = Z;
            z[index] += by;
            map.derivatives(&inputs(&z), &weights, &pull)
        };
        let by = 1e-5;
        for j in 0..map.inputs() {
            let (plus, minus) = (at(j, by), at(j, -by));
            for i in 0..4 {
                let first = (plus.turn[i] - minus.turn[i]) / (2.0 * by);
                assert!((first - exact.first[j][i]).abs() < 1e-9, "first {j} {i}");
            }
            let middle = |by: f64| {
                let mut z = Z;
                z[j] += by;
                map.middle(&inputs(&z))
            };
            let middle = (middle(by) - middle(-by)) / (2.0 * by);
            if map.inputs() == INPUTS {
                assert!((middle - exact.middle[j]).norm() < 1e-9, "middle {j}");
            }
            for i in 0..map.inputs() {
                let change = |one: &TurnDerivatives| {
                    dot4(&weights, &one.first[i]) + pull.dot(&one.middle[i])
                };
                let second = (change(&plus) - change(&minus)) / (2.0 * by);
                assert!((second - exact.second[i][j]).abs() < 1e-8, "second {i} {j}");
            }
        }
    }
}
