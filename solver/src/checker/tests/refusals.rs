//! Flights that do not belong to the scenario, each refused with a sentence.

use super::super::dynamics::Snapshot;
use super::super::integrator::Integration;
use super::super::visits::{Misses, Visit, inspect};
use super::super::{FlightObserver, MOMENTUM_TOLERANCE, NOT_COMPUTED};
use super::build::{
    HALF, TORQUE, accepted, angle, bang_bang, control, passage, refused, scenario, target, valid,
};
use crate::model::plan::Flight;
use crate::model::spec::{ScenarioSpec, StateSpec};

fn spec() -> ScenarioSpec {
    scenario(vec![target("a", angle(HALF))])
}

fn changed(change: impl FnOnce(&mut Flight)) -> Flight {
    let mut flight = bang_bang();
    change(&mut flight);
    flight
}

type Case = (fn(&mut Flight), &'static str);

#[test]
fn controls_that_cannot_be_propagated_are_refused_with_the_worst_values() {
    let cases: [Case; 11] = [
        (|f| f.controls[1].start_s += 0.01, "a gap of 0.01 s"),
        (|f| f.controls[0].duration_s += 0.5, "an overlap of 0.5 s"),
        (
            |f| f.controls[0].start_s = 1.0,
            "starts at 1 s where 0 s was reached",
        ),
        (
            |f| f.total_time_s += 1.0,
            "end at 20 s but the flight lasts 21 s",
        ),
        (
            |f| f.controls.clear(),
            "end at 0 s but the flight lasts 20 s",
        ),
        (
            |f| f.controls[1].duration_s = -1.0,
            "a negative duration of -1 s",
        ),
        (
            |f| f.controls[0].wheel_torque_nm.truncate(2),
            "2 torques for 3 wheels",
        ),
        (
            |f| f.controls[0].wheel_torque_nm[2] = f64::NAN,
            "wheel 2 that is not finite",
        ),
        (
            |f| f.controls[0].start_s = f64::INFINITY,
            "a time that is not finite",
        ),
        (|f| f.total_time_s = f64::NAN, "not a duration"),
        (|f| f.total_time_s = -1.0, "not a duration"),
    ];
    for (change, words) in cases {
        let report = refused(&spec(), &changed(change), words);
        assert!(report.verification.max_attitude_error_rad >= NOT_COMPUTED);
        assert!(report.margins.torque <= -NOT_COMPUTED);
        assert!(report.states.is_empty());
    }
}

#[test]
fn passages_that_do_not_match_the_targets_are_refused() {
    let end = 2.0 * HALF;
    let cases: [Case; 8] = [
        (|f| f.passages.clear(), "target 'a' is not visited"),
        (
            |f| f.passages[0].target = "z".to_owned(),
            "passage of 'z' belongs to no target",
        ),
        (
            |f| f.passages.push(f.passages[0].clone()),
            "target 'a' is visited 2 times",
        ),
        (
            |f| f.passages[0].time_s = f64::NAN,
            "time that is not finite",
        ),
        (
            |f| f.passages[0].departure_s += 1.0,
            "after the end of the flight",
        ),
        (
            |f| f.passages[0].time_s = -1.0,
            "is reached at -1 s, before",
        ),
        (
            |f| f.passages[0].time_s -= 1.0,
            "stayed at for 1 s instead of 0 s",
        ),
        (
            |f| {
                f.passages[0].time_s -= 1.0;
                f.passages[0].departure_s -= 1.0;
            },
            "goes on for 1 s after the last target",
        ),
    ];
    for (change, words) in cases {
        let report = refused(&spec(), &changed(change), words);
        assert!(
            report
                .states
                .last()
                .is_some_and(|s| (s.time_s - end).abs() == 0.0)
        );
    }
}

#[test]
fn targets_out_of_order_are_refused() {
    let spec = scenario(vec![target("a", angle(HALF)), target("b", angle(HALF))]);
    let mut flight = bang_bang();
    let end = flight.total_time_s;
    flight.passages.push(passage("b", end, end));
    accepted(&spec, &flight);
    flight.passages[1] = passage("b", HALF, HALF);
    refused(
        &spec,
        &flight,
        "target 'b' is reached at 10 s, before the departure",
    );
}

#[test]
fn a_target_at_a_wrong_position_is_refused_at_every_position() {
    let places = [HALF, 2.0 * HALF, 2.0 * HALF];
    let names = ["a", "b", "c"];
    for (index, place) in (0..3).flat_map(|index| (0..3).map(move |place| (index, place))) {
        let mut spec = scenario(vec![
            target("a", 0.5 * angle(HALF)),
            target("b", angle(HALF)),
            target("c", angle(HALF)),
        ]);
        spec.targets[0].zero_rate_axes = Some([false, true, true]);
        spec.targets[index].position = Some(place + 1);
        let mut flight = bang_bang();
        flight.passages = (0..3)
            .map(|i| passage(names[i], places[i], places[i]))
            .collect();
        if index == place {
            accepted(&spec, &flight);
        } else {
            refused(&spec, &flight, &format!("instead of {}", place + 1));
        }
    }
}

#[test]
fn a_target_left_before_it_is_reached_is_refused_and_tested() {
    let spec = scenario(vec![target("a", angle(HALF)), target("b", angle(HALF))]);
    let end = 2.0 * HALF;
    for early in [0.0, 1e-9, 1e-8] {
        let mut flight = bang_bang();
        flight.passages.push(passage("b", end, end));
        flight.passages[0] = passage("a", end, end - early);
        accepted(&spec, &flight);
        flight.passages[0] = passage("a", HALF, HALF - early);
        let report = refused(&spec, &flight, "target 'a' is missed by");
        assert!(report.verification.max_attitude_error_rad > 0.1);
    }
}

#[test]
fn a_stay_without_a_state_is_refused() {
    let scenario = valid(&spec());
    let visit = Visit {
        target: &scenario.targets()[0],
        arrival_s: 1.0,
        departure_s: 1.0,
    };
    let misses = inspect(&scenario, &[visit], &[]);
    assert!(misses.attitude_rad >= NOT_COMPUTED && misses.rate_rad_s >= NOT_COMPUTED);
    assert!(misses.failures[0].contains("target 'a' cannot be tested"));
}

#[test]
fn the_worst_final_wheel_speed_of_all_wheels_counts() {
    let mut spec = spec();
    spec.spacecraft.wheels[1].max_speed_rad_s = None;
    spec.end = Some(StateSpec {
        wheel_speed_rad_s: Some(vec![0.0; 3]),
        ..StateSpec::default()
    });
    let scenario = valid(&spec);
    for worst in 0..3 {
        let mut state = Snapshot::at_start(&scenario);
        state.wheel_speed[worst] = 0.8;
        state.wheel_speed[(worst + 1) % 3] = 1e-9;
        let misses = inspect(&scenario, &[], std::slice::from_ref(&state));
        // Relative to the wheel's limit; without one, to the fastest wheel.
        let expected = if worst == 1 { 1.0 } else { 0.8 / 400.0 };
        let found = misses.end_speed.expect("speeds are given");
        assert!((found - expected).abs() < 1e-8, "wheel {worst}: {found}");
        let told = misses.failures.iter();
        let named = told.filter(|f| f.contains(&format!("leaves wheel {worst} at")));
        assert_eq!(named.count(), 1, "{:?}", misses.failures);
    }
    let state = Snapshot::at_start(&scenario);
    let misses = inspect(&scenario, &[], &[state]);
    assert_eq!(misses.end_speed.map(f64::to_bits), Some(0));
}

#[test]
fn times_rounded_to_ten_digits_pass() {
    let third = HALF / 3.0;
    let text = |t: f64| format!("{t:.11}").parse::<f64>().unwrap();
    let mut flight = bang_bang();
    flight.controls = vec![
        control(0.0, text(third), -TORQUE),
        control(text(third), text(2.0 * third), -TORQUE),
        control(HALF, 0.0, TORQUE),
        control(text(HALF), HALF, TORQUE),
    ];
    accepted(&spec(), &flight);
}

#[test]
fn a_motion_that_overflows_is_refused() {
    let flight = changed(|f| f.controls[0].wheel_torque_nm = vec![1e305, 1e305, 1e305]);
    let report = refused(&spec(), &flight, "the integration");
    assert!(report.verification.max_rate_error_rad_s >= NOT_COMPUTED);
    let figures = report
        .states
        .iter()
        .flat_map(|s| s.wheel_speed_rad_s.clone());
    assert!(figures.into_iter().all(f64::is_finite));
}

#[test]
fn an_integration_that_loses_momentum_fails_the_verification() {
    let scenario = valid(&spec());
    for (share, passed) in [(0.5, true), (2.0, false)] {
        let integration = Integration {
            steps: 1,
            momentum_drift: share * MOMENTUM_TOLERANCE,
        };
        let verification = FlightObserver::new(&scenario, &[])
            .report(&scenario, 0.0, integration, &Misses::default(), Vec::new())
            .verification;
        assert_eq!(verification.passed, passed, "{verification:?}");
        let told = verification.failures.iter();
        assert_eq!(
            told.filter(|f| f.contains("lost momentum")).count(),
            usize::from(!passed)
        );
    }
}

#[test]
fn defects_beyond_ten_are_counted() {
    let flight = changed(|f| {
        f.controls = (0..40).map(|_| control(0.0, -1.0, 0.0)).collect();
    });
    let report = refused(&spec(), &flight, "30 more defects");
    assert!(report.verification.failures.len() < 15);
}

#[test]
fn excesses_and_margins_stay_finite_for_tiny_limits() {
    let mut spec = spec();
    for wheel in &mut spec.spacecraft.wheels {
        wheel.max_torque_nm = 1e-308;
        wheel.max_speed_rad_s = Some(1e-308);
    }
    spec.spacecraft.max_body_rate_norm_rad_s = Some(1e-308);
    let flight = changed(|f| {
        for control in &mut f.controls {
            control.wheel_torque_nm[0] *= 100.0;
        }
    });
    let report = refused(&spec, &flight, "N m is allowed");
    let (verification, margins) = (report.verification, report.margins);
    let figures = [
        verification.max_torque_excess,
        verification.max_wheel_speed_excess,
        verification.max_rate_excess,
        margins.torque,
        margins.wheel_speed.unwrap(),
        margins.body_rate.unwrap(),
    ];
    assert!(
        figures.iter().all(|figure| figure.is_finite()),
        "{figures:?}"
    );
    assert!(figures[0] > 1e300 && figures[3] < -1e300);
}

#[test]
fn visits_out_of_order_are_refused() {
    let mut spec = scenario(vec![target("a", angle(HALF)), target("b", angle(HALF))]);
    let mut flight = bang_bang();
    flight.passages.push(passage("b", 2.0 * HALF, 2.0 * HALF));
    accepted(&spec, &flight);
    spec.targets[0].position = Some(1);
    spec.targets[1].after = vec!["a".into()];
    accepted(&spec, &flight);
    flight.passages.reverse();
    refused(&spec, &flight, "'a' is visited at position 2 instead of 1");
    refused(&spec, &flight, "'b' is visited before 'a'");
}
