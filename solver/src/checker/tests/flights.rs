//! Whole flights that pass, and the smallest changes that make them fail.

use super::build::{
    EFFECTIVE_X, HALF, SPIN_INERTIA, TORQUE, about_x, accepted, angle, bang_bang, control, passage,
    refused, report, scenario, target, valid, wheel,
};
use crate::model::plan::{Control, Flight};
use crate::model::spec::{AttitudeEquivalence, AttitudeSpec, ScenarioSpec, StateSpec};
use std::time::Instant;

#[test]
fn bang_bang_reaches_its_closed_form() {
    let report = accepted(&scenario(vec![target("a", angle(HALF))]), &bang_bang());
    let verification = &report.verification;
    assert!(
        verification.max_attitude_error_rad < 1e-13,
        "{verification:?}"
    );
    assert!(
        verification.max_rate_error_rad_s < 1e-15,
        "{verification:?}"
    );
    // u = -T spins the wheel down by T / I and the body up, which the relative speed adds.
    let peak = (TORQUE / SPIN_INERTIA + TORQUE / EFFECTIVE_X) * HALF;
    let left = report.margins.wheel_speed.unwrap();
    assert!((left - (1.0 - peak / 400.0)).abs() < 1e-12, "{left}");
    assert!(report.margins.torque.abs() < 1e-15);
    assert_eq!(report.margins.body_rate, None);
    assert_eq!(report.margins.wheel_zero_crossings, [0, 0, 0]);
    assert!(report.momentum_drift < 1e-14, "{}", report.momentum_drift);
}

#[test]
fn states_hold_every_boundary_and_no_wide_gap() {
    let report = accepted(&scenario(vec![target("a", angle(HALF))]), &bang_bang());
    let times: Vec<f64> = report.states.iter().map(|s| s.time_s).collect();
    for boundary in [0.0, HALF, 2.0 * HALF] {
        assert!(
            times.iter().any(|t| (t - boundary).abs() == 0.0),
            "{boundary}"
        );
    }
    for pair in times.windows(2) {
        let gap = pair[1] - pair[0];
        assert!(
            gap > 0.0 && gap <= 2.0 * HALF / 500.0 * (1.0 + 1e-9),
            "{gap}"
        );
    }
    let middle = &report.states[times.len() / 2];
    let expected = TORQUE / EFFECTIVE_X * middle.time_s;
    assert!((middle.body_rate_rad_s.x - expected).abs() < 1e-12);
}

#[test]
fn states_of_a_short_slew_beside_a_long_rest_are_dense() {
    let (stay, short) = (5000.0, 0.1);
    let first = 2.0 * HALF;
    let second = first + stay;
    let mut spec = scenario(vec![
        target("a", angle(HALF)),
        target("b", angle(HALF) + angle(short)),
    ]);
    spec.targets[0].dwell_s = stay;
    let flight = Flight {
        total_time_s: second + 2.0 * short,
        passages: vec![
            passage("a", first, second),
            passage("b", second + 2.0 * short, second + 2.0 * short),
        ],
        controls: vec![
            control(0.0, HALF, -TORQUE),
            control(HALF, HALF, TORQUE),
            control(first, stay, 0.0),
            control(second, short, -TORQUE),
            control(second + short, short, TORQUE),
        ],
    };
    let report = accepted(&spec, &flight);
    let times: Vec<f64> = report.states.iter().map(|s| s.time_s).collect();
    for (begin, end) in [(0.0, first), (second, second + 2.0 * short)] {
        let most = (end - begin) / 20.0 * (1.0 + 1e-6);
        let inside = |pair: &&[f64]| pair[0] >= begin && pair[1] <= end;
        let gaps: Vec<f64> = times
            .windows(2)
            .filter(inside)
            .map(|p| p[1] - p[0])
            .collect();
        assert!(
            gaps.len() >= 20 && gaps.iter().all(|gap| *gap <= most),
            "{gaps:?}"
        );
    }
}

#[test]
fn one_percent_of_torque_is_refused() {
    let mut flight = bang_bang();
    flight.controls[0].wheel_torque_nm[0] *= 0.99;
    let spec = scenario(vec![target("a", angle(HALF))]);
    let report = refused(&spec, &flight, "target 'a' is missed by");
    let rate = 0.01 * TORQUE / EFFECTIVE_X * HALF;
    assert!((report.verification.max_rate_error_rad_s - rate).abs() < 1e-12);
}

#[test]
fn slews_from_milliseconds_to_hours_pass() {
    for (half, inertia) in [(5e-4, 0.01), (1e-2, 4.0), (5000.0, 1e5)] {
        let ratio = inertia / 4.0;
        let mut spec = scenario(vec![target("a", 0.9)]);
        let torque = 0.9 * ratio * EFFECTIVE_X / (half * half);
        for row in &mut spec.spacecraft.inertia_kg_m2 {
            *row = row.map(|entry| ratio * entry);
        }
        for wheel in &mut spec.spacecraft.wheels {
            wheel.inertia_kg_m2 *= ratio;
            wheel.max_torque_nm = torque;
            wheel.max_speed_rad_s = None;
        }
        let flight = Flight {
            total_time_s: 2.0 * half,
            passages: vec![passage("a", 2.0 * half, 2.0 * half)],
            controls: vec![control(0.0, half, -torque), control(half, half, torque)],
        };
        let report = accepted(&spec, &flight);
        assert!(report.verification.max_attitude_error_rad < 1e-12);
    }
}

