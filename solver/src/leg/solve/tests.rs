//! Legs with known answers.

mod cones;
mod rolls;
mod steered;

use super::*;
use crate::model::attitude::Attitude;
use crate::model::scenario::{RateCondition, Scenario};
use crate::model::spec::{Accuracy, AttitudeEquivalence, AttitudeSpec, ScenarioSpec};
use crate::model::waypoint::WheelCondition;
use nalgebra::Vector3;

/// Inertia about z without the wheel's spin, kg m².
const J_EFF_Z: f64 = 9.63 - 0.000_169;

fn dynamics(change: impl FnOnce(&mut ScenarioSpec)) -> Dynamics {
    let mut spec = crate::model::scenario::reference::experiment_a();
    change(&mut spec);
    Scenario::try_new(&spec)
        .expect("a valid scenario")
        .scenario
        .dynamics()
}

fn at_rest(attitude: Attitude) -> Waypoint {
    Waypoint {
        attitude,
        roll: None,
        rate: [RateCondition::Fixed(0.0); 3],
        wheels: WheelCondition::Free,
        costates: None,
    }
}

fn roll_pitch_yaw(angles_deg: [f64; 3]) -> Attitude {
    let spec = AttitudeSpec::RollPitchYawDeg(angles_deg);
    let read = Attitude::try_new(&spec, AttitudeEquivalence::Rotation, "");
    read.expect("a valid attitude").0
}

fn rest_to_rest(dynamics: &Dynamics, from: Attitude, to: Attitude) -> f64 {
    solve_between(dynamics, &at_rest(from), &at_rest(to), Arrival::Rotation).0
}

/// Duration and last attitude of a leg.
fn solve_between(
    dynamics: &Dynamics,
    from: &Waypoint,
    to: &Waypoint,
    arrival: Arrival,
) -> (f64, Attitude) {
    let null = &DVector::zeros(dynamics.wheel_count() - 3);
    let leg = LegProblem {
        dynamics,
        from,
        to,
        arrival,
        null,
        extremals: &KinematicExtremals::of(dynamics),
        resolution: Resolution::of(Accuracy::Standard, dynamics),
    };
    let solution = solve(&leg, None, &|| None).solution;
    let duration = solution.duration().expect("the leg converges");
    (duration, *solution.profile.attitudes.last().expect("nodes"))
}

/// The spacecraft of experiment A, held so that it can turn about z only.
fn held_to_z(max_rate: Option<f64>) -> Dynamics {
    dynamics(|spec| spec.spacecraft.max_body_rate_rad_s = [Some(1e-7), Some(1e-7), max_rate])
}

#[test]
fn a_short_turn_about_one_axis_is_bang_bang() {
    let angle = 0.05;
    let to = Attitude::from_rotation_vector(Vector3::new(0.0, 0.0, angle));
    let duration = rest_to_rest(&held_to_z(None), Attitude::identity(), to);
    let bang_bang = 2.0 * (angle * J_EFF_Z / 0.0101_f64).sqrt();
    assert!(
        (duration / bang_bang - 1.0).abs() < 2e-5,
        "{duration} against {bang_bang}"
    );
    let free = rest_to_rest(&dynamics(|_| {}), Attitude::identity(), to);
    assert!(
        free < bang_bang,
        "the two other axes help: {free} against {bang_bang}"
    );
}

#[test]
fn a_long_turn_about_one_axis_is_bang_coast_bang() {
    let (angle, rate) = (1.0, 0.005);
    let to = Attitude::from_rotation_vector(Vector3::new(0.0, 0.0, angle));
    let duration = rest_to_rest(&held_to_z(Some(rate)), Attitude::identity(), to);
    let bang_coast_bang = angle / rate + rate * J_EFF_Z / 0.0101;
    let error = duration / bang_coast_bang - 1.0;
    assert!(error.abs() < 2e-5, "{duration} against {bang_coast_bang}");
    let null = DVector::zeros(0);
    let dynamics = held_to_z(Some(rate));
    let eigenaxis = EigenaxisSlew::fastest(&dynamics, &Attitude::identity(), &to, &null);
    assert!((eigenaxis.course.duration() / bang_coast_bang - 1.0).abs() < 1e-9);
}

/// Rate limits near zero about two axes leave the program a tiny interior: its solution is 2.5e-6
/// slower than the turn about the third axis, which keeps all limits.
#[test]
fn no_leg_takes_longer_than_the_eigenaxis_slew() {
    for (angle, rate) in [(0.05, None), (1.0, Some(0.005)), (3.0, None)] {
        let dynamics = held_to_z(rate);
        let to = Attitude::from_rotation_vector(Vector3::new(0.0, 0.0, angle));
        let duration = rest_to_rest(&dynamics, Attitude::identity(), to);
        let null = DVector::zeros(0);
        let eigenaxis = EigenaxisSlew::fastest(&dynamics, &Attitude::identity(), &to, &null);
        let excess = duration / eigenaxis.course.duration() - 1.0;
        assert!(excess <= EIGENAXIS_TOLERANCE, "{angle} rad: {excess:.1e}");
    }
}

