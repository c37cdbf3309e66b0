//! Limits that are exceeded only inside an interval.

use super::build::{
    HALF, TORQUE, about_x, accepted, angle, bang_bang, control, passage, refused, report, scenario,
    target,
};
use crate::model::plan::Flight;
use crate::model::spec::ScenarioSpec;

/// Amplitude of the nutation of [`nutation`], rad/s.
const AMPLITUDE: f64 = 0.02;
/// Where its phase begins, rad; the peak of the x rate is at phase 0.
const PHASE: f64 = -0.5;

/// Motion without torques: with `J_eff = diag(j, j, k)` the x rate is `A cos(phase + n t)`, and the speed
/// of the wheel on x changes by the opposite of the body rate.
fn nutation() -> (ScenarioSpec, Flight) {
    let mut spec = scenario(vec![target("a", 0.0)]);
    let wheel = super::build::SPIN_INERTIA;
    spec.spacecraft.inertia_kg_m2 = [
        [4.0 + wheel, 0.0, 0.0],
        [0.0, 4.0 + wheel, 0.0],
        [0.0, 0.0, 6.0 + wheel],
    ];
    let spin = 0.1;
    let nutation_rate = (6.0 - 4.0) / 4.0 * spin;
    spec.start.body_rate_rad_s = Some([AMPLITUDE * PHASE.cos(), AMPLITUDE * PHASE.sin(), spin]);
    // The wheels start so that J_eff w is the whole momentum.
    let still = [AMPLITUDE * PHASE.cos(), AMPLITUDE * PHASE.sin(), spin].map(|w| -w);
    spec.start.wheel_speed_rad_s = Some(still.into());
    spec.targets[0].zero_rate_axes = Some([false; 3]);
    let total = (0.8 - PHASE) / nutation_rate;
    let flight = Flight {
        total_time_s: total,
        passages: vec![passage("a", total, total)],
        controls: vec![control(0.0, total, 0.0)],
    };
    (spec, flight)
}

#[test]
fn a_rate_peak_inside_an_interval_is_found() {
    let (mut spec, flight) = nutation();
    spec.spacecraft.max_body_rate_rad_s[0] = Some(0.999 * AMPLITUDE);
    let found = refused(
        &spec,
        &flight,
        "the body rate about x reaches 0.02 rad/s at 10 s",
    );
    let excess = found.verification.max_rate_excess;
    assert!((excess - (1.0 / 0.999 - 1.0)).abs() < 1e-12, "{excess}");
    spec.spacecraft.max_body_rate_rad_s[0] = Some(1.001 * AMPLITUDE);
    let found = report(&spec, &flight);
    assert!(found.verification.max_rate_excess == 0.0);
    assert!((found.margins.body_rate.unwrap() - (1.0 - 1.0 / 1.001)).abs() < 1e-12);
}

#[test]
fn a_wheel_speed_peak_inside_an_interval_is_found() {
    let (mut spec, flight) = nutation();
    // |W_x| follows the x rate here, and peaks with it.
    spec.spacecraft.wheels[0].max_speed_rad_s = Some(0.99 * AMPLITUDE);
    let found = refused(&spec, &flight, "the speed of wheel 0 reaches");
    let excess = found.verification.max_wheel_speed_excess;
    assert!((excess - (1.0 / 0.99 - 1.0)).abs() < 1e-12, "{excess}");
    spec.spacecraft.wheels[0].max_speed_rad_s = Some(1.001 * AMPLITUDE);
    assert!(report(&spec, &flight).verification.max_wheel_speed_excess == 0.0);
}

#[test]
fn the_limit_on_the_norm_of_the_rate_is_tested() {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    let peak = TORQUE / super::build::EFFECTIVE_X * HALF;
    spec.spacecraft.max_body_rate_norm_rad_s = Some(peak);
    let found = accepted(&spec, &bang_bang());
    assert!(found.margins.body_rate.unwrap().abs() < 1e-12);
    spec.spacecraft.max_body_rate_norm_rad_s = Some(peak * (1.0 - 2e-6));
    refused(&spec, &bang_bang(), "the norm of the body rate reaches");
}

#[test]
fn torque_limits_count_per_direction_and_with_the_authority() {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    spec.spacecraft.wheels[0].min_torque_nm = Some(-0.8 * TORQUE);
    let found = refused(
        &spec,
        &bang_bang(),
        "the torque on wheel 0 reaches -0.02 N m at 0 s",
    );
    assert!((found.verification.max_torque_excess - 0.25).abs() < 1e-12);

    let mut spec = scenario(vec![target("a", angle(HALF))]);
    spec.options.torque_authority = 0.5;
    spec.options.momentum_authority = 0.125;
    let found = refused(&spec, &bang_bang(), "where -0.01 N m is allowed");
    assert!((found.verification.max_torque_excess - 1.0).abs() < 1e-12);
    assert!(
        found.margins.torque.abs() < 1e-12,
        "margins refer to the hardware"
    );
    refused(&spec, &bang_bang(), "at 10 s where 50 rad/s is allowed");
}

#[test]
fn zero_crossings_of_wheel_speeds_are_counted() {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    // The slew takes 100 rad/s from a wheel that has 50, and gives them back.
    spec.start.wheel_speed_rad_s = Some(vec![-50.0, 0.0, 0.0]);
    spec.spacecraft.max_body_rate_rad_s = [None; 3];
    let found = accepted(&spec, &bang_bang());
    assert_eq!(found.margins.wheel_zero_crossings, [0, 0, 0]);
    spec.start.wheel_speed_rad_s = Some(vec![50.0, 0.0, 0.0]);
    let found = accepted(&spec, &bang_bang());
    assert_eq!(found.margins.wheel_zero_crossings, [2, 0, 0]);
    spec.targets[0].attitude = about_x(angle(HALF) + 2e-6);
    refused(&spec, &bang_bang(), "missed");
}
