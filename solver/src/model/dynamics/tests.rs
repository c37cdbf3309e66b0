//! Dynamics against enumeration, and the definition of zero momentum.

use super::*;
use crate::math::random::SplitMix;
use crate::model::random::{direction, spacecraft};
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::WheelSpec;

fn corners() -> impl Iterator<Item = Vector3<f64>> {
    let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
    (0..8).map(move |corner| Vector3::from_fn(|axis, _| sign(corner, axis)))
}

#[test]
fn the_gyroscopic_acceleration_is_the_largest_of_all_corners() {
    let mut random = SplitMix::new(31);
    for case in 0..40 {
        let mut dynamics = spacecraft(&mut random, true).dynamics();
        dynamics.max_rate_norm = f64::INFINITY;
        let rates = dynamics.reachable_rates().inf(&dynamics.max_rate);
        for share in [0.0, dynamics.mean_inverse_inertia()] {
            let axis = direction(&mut random);
            let lever = dynamics.inertia_inverse * axis - axis * share;
            let largest = corners().fold(0.0, |most, corner| {
                f64::max(most, lever.cross(&rates.component_mul(&corner)).norm())
            });
            let expected = largest * dynamics.momentum.norm();
            let found = dynamics.gyroscopic_acceleration(&axis, share);
            assert!((found - expected).abs() <= 1e-12 * expected, "case {case}");
        }
    }
}

#[test]
fn the_axes_nearest_to_the_wheels_are_right_handed() {
    let mut random = SplitMix::new(32);
    for case in 0..40 {
        let axes = spacecraft(&mut random, false).dynamics().wheel_axes();
        let unit = axes.tr_mul(&axes) - Matrix3::identity();
        assert!(unit.amax() < 1e-12, "case {case}: {axes}");
        assert!(
            (axes.determinant() - 1.0).abs() < 1e-12,
            "case {case}: {axes}"
        );
    }
}

#[test]
fn body_axes_are_natural_where_their_rates_are_limited() {
    let mut random = SplitMix::new(36);
    let mut dynamics = spacecraft(&mut random, false).dynamics();
    dynamics.max_rate = Vector3::new(f64::INFINITY, 0.1, f64::INFINITY);
    assert_eq!(dynamics.natural_axes(), Matrix3::identity());
    dynamics.max_rate.y = f64::INFINITY;
    assert_eq!(dynamics.natural_axes(), dynamics.wheel_axes());
    assert!((dynamics.wheel_axes() - Matrix3::identity()).amax() > 1e-3);
}

#[test]
fn momentum_below_rounding_counts_as_zero() {
    let mut spec = experiment_a();
    // Four wheels of a pyramid spin along their null space; their momenta cancel up to rounding.
    spec.spacecraft.wheels = [
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [-1.0, 0.0, 1.0],
        [0.0, -1.0, 1.0],
    ]
    .map(|axis| WheelSpec {
        axis,
        ..spec.spacecraft.wheels[0].clone()
    })
    .into();
    let with = |speeds: [f64; 4]| {
        let mut spec = spec.clone();
        spec.start.wheel_speed_rad_s = Some(speeds.into());
        let valid = Scenario::try_new(&spec).expect("valid");
        valid.scenario.dynamics()
    };
    assert!(!with([300.3, -300.3, 300.3, -300.3]).has_momentum());
    assert!(!with([300.3, -300.3, 300.3, -300.3 * (1.0 + 1e-15)]).has_momentum());
    assert!(with([300.3, -300.3, 300.3, -300.3 * (1.0 + 1e-12)]).has_momentum());
}

#[test]
fn a_body_that_turns_against_its_wheels_has_no_momentum() {
    for step in 1..18 {
        let mut spec = experiment_a();
        let rate = 1e-3 * f64::from(step);
        let spin =
            -spec.spacecraft.inertia_kg_m2[0][0] * rate / spec.spacecraft.wheels[0].inertia_kg_m2;
        spec.start.body_rate_rad_s = Some([rate, 0.0, 0.0]);
        spec.start.wheel_speed_rad_s = Some(vec![spin, 0.0, 0.0]);
        let scenario = Scenario::try_new(&spec).expect("valid").scenario;
        assert!(!scenario.dynamics().has_momentum(), "{rate}");
    }
}

#[test]
fn the_gyroscopic_acceleration_vanishes_without_momentum_or_lever() {
    let mut random = SplitMix::new(35);
    let axis = direction(&mut random);
    let mut dynamics = spacecraft(&mut random, true).dynamics();
    dynamics.max_rate_norm = f64::INFINITY;
    dynamics.inertia_inverse = Matrix3::identity();
    // Equal moments of inertia, seen from axes that turn with the whole acceleration.
    assert!(dynamics.gyroscopic_acceleration(&axis, 1.0).abs() == 0.0);
    dynamics.momentum = Vector3::zeros();
    assert!(dynamics.gyroscopic_acceleration(&axis, 0.0).abs() == 0.0);
}

#[test]
fn wheel_momenta_of_a_rate_give_the_rate_again() {
    let mut random = SplitMix::new(34);
    for case in 0..40 {
        let dynamics = spacecraft(&mut random, true).dynamics();
        let attitude = Attitude::from_rotation_vector(direction(&mut random));
        let rate = direction(&mut random) * 0.1;
        let null = DVector::from_element(dynamics.null_space.ncols(), 0.02);
        let wheels = dynamics.wheels_at(&attitude, &rate, &null);
        let again = dynamics.rate(&attitude, &wheels);
        assert!((again - rate).norm() < 1e-12, "case {case}: {rate} {again}");
    }
}

#[test]
fn rates_stray_from_a_lower_limit_by_a_larger_share() {
    let mut random = SplitMix::new(33);
    for norm in [false, true] {
        let mut dynamics = spacecraft(&mut random, true).dynamics();
        dynamics.max_rate = Vector3::repeat(f64::INFINITY);
        dynamics.max_rate_norm = f64::INFINITY;
        assert!(dynamics.straying() <= 0.0);
        let mut limited = |limit: f64| {
            if norm {
                dynamics.max_rate_norm = limit;
            } else {
                dynamics.max_rate.y = limit;
            }
            dynamics.straying()
        };
        let (wide, narrow) = (limited(1e-3), limited(5e-4));
        dynamics.momentum *= 2.0;
        let twice = dynamics.straying();
        assert!(
            (twice - 2.0 * narrow).abs() < 1e-9 * narrow,
            "{twice} {narrow}"
        );
        assert!(
            wide > 0.0 && (narrow - 2.0 * wide).abs() < 1e-9 * wide,
            "{wide} {narrow}"
        );
    }
}