#[test]
fn rests_are_held_and_tested_throughout() {
    let stay = |torque: f64| Flight {
        total_time_s: 2.0 * HALF + 7.0,
        passages: vec![passage("a", 2.0 * HALF, 2.0 * HALF + 7.0)],
        controls: vec![
            control(0.0, HALF, -TORQUE),
            control(HALF, HALF, TORQUE),
            control(2.0 * HALF, 7.0, torque),
        ],
    };
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    spec.targets[0].dwell_s = 4.0;
    spec.targets[0].settle_s = 3.0;
    accepted(&spec, &stay(0.0));
    refused(&spec, &stay(1e-6), "held without torque");
    let early = Flight {
        passages: vec![passage("a", 2.0 * HALF - 1.0, 2.0 * HALF + 6.0)],
        ..stay(0.0)
    };
    refused(&spec, &early, "held without torque");
    refused(&spec, &early, "rate error");
    spec.targets[0].dwell_s = 5.0;
    refused(&spec, &stay(0.0), "stayed at for 7 s instead of 8 s");
    // The tolerance is relative to the larger of the two limits.
    spec.targets[0].dwell_s = 4.0;
    spec.spacecraft.wheels[0].max_torque_nm = 2.0 * TORQUE;
    spec.spacecraft.wheels[0].min_torque_nm = Some(-TORQUE);
    accepted(&spec, &stay(1.5e-9 * TORQUE));
    refused(&spec, &stay(2.5e-9 * TORQUE), "held without torque");
}

#[test]
fn settling_or_dwelling_requires_rest_even_with_free_rates() {
    // Coasting through the target.
    let flight = Flight {
        total_time_s: 2.0 * HALF,
        passages: vec![passage("a", HALF, 2.0 * HALF)],
        controls: vec![control(0.0, HALF, -TORQUE), control(HALF, HALF, 0.0)],
    };
    for (settle_s, dwell_s) in [(HALF, 0.0), (0.0, HALF), (0.5 * HALF, 0.5 * HALF)] {
        let mut spec = scenario(vec![target("a", 0.5 * angle(HALF))]);
        spec.targets[0].zero_rate_axes = Some([false; 3]);
        (spec.targets[0].settle_s, spec.targets[0].dwell_s) = (settle_s, dwell_s);
        refused(&spec, &flight, "rate error");
        spec.targets[0].zero_rate_axes = None;
        spec.targets[0].rate_min_rad_s = Some([Some(-1.0), None, None]);
        refused(&spec, &flight, "rate error");
    }
}

#[test]
fn a_rotation_is_reached_with_either_sign_and_a_quaternion_with_one() {
    // 4 rad about x: the continuous quaternion ends with w < 0.
    let half = (4.0 * EFFECTIVE_X / TORQUE).sqrt();
    let flight = Flight {
        total_time_s: 2.0 * half,
        passages: vec![passage("a", 2.0 * half, 2.0 * half)],
        controls: vec![control(0.0, half, -TORQUE), control(half, half, TORQUE)],
    };
    let mut spec = scenario(vec![target("a", 4.0)]);
    accepted(&spec, &flight);
    spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    let states = accepted(&spec, &flight).states;
    assert!(states.last().unwrap().attitude.xyzw()[3] < -0.4);

    spec.targets[0].attitude = about_x(4.0 - std::f64::consts::TAU);
    let error = refused(&spec, &flight, "missed by 6.28319 rad").verification;
    assert!((error.max_attitude_error_rad - std::f64::consts::TAU).abs() < 1e-9);
    spec.options.attitude_equivalence = AttitudeEquivalence::Rotation;
    accepted(&spec, &flight);
}

#[test]
fn a_target_may_be_passed_in_motion_within_its_bounds() {
    let rate = TORQUE / EFFECTIVE_X * HALF;
    let mut spec = scenario(vec![
        target("b", angle(HALF)),
        target("a", 0.5 * angle(HALF)),
    ]);
    let mut flight = bang_bang();
    flight.passages = vec![
        passage("a", HALF, HALF),
        passage("b", 2.0 * HALF, 2.0 * HALF),
    ];
    refused(&spec, &flight, "target 'a' is passed with a rate error");
    spec.targets[1].zero_rate_axes = Some([false, true, true]);
    accepted(&spec, &flight);
    spec.targets[1].zero_rate_axes = None;
    spec.targets[1].rate_min_rad_s = Some([Some(0.9 * rate), Some(0.0), Some(0.0)]);
    spec.targets[1].rate_max_rad_s = Some([Some(1.1 * rate), Some(0.0), Some(0.0)]);
    accepted(&spec, &flight);
    spec.targets[1].rate_min_rad_s = Some([Some(1.02 * rate), None, None]);
    let report = refused(&spec, &flight, "rate error");
    let error = report.verification.max_rate_error_rad_s;
    assert!((error - 0.02 * rate).abs() < 1e-12, "{error}");
}

