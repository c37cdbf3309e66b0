//! Cones: their directions, when they apply, and attitudes that violate them.

use super::*;
use crate::model::cone::{Cone, Side};
use crate::model::spec::{CelestialBody, ConeSpec, DirectionSpec};
use nalgebra::Vector3;

fn cones(spec: &ScenarioSpec) -> Vec<Cone> {
    Scenario::try_new(spec)
        .expect("valid")
        .scenario
        .cones()
        .to_vec()
}

fn sun() -> DirectionSpec {
    DirectionSpec::Body(CelestialBody::Sun)
}

#[test]
fn both_lists_become_cones_with_their_pointers() {
    let mut spec = valid();
    spec.keep_in = vec![
        ConeSpec {
            applies: Applies::Always,
            ..spec.keep_out[0].clone()
        },
        ConeSpec {
            direction: DirectionSpec::RaDecDeg([450.0, 30.0]),
            applies: Applies::AtTargets,
            ..spec.keep_out[0].clone()
        },
    ];
    let found = cones(&spec);
    let named: Vec<_> = found
        .iter()
        .map(|cone| (cone.pointer(), cone.side, cone.applies))
        .collect();
    let expected = [
        ("/keep_out/0".to_owned(), Side::Out, Applies::Report),
        ("/keep_in/0".to_owned(), Side::In, Applies::Always),
        ("/keep_in/1".to_owned(), Side::In, Applies::AtTargets),
    ];
    assert_eq!(named, expected);
    let expected = Vector3::new(0.0, 0.75_f64.sqrt(), 0.5);
    assert!((found[2].direction - expected).norm() < 1e-15);
}

#[test]
fn the_sun_stands_where_the_epoch_says() {
    let mut spec = valid();
    spec.keep_out[0].direction = sun();
    spec.epoch = Some("2026-03-20T14:46:00Z".to_owned());
    for frame in [None, Some(ReferenceFrame::Gcrf)] {
        spec.reference_frame = frame;
        let direction = cones(&spec)[0].direction;
        // Equinox: on the equator of date, 0.37 degrees from that of J2000.
        assert!(direction.angle(&Vector3::x()).to_degrees() < 0.38);
    }
    let found = |time_system| {
        let mut spec = spec.clone();
        spec.time_system = time_system;
        cones(&spec)[0].direction
    };
    let moved = (found(None) - found(Some(TimeSystem::Tt))).norm();
    // 69 s of a circle a year.
    assert!((moved - 1.38e-5).abs() < 0.1e-5, "{moved}");
}

#[test]
fn faults_of_directions_are_found() {
    expect_faults(&[
        (
            |s| s.keep_out[0].direction = sun(),
            Code::EpochRequired,
            "/keep_out/0/direction",
        ),
        (
            |s| {
                s.keep_out[0].direction = sun();
                s.epoch = Some("soon".to_owned());
            },
            Code::InvalidEpoch,
            "/epoch",
        ),
        (
            |s| {
                s.keep_out[0].direction = sun();
                s.epoch = Some("2026-01-01T00:00:00".to_owned());
                s.reference_frame = Some(ReferenceFrame::TodEarth);
            },
            Code::ConflictingFields,
            "/keep_out/0/direction",
        ),
        (
            |s| {
                s.keep_out[0].direction = sun();
                s.epoch = Some("2300-01-01T00:00:00".to_owned());
            },
            Code::OutOfRange,
            "/keep_out/0/direction",
        ),
        (
            |s| s.keep_out[0].direction = DirectionSpec::RaDecDeg([10.0, 90.5]),
            Code::OutOfRange,
            "/keep_out/0/direction/ra_dec_deg/1",
        ),
        (
            |s| s.keep_out[0].direction = DirectionSpec::RaDecDeg([f64::INFINITY, 0.0]),
            Code::NotFinite,
            "/keep_out/0/direction/ra_dec_deg/0",
        ),
        (
            |s| {
                s.keep_in = s.keep_out.clone();
                s.keep_in[0].half_angle_deg = 0.0;
            },
            Code::OutOfRange,
            "/keep_in/0/half_angle_deg",
        ),
        (
            |s| {
                s.keep_in = vec![s.keep_out[0].clone(); 500];
                s.keep_out = vec![s.keep_out[0].clone(); 501];
            },
            Code::WrongLength,
            "/keep_in",
        ),
    ]);
    let mut spec = valid();
    spec.keep_in = vec![spec.keep_out[0].clone(); 500];
    spec.keep_out = vec![spec.keep_out[0].clone(); 500];
    assert_eq!(cones(&spec).len(), 1000);
}

/// Codes and pointers of the problems with attitudes, and of the warnings.
fn conflicts(spec: &ScenarioSpec) -> [Vec<(Code, String)>; 2] {
    let found = Scenario::try_new(spec).expect("valid");
    let problems = cone_problems(&found.scenario);
    [problems, found.warnings].map(|list| list.into_iter().map(|p| (p.code, p.pointer)).collect())
}

#[test]
fn attitudes_that_violate_an_enforced_cone_are_problems() {
    let mut spec = valid();
    let inside = AttitudeSpec::RollPitchYawDeg([0.0, 90.0, 0.0]);
    spec.targets[1].attitude = inside.clone();
    let at_target = |code| vec![(code, "/targets/1".to_owned())];
    let none = Vec::new;
    assert_eq!(
        conflicts(&spec),
        [none(), at_target(Code::AttitudeInKeepOut)]
    );
    for applies in [Applies::Always, Applies::AtTargets] {
        spec.keep_out[0].applies = applies;
        assert_eq!(
            conflicts(&spec),
            [at_target(Code::AttitudeViolatesCone), none()]
        );
    }
    // At start and end a cone at targets does not apply.
    spec.start.attitude = inside.clone();
    end(&mut spec).attitude = inside;
    assert_eq!(conflicts(&spec)[0].len(), 1);
    spec.keep_out[0].applies = Applies::Always;
    let pointers: Vec<_> = conflicts(&spec)[0].iter().map(|p| p.1.clone()).collect();
    assert_eq!(pointers, ["/start", "/end", "/targets/1"]);
}

#[test]
fn an_attitude_outside_a_keep_in_cone_is_a_problem() {
    let mut spec = valid();
    let mut panel = spec.keep_out.remove(0);
    panel.direction = [0.0, 0.0, 1.0].into();
    panel.applies = Applies::Always;
    panel.half_angle_deg = 60.0;
    spec.keep_in.push(panel);
    spec.targets[2].attitude = AttitudeSpec::RollPitchYawDeg([0.0, 61.0, 0.0]);
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let problems = cone_problems(&scenario);
    assert_eq!(problems.len(), 1, "{problems:?}");
    let expected = "target \"c\" points boresight 'camera' 1.000 degrees out of the keep-in cone of \
                    60 degrees (/keep_in/0)";
    assert_eq!(problems[0].message, expected);
}

#[test]
fn an_attitude_on_the_surface_of_a_cone_is_none() {
    let mut spec = valid();
    spec.keep_out[0].applies = Applies::Always;
    let at = |spec: &mut ScenarioSpec, inside: f64| {
        let pitch = 60.0 + inside.to_degrees();
        spec.targets[1].attitude = AttitudeSpec::RollPitchYawDeg([0.0, pitch, 0.0]);
        conflicts(spec)[0].len()
    };
    assert_eq!(at(&mut spec, 0.9e-6), 0);
    assert_eq!(at(&mut spec, 1.1e-6), 1);
}
