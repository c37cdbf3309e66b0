//! The motion between the nodes of a plan.

use super::super::{PropagatedMotion, verify};
use super::build::{EFFECTIVE_X, HALF, TORQUE, angle, bang_bang, scenario, target, valid};

#[test]
fn the_motion_is_that_of_the_verification_and_of_the_closed_form() {
    let scenario = valid(&scenario(vec![target("a", angle(HALF))]));
    let flight = bang_bang();
    let motion = PropagatedMotion::of(&scenario, &flight).unwrap();
    for state in verify(&scenario, &flight).states {
        let found = motion.state(state.time_s).unwrap();
        assert!(found.attitude.angle_to(&state.attitude) < 1e-14);
        assert!((found.body_rate_rad_s - state.body_rate_rad_s).norm() < 1e-16);
        for (found, expected) in found.wheel_speed_rad_s.iter().zip(&state.wheel_speed_rad_s) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
    let acceleration = TORQUE / EFFECTIVE_X;
    for time in [0.3, HALF - 1e-3] {
        let state = motion.state(time).unwrap();
        let [x, _, _, w] = state.attitude.xyzw();
        assert!((2.0 * x.atan2(w) - 0.5 * acceleration * time * time).abs() < 1e-14);
        assert!((state.body_rate_rad_s.x - acceleration * time).abs() < 1e-15);
    }
}

#[test]
fn at_a_switch_the_later_acceleration_counts_and_states_beyond_the_ends_are_those_at_the_ends() {
    let scenario = valid(&scenario(vec![target("a", angle(HALF))]));
    let motion = PropagatedMotion::of(&scenario, &bang_bang()).unwrap();
    let expected = TORQUE / EFFECTIVE_X;
    for (time, sign) in [
        (0.0, 1.0),
        (HALF - 1e-9, 1.0),
        (HALF, -1.0),
        (2.0 * HALF, -1.0),
    ] {
        let found = motion.acceleration(time).unwrap().x;
        assert!((found - sign * expected).abs() < 1e-16, "{time}: {found}");
    }
    for (outside, end) in [(-1.0, 0.0), (99.0, 2.0 * HALF)] {
        let (found, held) = (motion.state(outside).unwrap(), motion.state(end).unwrap());
        assert!(found.attitude.angle_to(&held.attitude) < 1e-15);
    }
}

#[test]
fn a_flight_that_cannot_be_propagated_has_no_motion() {
    let scenario = valid(&scenario(vec![target("a", angle(HALF))]));
    let mut gap = bang_bang();
    gap.controls.remove(0);
    let mut nothing = bang_bang();
    (nothing.total_time_s, nothing.controls) = (0.0, Vec::new());
    for flight in [gap, nothing] {
        assert!(
            !PropagatedMotion::of(&scenario, &flight)
                .unwrap_err()
                .is_empty()
        );
    }
}
