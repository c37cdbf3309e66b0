//! Cones that are enforced: along the whole flight, or at targets.

use super::super::cones::stays;
use super::super::visits::Visit;
use super::build::{
    EFFECTIVE_X, HALF, TORQUE, accepted, angle, bang_bang, control, passage, refused, target, valid,
};
use super::cones::with_cone;
use crate::model::cone::Applies;
use crate::model::plan::Flight;
use crate::model::spec::{DirectionSpec, ScenarioSpec};
use std::f64::consts::PI;

fn enforced(mut spec: ScenarioSpec, applies: Applies) -> ScenarioSpec {
    spec.keep_out[0].applies = applies;
    spec
}

/// The same with its keep-out cone as the keep-in cone of the opposite direction.
fn turned_round(mut spec: ScenarioSpec) -> ScenarioSpec {
    let mut cone = spec.keep_out.remove(0);
    let DirectionSpec::Vector(direction) = cone.direction else {
        panic!("the cones of these tests have vectors");
    };
    cone.direction = direction.map(|component| -component).into();
    cone.half_angle_deg = 180.0 - cone.half_angle_deg;
    spec.keep_in.push(cone);
    spec
}

#[test]
fn an_enforced_cone_that_is_entered_fails_with_times_and_depth() {
    let spec = enforced(with_cone(0.15, 0.0, 0.05_f64.to_degrees()), Applies::Always);
    let report = refused(&spec, &bang_bang(), "/keep_out/0: ");
    assert!(report.keep_out.is_empty(), "{:?}", report.keep_out);
    assert_eq!(report.margins.keep_out_intrusions.len(), 1);
    let [failure] = &report.verification.failures[..] else {
        panic!("{:?}", report.verification.failures);
    };
    let time_of = |turned: f64| (2.0 * turned * EFFECTIVE_X / TORQUE).sqrt();
    let figure = crate::checker::number_format::figure;
    let expected = format!(
        "/keep_out/0: boresight 'camera' is inside the keep-out cone of {} degrees by up to {} \
         degrees: {} s to {} s",
        figure(0.05_f64.to_degrees()),
        figure(0.05_f64.to_degrees()),
        figure(time_of(0.10)),
        figure(time_of(0.20))
    );
    assert_eq!(*failure, expected);
}

#[test]
fn cones_grazed_by_less_than_a_microradian_are_kept() {
    let half_angle = 0.05_f64;
    for turn in [false, true] {
        let grazed = |depth: f64| {
            let spec = with_cone(0.15, half_angle - depth, half_angle.to_degrees());
            let spec = enforced(spec, Applies::Always);
            if turn { turned_round(spec) } else { spec }
        };
        for kept in [-1e-5, -1e-7, 0.5e-6] {
            let report = accepted(&grazed(kept), &bang_bang());
            let nearest = report.margins.keep_out_clearance_deg[0].clearance_deg;
            let off = nearest.to_radians() + kept;
            assert!(off.abs() < 1e-11, "{kept}: {off}");
        }
        for entered in [2e-6, 1e-5] {
            let report = refused(&grazed(entered), &bang_bang(), "boresight 'camera' is");
            let depth = report.margins.keep_out_intrusions[0].depth_rad;
            assert!((depth - entered).abs() < 1e-11, "{entered}: {depth}");
        }
    }
}

#[test]
fn a_boresight_that_leaves_a_keep_in_cone_is_named() {
    let spec = turned_round(enforced(
        with_cone(0.15, 0.0, 0.05_f64.to_degrees()),
        Applies::Always,
    ));
    let words = "/keep_in/0: boresight 'camera' is outside the keep-in cone of 177.135 degrees";
    let report = refused(&spec, &bang_bang(), words);
    let intrusion = &report.margins.keep_out_intrusions[0];
    assert_eq!(intrusion.cone, "/keep_in/0");
    let entered = (2.0 * 0.10 * EFFECTIVE_X / TORQUE).sqrt();
    assert!((intrusion.from_s - entered).abs() < 1e-7, "{intrusion:?}");

    // Around the start: left for good, and just not.
    let around = |half_angle: f64| {
        let mut spec = turned_round(with_cone(0.0, 0.0, 1.0));
        spec.keep_in[0].direction = [0.0, 0.0, 1.0].into();
        spec.keep_in[0].half_angle_deg = half_angle.to_degrees();
        spec.keep_in[0].applies = Applies::Always;
        spec
    };
    let report = accepted(&around(angle(HALF) - 0.5e-6), &bang_bang());
    let nearest = &report.margins.keep_out_clearance_deg[0];
    assert!((nearest.clearance_deg.to_radians() + 0.5e-6).abs() < 1e-11);
    assert!((nearest.time_s - 2.0 * HALF).abs() < 1e-9, "{nearest:?}");
    let report = refused(&around(0.3), &bang_bang(), "outside the keep-in cone");
    let depth = report.margins.keep_out_intrusions[0].depth_rad;
    assert!((depth - (angle(HALF) - 0.3)).abs() < 1e-11, "{depth}");
    accepted(&around(PI - 1e-3), &bang_bang());
}

