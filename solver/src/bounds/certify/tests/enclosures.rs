//! Enclosures by intervals, turns and the integral are valid and tight.

use super::super::link;
use super::super::turn::{about, angle_of, of_numbers, product, rotate, swing, twist};
use crate::bounds::interval::{Interval, twice_asin_of_root};
use crate::bounds::kinematic::limits::{EndRates, SlewLimits};
use crate::model::attitude::Attitude;
use nalgebra::Vector3;
use proptest::prelude::*;
use std::f64::consts::PI;

/// Largest width of an enclosure after a few operations on exact numbers.
const SHARP: f64 = 1e-13;

/// A real number as its nearest double and the sign of the difference.
#[derive(Debug, Clone, Copy)]
struct Exact {
    nearest: f64,
    missing: f64,
}

impl Exact {
    /// Two-sum: the rounding error of a sum is a double (Knuth, The Art of Computer Programming 2,
    /// 4.2.2).
    fn sum(a: f64, b: f64) -> Self {
        let nearest = a + b;
        let of_b = nearest - a;
        let missing = (a - (nearest - of_b)) + (b - of_b);
        Self { nearest, missing }
    }

    /// The rounding error of a product is a double, which a fused multiply-add computes.
    fn product(a: f64, b: f64) -> Self {
        let nearest = a * b;
        let missing = a.mul_add(b, -nearest);
        Self { nearest, missing }
    }

    fn quotient(a: f64, b: f64) -> Self {
        let nearest = a / b;
        let missing = (-nearest).mul_add(b, a) * b.signum();
        Self { nearest, missing }
    }

    fn root(x: f64) -> Self {
        let nearest = x.sqrt();
        let missing = (-nearest).mul_add(nearest, x);
        Self { nearest, missing }
    }

    fn is_in(self, interval: Interval) -> bool {
        let above = interval.low < self.nearest
            || interval.low.to_bits() == self.nearest.to_bits() && self.missing >= 0.0;
        let below = interval.high > self.nearest
            || interval.high.to_bits() == self.nearest.to_bits() && self.missing <= 0.0;
        above && below
    }
}

fn contains(interval: Interval, x: f64) -> bool {
    interval.low <= x && x <= interval.high
}

fn assert_encloses(interval: Interval, x: f64) {
    // The expected number is rounded itself.
    let slack = 1e-15 * x.abs().max(1.0);
    let near = interval.low - slack <= x && x <= interval.high + slack;
    assert!(near, "{interval:?} without {x}");
    let width = interval.high - interval.low;
    assert!(width < SHARP * x.abs().max(1.0), "{interval:?} is wide");
}

#[test]
fn pi_and_thirds_are_enclosed() {
    // The double nearest to pi is 1.2e-16 less.
    assert_eq!(Interval::PI.low.to_bits(), PI.to_bits());
    assert_eq!(Interval::PI.high.to_bits(), PI.next_up().to_bits());
    let third = Interval::ONE / Interval::exactly(3.0);
    assert!(third.low < third.high);
    let one = third * Interval::exactly(3.0);
    assert!(one.low < 1.0 && one.high > 1.0);
    let nothing = Interval::ONE / (third - third);
    assert!(nothing.low == f64::NEG_INFINITY && nothing.high == f64::INFINITY);
}

#[test]
fn the_angle_of_a_box_about_the_origin_is_the_whole_circle() {
    let wide = Interval::around(0.0, 1e-3);
    let angle = Interval::angle(wide, Interval::exactly(1e-4));
    assert!(angle.high - angle.low >= 2.0 * PI);
}