#[test]
fn the_eigenaxis_slew_replaces_a_leg_that_does_not_converge() {
    let turn = Vector3::new(0.3, -0.5, 0.7);
    let (from, to) = (
        at_rest(Attitude::identity()),
        at_rest(Attitude::from_rotation_vector(turn)),
    );
    let dynamics = dynamics(|_| {});
    let leg = LegProblem {
        dynamics: &dynamics,
        from: &from,
        to: &to,
        arrival: Arrival::Rotation,
        null: &DVector::zeros(0),
        extremals: &KinematicExtremals::of(&dynamics),
        resolution: Resolution::of(Accuracy::Standard, &dynamics),
    };
    let eigenaxis = leg.eigenaxis();
    let failed = LegSolution {
        status: NlpStatus::IterationLimit,
        profile: eigenaxis.exact(&dynamics, leg.intervals()),
        intervals: vec![leg.intervals()],
        iterations: 0,
        infeasibility: 1.0,
        costates: Vec::new(),
    };
    let instead = leg.no_slower_than_eigenaxis(&failed, &|| None);
    let duration = instead.and_then(|solution| solution.duration());
    let allowed = eigenaxis.course.duration() * (1.0 + EIGENAXIS_TOLERANCE);
    assert!(duration.is_some_and(|time| time <= allowed), "{duration:?}");
    // It begins and ends at rest, so it does not meet ends with a rate.
    let moving = Waypoint {
        rate: [RateCondition::Fixed(0.01); 3],
        ..to.clone()
    };
    let leg = LegProblem { to: &moving, ..leg };
    assert!(leg.no_slower_than_eigenaxis(&failed, &|| None).is_none());
}

#[test]
fn a_published_leg_and_a_roll_with_a_second_local_minimum_are_solved() {
    let dynamics = dynamics(|_| {});
    let (a, b) = (
        roll_pitch_yaw([15.0, 0.0, 10.0]),
        roll_pitch_yaw([25.0, 0.0, 50.0]),
    );
    let published = rest_to_rest(&dynamics, a, b);
    assert!((57.50..=57.60).contains(&published), "{published}");
    let (h, n) = (
        roll_pitch_yaw([50.0, 0.0, 50.0]),
        roll_pitch_yaw([95.0, 0.0, 50.0]),
    );
    let roll = rest_to_rest(&dynamics, h, n);
    assert!(roll <= 53.99, "{roll}");
    // The first guess alone suffices; from the eigenaxis slew a local solver stays at 55.3 s.
    let leg = LegProblem {
        dynamics: &dynamics,
        from: &at_rest(h),
        to: &at_rest(n),
        arrival: Arrival::Rotation,
        null: &DVector::zeros(0),
        extremals: &KinematicExtremals::of(&dynamics),
        resolution: Resolution::of(Accuracy::Standard, &dynamics),
    };
    let guess = leg.extremals.guess(&leg).expect("a turn");
    let first = leg.solve_from(&guess, &|| None).duration();
    assert!(first.is_some_and(|first| first <= 53.99), "{first:?}");
}

#[test]
fn signs_and_direction_of_travel_do_not_matter_without_momentum() {
    let dynamics = dynamics(|_| {});
    let (a, e) = (
        roll_pitch_yaw([15.0, 0.0, 10.0]),
        roll_pitch_yaw([15.0, 0.0, 250.0]),
    );
    let forth = rest_to_rest(&dynamics, a, e);
    for duration in [
        rest_to_rest(&dynamics, a, e.negated()),
        rest_to_rest(&dynamics, a.negated(), e),
        rest_to_rest(&dynamics, e, a),
    ] {
        assert!(
            (duration / forth - 1.0).abs() < 1e-4,
            "{duration} against {forth}"
        );
    }
}

#[test]
fn free_end_rates_never_take_longer() {
    let dynamics = dynamics(|_| {});
    let (a, b) = (
        roll_pitch_yaw([15.0, 0.0, 10.0]),
        roll_pitch_yaw([25.0, 0.0, 50.0]),
    );
    let free = |attitude| Waypoint {
        rate: [
            RateCondition::Free,
            RateCondition::Free,
            RateCondition::Fixed(0.0),
        ],
        ..at_rest(attitude)
    };
    let (bound, _) = solve_between(&dynamics, &free(a), &free(b), Arrival::Rotation);
    assert!(bound < rest_to_rest(&dynamics, a, b));
}

#[test]
fn a_given_quaternion_sign_leads_the_long_way_round() {
    let dynamics = dynamics(|_| {});
    let to = Attitude::from_rotation_vector(Vector3::new(0.0, 0.0, 0.8));
    let (from, there) = (at_rest(Attitude::identity()), at_rest(to.negated()));
    let (long, arrived) = solve_between(&dynamics, &from, &there, Arrival::Quaternion);
    assert!(long > 3.0 * rest_to_rest(&dynamics, Attitude::identity(), to));
    assert!(arrived.signed_turn_to(&to.negated()).norm() < 1e-6);
}