#[test]
fn conditions_of_the_end_are_tested() {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    let mut flight = bang_bang();
    flight.total_time_s = 4.0 * HALF;
    flight.controls.push(control(2.0 * HALF, HALF, TORQUE));
    flight.controls.push(control(3.0 * HALF, HALF, -TORQUE));
    refused(&spec, &flight, "goes on for 20 s after the last target");
    spec.end = Some(StateSpec {
        wheel_speed_rad_s: Some(vec![0.0; 3]),
        ..StateSpec::default()
    });
    let report = accepted(&spec, &flight);
    assert!(report.end_wheel_speed_error.unwrap() < 1e-12);
    assert_eq!(report.margins.wheel_zero_crossings, [1, 0, 0]);
    flight.controls[3].wheel_torque_nm[0] *= 0.99;
    refused(&spec, &flight, "the end is missed by");
    refused(&spec, &flight, "the end leaves wheel 0 at");
}

#[test]
fn a_locked_wheel_keeps_its_speed_relative_to_the_body() {
    let mut spec = scenario(vec![target("a", angle(HALF))]);
    let mut locked = wheel([1.0, 0.0, 0.0]);
    locked.enabled = false;
    spec.spacecraft.wheels.push(locked);
    spec.start.wheel_speed_rad_s = Some(vec![0.0, 0.0, 0.0, 300.0]);
    let mut flight = bang_bang();
    for control in &mut flight.controls {
        control.wheel_torque_nm.push(0.0);
    }
    let report = accepted(&spec, &flight);
    let speeds = report.states.iter().map(|s| s.wheel_speed_rad_s[3]);
    assert!(speeds.into_iter().all(|speed| (speed - 300.0).abs() == 0.0));
    assert!(report.verification.max_attitude_error_rad < 1e-13);
    flight.controls[1].wheel_torque_nm[3] = 1e-12;
    refused(&spec, &flight, "drives wheel 3, which is disabled");
}

/// Four wheels in a pyramid with bias, and arbitrary torques.
fn biased(total_time_s: f64, intervals: u32) -> (ScenarioSpec, Flight) {
    let mut spec = scenario(vec![target("a", 0.0)]);
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    spec.spacecraft.wheels = corners.map(|[x, y]| wheel([x, y, 0.8])).into();
    spec.start.wheel_speed_rad_s = Some(vec![200.0; 4]);
    spec.targets[0].zero_rate_axes = Some([false; 3]);
    let length = total_time_s / f64::from(intervals);
    let sign = |bit: u32| {
        if bit == 0 {
            0.2 * TORQUE
        } else {
            -0.2 * TORQUE
        }
    };
    let controls = (0..intervals).map(|k| Control {
        start_s: length * f64::from(k),
        duration_s: length,
        wheel_torque_nm: vec![sign(k % 2), sign(k / 2 % 2), sign((k + 1) % 2), 0.0],
    });
    let flight = Flight {
        total_time_s,
        passages: vec![passage("a", total_time_s, total_time_s)],
        controls: controls.collect(),
    };
    (spec, flight)
}

#[test]
fn momentum_of_four_biased_wheels_is_conserved_and_a_changed_torque_fails() {
    let (mut spec, mut flight) = biased(60.0, 8);
    let first = report(&spec, &flight);
    assert!(first.momentum_drift < 1e-13, "{}", first.momentum_drift);
    assert!(first.momentum_drift > 0.0, "rounding is seen");
    let momentum = valid(&spec).momentum();
    let last = first.states.last().unwrap();
    let scenario = valid(&spec);
    let body = scenario
        .spacecraft()
        .body_momentum(last.body_rate_rad_s, &last.wheel_speed_rad_s);
    assert!((last.attitude.to_reference(body) - momentum).norm() < 1e-12);

    spec.targets[0].attitude = AttitudeSpec::Quaternion(last.attitude.xyzw());
    accepted(&spec, &flight);
    flight.controls[3].wheel_torque_nm[1] *= 1.01;
    refused(&spec, &flight, "target 'a' is missed by");
}

#[test]
fn a_long_flight_is_verified_without_loss_of_momentum() {
    let (spec, flight) = biased(500.0, 100);
    let scenario = valid(&spec);
    let before = Instant::now();
    let report = super::super::verify(&scenario, &flight);
    println!(
        "500 s, 100 intervals, {} steps: {:?}",
        report.steps,
        before.elapsed()
    );
    assert!(report.steps >= 100 && report.momentum_drift < 1e-12);
}
