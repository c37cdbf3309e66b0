//! Frames are orthonormal, and their first axes are across facets of what the wheels reach.

use super::*;
use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use crate::model::dynamics::along;
use crate::model::random::{direction, spacecraft};

/// A vertex of the rates that torques or speeds at their limits give along a direction: the sum over
/// the wheels of the levers of the sign that increases it. On a facet's normal wheels in the facet add
/// nothing.
fn idle_wheels(dynamics: &Dynamics, normal: &Vector3<f64>) -> usize {
    let levers = dynamics
        .actuators
        .iter()
        .map(|wheel| dynamics.inertia_inverse * wheel.axis);
    levers
        .filter(|lever| lever.normalize().dot(normal).abs() < 1e-2)
        .count()
}

#[test]
fn frames_have_their_first_axis_across_a_facet() {
    let mut random = SplitMix::new(11);
    for case in 0..40 {
        let dynamics = spacecraft(&mut random, false).dynamics();
        let facets = Facets::of(&dynamics);
        let limited = dynamics.max_rate.iter().any(|limit| limit.is_finite());
        let turn = direction(&mut random);
        let frames = facets.frames(&turn);
        assert!(
            (3..=FIRST * (NARROW + 1)).contains(&frames.len()),
            "case {case}: {frames:?}"
        );
        for key in frames {
            let axes = facets.axes(key);
            assert!((axes.tr_mul(&axes) - Matrix3::identity()).amax() < 1e-14);
            assert!(axes.determinant() > 0.0);
            let first = axes.column(0).into_owned();
            let body = (0..3).any(|axis| first[axis].abs() >= 1.0);
            assert!(
                (limited && body) || idle_wheels(&dynamics, &first) >= 2,
                "case {case}"
            );
        }
    }
}

/// Along the normal of the facet that limits a short turn a box is as narrow as can be: no other frame
/// lets the turn take longer.
#[test]
fn the_first_frame_bounds_a_short_turn_best() {
    let mut random = SplitMix::new(12);
    let (mut better, mut cases) = (0, 0);
    for _ in 0..40 {
        let dynamics = spacecraft(&mut random, false).dynamics();
        let facets = Facets::of(&dynamics);
        let turn = direction(&mut random) * 1e-9;
        let time = |axes: &Matrix3<f64>| {
            let accelerations = along(axes, |axis| dynamics.reachable_acceleration(axis));
            axes.tr_mul(&turn).abs().component_div(&accelerations).max()
        };
        let first = time(&facets.axes(facets.frames(&turn)[0]));
        let any = Attitude::from_rotation_vector(direction(&mut random)).matrix();
        for axes in [Matrix3::identity(), dynamics.wheel_axes(), any] {
            assert!(
                first >= time(&axes) * (1.0 - 2e-2),
                "{first} {}",
                time(&axes)
            );
            better += usize::from(first > 1.02 * time(&axes));
            cases += 1;
        }
    }
    assert!(2 * better > cases, "{better} of {cases}");
}