#[test]
fn at_targets_a_slew_may_pass_through_a_cone() {
    let spec = with_cone(0.15, 0.0, 0.05_f64.to_degrees());
    let report = accepted(&enforced(spec, Applies::AtTargets), &bang_bang());
    assert!(report.margins.keep_out_intrusions.is_empty());
    // At the target, which is farther away than any part of the slew.
    let nearest = &report.margins.keep_out_clearance_deg[0];
    let expected = angle(HALF) - 0.15 - 0.05;
    assert!((nearest.clearance_deg.to_radians() - expected).abs() < 1e-9);
    assert!((nearest.time_s - 2.0 * HALF).abs() < 1e-9, "{nearest:?}");
}

#[test]
fn at_targets_a_stay_inside_a_cone_fails_from_arrival_to_departure() {
    let mut spec = enforced(
        with_cone(angle(HALF), 0.0, 0.1_f64.to_degrees()),
        Applies::AtTargets,
    );
    spec.targets[0].dwell_s = 5.0;
    let arrival = 2.0 * HALF;
    let mut flight = bang_bang();
    flight.total_time_s = arrival + 5.0;
    flight.passages = vec![passage("a", arrival, arrival + 5.0)];
    flight.controls.push(control(arrival, 5.0, 0.0));
    let report = refused(&spec, &flight, "at targets by up to 5.72958 degrees");
    let [intrusion] = &report.margins.keep_out_intrusions[..] else {
        panic!("{:?}", report.margins.keep_out_intrusions);
    };
    assert!((intrusion.from_s - arrival).abs() < 1e-9, "{intrusion:?}");
    assert!((intrusion.to_s - arrival - 5.0).abs() < 1e-9);
    assert!((intrusion.depth_rad - 0.1).abs() < 1e-9);
}

#[test]
fn at_targets_a_passage_in_flight_is_a_moment_and_the_start_is_none() {
    // A target passed at a time between the control boundaries, after a quarter of the flight.
    let time = 0.5 * HALF;
    let turned = 0.5 * TORQUE / EFFECTIVE_X * time * time;
    let through = |along: f64| {
        let mut spec = with_cone(along, 0.0, 0.01_f64.to_degrees());
        let mut passed = target("p", turned);
        passed.zero_rate_axes = Some([false, true, true]);
        spec.targets.insert(0, passed);
        enforced(spec, Applies::AtTargets)
    };
    let mut flight = bang_bang();
    flight.passages.insert(0, passage("p", time, time));
    accepted(&through(0.0), &flight);
    let report = refused(&through(turned + 0.004), &flight, "at targets");
    let [intrusion] = &report.margins.keep_out_intrusions[..] else {
        panic!("{:?}", report.margins.keep_out_intrusions);
    };
    assert!((intrusion.from_s - time).abs() < 1e-9, "{intrusion:?}");
    assert!((intrusion.to_s - time).abs() < 1e-9, "{intrusion:?}");
    assert!((intrusion.depth_rad - 0.006).abs() < 1e-9, "{intrusion:?}");
}

#[test]
fn a_cone_that_never_applies_has_no_clearance() {
    let mut spec = enforced(with_cone(0.15, 0.0, 5.0), Applies::AtTargets);
    spec.targets.clear();
    spec.end = Some(crate::model::spec::StateSpec {
        attitude: super::build::about_x(angle(HALF)),
        ..Default::default()
    });
    let flight = Flight {
        passages: Vec::new(),
        ..bang_bang()
    };
    let report = accepted(&spec, &flight);
    assert!(report.margins.keep_out_clearance_deg.is_empty());
}

#[test]
fn stays_of_foreign_flights_that_overlap_are_one() {
    let scenario = valid(&with_cone(0.15, 0.0, 5.0));
    let visit = |arrival_s: f64, departure_s: f64| Visit {
        target: &scenario.targets()[0],
        arrival_s,
        departure_s,
    };
    let visits = [
        visit(7.0, 8.0),
        visit(1.0, 4.0),
        visit(2.0, 3.0),
        visit(4.0, 5.0),
    ];
    assert_eq!(stays(&visits), [[1.0, 5.0], [7.0, 8.0]]);
}