proptest! {
    #[test]
    fn operations_on_numbers_enclose_the_exact_results(x in -3.0..3.0_f64, y in -3.0..3.0_f64) {
        prop_assume!(x != 0.0 && y != 0.0);
        let (a, b) = (Interval::exactly(x), Interval::exactly(y));
        let size = x.abs();
        for (name, enclosure, exact) in [
            ("sum", a + b, Exact::sum(x, y)),
            ("difference", a - b, Exact::sum(x, -y)),
            ("product", a * b, Exact::product(x, y)),
            ("quotient", a / b, Exact::quotient(x, y)),
            ("square", a.squared(), Exact::product(x, x)),
            ("root", Interval::exactly(size).sqrt(), Exact::root(size)),
            ("twice", a.twice(), Exact::sum(x, x)),
            ("half", a.half(), Exact::product(x, 0.5)),
            ("lower end", Interval::around(x, y.abs()), Exact::sum(x, -y.abs())),
            ("upper end", Interval::around(x, y.abs()), Exact::sum(x, y.abs())),
        ] {
            prop_assert!(exact.is_in(enclosure), "{name} {enclosure:?} {exact:?}");
        }
    }

    #[test]
    fn operations_enclose_points(x in -3.0..3.0_f64, y in -3.0..3.0_f64, at in 0.0..1.0_f64, width in 0.0..0.1_f64) {
        let (a, b) = (Interval { low: x, high: x + width }, Interval { low: y, high: y + width });
        let (p, q) = (x + at * width, y + (1.0 - at) * width);
        prop_assert!(contains(a + b, p + q));
        prop_assert!(contains(a - b, p - q));
        prop_assert!(contains(a * b, p * q));
        prop_assert!(contains(a.squared(), p * p));
        prop_assert!(contains(a.abs(), p.abs()));
        prop_assert!(contains(a.abs().sqrt(), p.abs().sqrt()));
        prop_assert!(contains(a.length(b), p.hypot(q)));
        prop_assert!(contains(a.sin_cos().0, p.sin()));
        prop_assert!(contains(a.sin_cos().1, p.cos()));
        if q.abs() > 0.2 {
            prop_assert!(contains(a / b, p / q));
        }
        let turns = (q.atan2(p) - Interval::angle(b, a).middle()) / (2.0 * PI);
        prop_assert!(contains(
            Interval::angle(b, a) + Interval::exactly(2.0 * PI * turns.round()),
            q.atan2(p),
        ));
        let share = Interval { low: a.low / 4.0, high: a.high / 4.0 };
        prop_assert!(contains(share.acos(), (p / 4.0).acos()));
        let root = at * at;
        prop_assert!(twice_asin_of_root(root) >= 2.0 * at.asin() * (1.0 - 1e-15) || root >= 0.5);
        prop_assert!(twice_asin_of_root(1e-4 * root) <= 2.0 * (1e-2 * at).asin() * 1.0001);
    }

    #[test]
    fn turns_agree_with_attitudes(first in prop::array::uniform3(-1.0..1.0_f64), second in prop::array::uniform3(-1.0..1.0_f64)) {
        let attitude = |v: [f64; 3]| Attitude::from_rotation_vector(v.into());
        let turn = |v: [f64; 3]| {
            let angle = Vector3::from(v).norm();
            about(&v.map(|x| Interval::exactly(x) / Interval::exactly(angle)), Interval::exactly(angle))
        };
        let both = attitude(first).then_in_body(&attitude(second));
        let product = product(&turn(first), &turn(second));
        let xyzw = both.xyzw();
        for i in 0..4 {
            assert_encloses(product[i], xyzw[i]);
        }
        assert_encloses(angle_of(&product), both.angle_to(&Attitude::identity()));
        assert_encloses(angle_of(&product.map(|c| -c)), both.angle_to(&Attitude::identity()));
        let v = [0.3, -0.8, 0.5];
        let rotated = rotate(&product, &v.map(Interval::exactly));
        let expected = both.to_reference(v.into());
        for i in 0..3 {
            assert_encloses(rotated[i], expected[i]);
            // Swing is the angle by which the axis moves; twist and swing together give the turn.
            let axis = Vector3::ith(i, 1.0);
            let moved = both.to_reference(axis).dot(&axis);
            let along = of_numbers(&axis);
            prop_assert!((swing(&product, &along).middle().cos() - moved).abs() < 1e-12);
            let of_twist = (0.5 * twist(&product, &along).middle()).cos();
            let of_swing = (0.5 * swing(&product, &along).middle()).cos();
            prop_assert!((of_twist * of_swing - xyzw[3]).abs() < 1e-12);
        }
    }

    #[test]
    fn the_bound_on_the_integral_agrees_with_a_sum(
        rates in prop::array::uniform3(0.1..1.0_f64),
        ramps in prop::array::uniform3(0.1..3.0_f64),
        narrowed in prop::array::uniform3(0.2..1.0_f64),
        ends in prop::array::uniform6(-0.5..1.5_f64),
        duration in 0.05..8.0_f64,
    ) {
        let rates = Vector3::from(rates);
        let limits = SlewLimits {
            rates_rad_s: rates,
            accelerations_rad_s2: rates.component_div(&Vector3::from(ramps)),
        };
        // Stopped, known and free ends.
        let end = |share: f64| if share > 1.0 { f64::INFINITY } else { share.max(0.0) };
        let bounds = EndRates {
            begin_rad_s: Vector3::from_fn(|i, _| end(ends[i]) * rates[i]),
            end_rad_s: Vector3::from_fn(|i, _| end(ends[3 + i]) * rates[i]),
        };
        let p = rates.component_mul(&Vector3::from(narrowed));
        let integrand = |t: f64| (0..3).fold(0.0, |largest, i| {
            let a = limits.accelerations_rad_s2[i];
            let m = rates[i].min(bounds.begin_rad_s[i] + a * t).min(bounds.end_rad_s[i] + a * (duration - t));
            f64::max(largest, m / p[i])
        });
        let steps = 20_000;
        let step = duration / f64::from(steps);
        let sum = (0..steps).map(|k| integrand((f64::from(k) + 0.5) * step)).sum::<f64>() * step;
        let bound = link::at_most(&limits, &bounds, &p, duration);
        // The sum is accurate to second order, and to first order at the few kinks.
        prop_assert!((bound / sum - 1.0).abs() < 1e-6, "{} against {}", bound, sum);
    }
}

#[test]
fn equal_ramps_have_a_closed_integral() {
    let limits = SlewLimits {
        rates_rad_s: Vector3::new(0.5, 0.25, 1.0),
        accelerations_rad_s2: Vector3::new(0.25, 0.125, 0.5),
    };
    for (duration, expected) in [(5.0, 3.0), (4.0, 2.0), (2.0, 0.5)] {
        let bound = link::at_most(&limits, &EndRates::at_rest(), &limits.rates_rad_s, duration);
        assert!(bound >= expected, "{bound} is below {expected}");
        assert!(
            bound < expected * (1.0 + 1e-12),
            "{bound} is far above {expected}"
        );
    }
}
