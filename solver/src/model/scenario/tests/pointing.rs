//! Targets and ends that point a boresight.

use super::*;
use crate::model::cone::Side;
use crate::model::spec::{BoresightChoice, CelestialBody, DirectionSpec, PointingSpec};
use nalgebra::Vector3;

fn pointing() -> PointingSpec {
    PointingSpec {
        boresight: BoresightChoice::Name("camera".into()),
        direction: None,
        ra_dec_deg: Some([120.0, -40.0]),
        ..PointingSpec::default()
    }
}

fn limited(low: f64, high: f64) -> PointingSpec {
    PointingSpec {
        roll_min_deg: Some(low),
        roll_max_deg: Some(high),
        ..pointing()
    }
}

fn with(pointing: PointingSpec) -> ScenarioSpec {
    let mut spec = valid();
    spec.targets[0].pointing = Some(pointing);
    spec
}

/// The first target of a valid scenario with this pointing.
fn target(pointing: PointingSpec) -> Target {
    let Validated { scenario, .. } = Scenario::try_new(&with(pointing)).expect("valid");
    scenario.targets[0].clone()
}

fn turned(roll: f64) -> Attitude {
    let spec = AttitudeSpec::RaDecRollDeg {
        angles: [120.0, -40.0, roll],
        boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
    };
    Attitude::try_new(&spec, AttitudeEquivalence::Rotation, "")
        .unwrap()
        .0
}

#[test]
fn roll_is_that_of_right_ascension_declination_and_roll() {
    let free = target(pointing());
    assert_eq!(free.attitude, turned(0.0));
    let roll = free.roll.expect("free");
    assert_eq!((roll.axis, roll.range), (Vector3::z(), None));
    for degrees in [-170.0_f64, -20.0, 35.0, 180.0] {
        let rolled = roll.rolled(&free.attitude, degrees.to_radians());
        assert!(rolled.angle_to(&turned(degrees)) < 1e-14);
        let told = free.pointing.as_ref().unwrap().roll_of(&turned(degrees));
        assert!((told.to_degrees() - degrees).abs() < 1e-9, "{told}");
    }
}

#[test]
fn a_direction_is_a_vector_angles_or_the_sun() {
    let (sine, cosine) = 40.0_f64.to_radians().sin_cos();
    let along = 120.0_f64.to_radians();
    let vector = Vector3::new(cosine * along.cos(), cosine * along.sin(), -sine) * 7.0;
    let forms = [
        DirectionSpec::Vector(vector.into()),
        DirectionSpec::RaDecDeg([120.0, -40.0]),
    ];
    for direction in forms {
        let spec = PointingSpec {
            direction: Some(direction),
            ra_dec_deg: None,
            ..pointing()
        };
        assert!(target(spec).attitude.angle_to(&turned(0.0)) < 1e-15);
    }
    let mut spec = with(PointingSpec {
        direction: Some(DirectionSpec::Body(CelestialBody::Sun)),
        ra_dec_deg: None,
        ..pointing()
    });
    spec.epoch = Some("2026-03-20T14:46:00Z".into());
    let sunward = Scenario::try_new(&spec).unwrap().scenario.targets[0].clone();
    let boresight = sunward.attitude.to_reference(Vector3::z());
    assert!(boresight.angle(&Vector3::x()).to_degrees() < 0.38);
}

#[test]
fn at_the_poles_a_vector_has_the_right_ascension_0() {
    for pole in [1.0, -1.0] {
        let boresight = BoresightChoice::Axis([1.0, 2.0, 0.5]);
        let spec = PointingSpec {
            boresight: boresight.clone(),
            direction: Some([0.0, 0.0, 3.0 * pole].into()),
            ra_dec_deg: None,
            ..pointing()
        };
        let level = AttitudeSpec::RaDecRollDeg {
            angles: [0.0, 90.0 * pole, 0.0],
            boresight,
        };
        let level = Attitude::try_new(&level, AttitudeEquivalence::Rotation, "")
            .unwrap()
            .0;
        assert!(target(spec).attitude.angle_to(&level) < 1e-14);
    }
}

#[test]
fn limits_leave_a_range_all_or_one_roll() {
    let range = |low, high| target(limited(low, high)).roll.expect("free").range;
    let degrees = |range: Option<[f64; 2]>| range.map(|range| range.map(f64::to_degrees));
    for (given, expected) in [
        ([-10.0, 20.0], [-10.0, 20.0]),
        ([170.0, 190.0], [-190.0, -170.0]),
        ([710.0, 740.0], [-10.0, 20.0]),
        ([0.0, 359.0], [0.0, 359.0]),
    ] {
        let [low, high] = degrees(range(given[0], given[1])).expect("limited");
        assert!((low - expected[0]).abs() + (high - expected[1]).abs() < 1e-9);
    }
    assert_eq!(range(-180.0, 180.0), None);
    assert_eq!(range(0.0, 1e300), None);
    for width in [0.0, 1e-4] {
        let single = target(limited(30.0, 30.0 + width));
        assert_eq!(single.roll, None);
        assert!(single.attitude.angle_to(&turned(30.0 + 0.5 * width)) < 1e-14);
        let told = single.pointing.as_ref().unwrap().roll_of(&single.attitude);
        assert!((told.to_degrees() - 30.0).abs() < 1e-4);
    }
}

#[test]
fn faults_of_pointings_are_found() {
    let rest = PointingSpec {
        direction: Some([0.0; 3].into()),
        ra_dec_deg: None,
        ..pointing()
    };
    let both = PointingSpec {
        direction: Some([1.0, 0.0, 0.0].into()),
        ..pointing()
    };
    let neither = PointingSpec {
        ra_dec_deg: None,
        ..pointing()
    };
    let named = |name: &str| PointingSpec {
        boresight: BoresightChoice::Name(name.into()),
        ..pointing()
    };
    let at = |angles| PointingSpec {
        ra_dec_deg: Some(angles),
        ..pointing()
    };
    let only = |roll_min_deg, roll_max_deg| PointingSpec {
        roll_min_deg,
        roll_max_deg,
        ..pointing()
    };
    let sunward = PointingSpec {
        direction: Some(DirectionSpec::Body(CelestialBody::Sun)),
        ra_dec_deg: None,
        ..pointing()
    };
    let table = [
        (rest, Code::ZeroDirection, "/direction"),
        (both, Code::ConflictingFields, "/direction"),
        (neither, Code::MissingField, "/direction"),
        (named("camara"), Code::UnknownReference, "/boresight"),
        (at([0.0, 91.0]), Code::OutOfRange, "/ra_dec_deg/1"),
        (at([f64::NAN, 0.0]), Code::NotFinite, "/ra_dec_deg/0"),
        (limited(20.0, 10.0), Code::EmptyRange, "/roll_min_deg"),
        (limited(f64::NAN, 1.0), Code::NotFinite, "/roll_min_deg"),
        (only(Some(1.0), None), Code::MissingField, "/roll_max_deg"),
        (only(None, Some(1.0)), Code::MissingField, "/roll_min_deg"),
        (sunward, Code::EpochRequired, "/direction"),
    ];
    for (pointing, code, pointer) in table {
        let problems = Scenario::try_new(&with(pointing)).expect_err(pointer);
        let found: Vec<_> = problems
            .iter()
            .map(|p| (p.code, p.pointer.as_str()))
            .collect();
        assert_eq!(
            found,
            [(code, format!("/targets/0/pointing{pointer}").as_str())]
        );
    }
    expect_faults(&[
        (
            |s| {
                s.targets[0].pointing = Some(PointingSpec::default());
                s.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
            },
            Code::SignUndefined,
            "/targets/0/pointing",
        ),
        (
            |s| s.start.pointing = Some(limited(10.0, 20.0)),
            Code::ConflictingFields,
            "/start/pointing",
        ),
    ]);
}

#[test]
fn every_fault_of_a_pointing_is_found_at_once() {
    let mut spec = with(PointingSpec {
        boresight: BoresightChoice::Name("camara".into()),
        ..limited(20.0, 10.0)
    });
    end(&mut spec).pointing = Some(PointingSpec {
        ra_dec_deg: None,
        direction: None,
        ..pointing()
    });
    let problems = Scenario::try_new(&spec).unwrap_err();
    let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    let expected = [
        "/end/pointing/direction",
        "/targets/0/pointing/boresight",
        "/targets/0/pointing/roll_min_deg",
    ];
    assert_eq!(pointers, expected);
    assert!(
        problems[1].hint.contains("\"camera\""),
        "{}",
        problems[1].hint
    );
}

#[test]
fn wheel_speeds_at_an_end_with_momentum_fix_its_roll() {
    let mut spec = valid();
    spec.start.wheel_speed_rad_s = Some(vec![20.0, 0.0, 0.0]);
    // Along body X at the start: the axis that is pointed there again, so that no roll turns it.
    let momentum = spec.start.clone();
    *end(&mut spec) = StateSpec {
        pointing: Some(PointingSpec::default()),
        wheel_speed_rad_s: momentum.wheel_speed_rad_s,
        ..StateSpec::default()
    };
    spec.start.attitude = AttitudeSpec::default();
    assert!(Scenario::try_new(&spec).is_ok());
    end(&mut spec).pointing = Some(PointingSpec {
        boresight: BoresightChoice::Axis([0.0, 0.0, 1.0]),
        direction: Some([0.0, 0.0, 1.0].into()),
        ..PointingSpec::default()
    });
    let problems = Scenario::try_new(&spec).unwrap_err();
    assert_eq!(problems[0].code, Code::EndMomentumInconsistent);
    assert_eq!(problems[0].pointer, "/end/wheel_speed_rad_s");
    end(&mut spec).wheel_speed_rad_s = None;
    assert!(Scenario::try_new(&spec).is_ok());
}

/// A camera at body X that is pointed to +X, and a panel at body Z.
fn rolled(roll: [Option<f64>; 2], cones: &[(Side, [f64; 3], f64)]) -> Scenario {
    let [roll_min_deg, roll_max_deg] = roll;
    let mut spec = with(PointingSpec {
        roll_min_deg,
        roll_max_deg,
        ..PointingSpec::default()
    });
    spec.spacecraft.boresights.push(BoresightSpec {
        name: "panel".into(),
        axis: [0.0, 0.0, 1.0],
    });
    spec.keep_out.clear();
    for (side, direction, half_angle_deg) in cones {
        let list = match side {
            Side::Out => &mut spec.keep_out,
            Side::In => &mut spec.keep_in,
        };
        list.push(ConeSpec {
            boresight: "panel".into(),
            direction: (*direction).into(),
            half_angle_deg: *half_angle_deg,
            applies: Applies::AtTargets,
        });
    }
    spec.targets.truncate(1);
    Scenario::try_new(&spec).expect("valid").scenario
}

#[test]
fn cones_are_a_conflict_only_where_they_leave_no_roll() {
    let sun = [0.0, 1.0, 0.0];
    let free = [None; 2];
    let within = |low, high| [Some(low), Some(high)];
    let cases: [(_, &[_], Option<&str>); 7] = [
        // The panel reaches the Sun at a roll of -90 degrees.
        (free, &[(Side::In, sun, 10.0)], None),
        (within(-100.0, -80.0), &[(Side::In, sun, 10.0)], None),
        (
            within(-70.0, 20.0),
            &[(Side::In, sun, 10.0)],
            Some("at least 10.000"),
        ),
        // 30 degrees off the panel's plane.
        (free, &[(Side::In, [0.5, 0.75_f64.sqrt(), 0.0], 31.0)], None),
        (
            free,
            &[(Side::In, [0.5, 0.75_f64.sqrt(), 0.0], 29.0)],
            Some("at least 1.000"),
        ),
        // Each leaves some, together none.
        (
            free,
            &[(Side::In, sun, 10.0), (Side::Out, [0.0, 1.0, 0.1], 20.0)],
            Some("one of /keep_out/0, /keep_in/0"),
        ),
        (
            free,
            &[(Side::In, sun, 10.0), (Side::Out, [0.0, 1.0, 0.1], 5.0)],
            None,
        ),
    ];
    for (roll, cones, expected) in cases {
        let problems = cone_problems(&rolled(roll, cones));
        let Some(words) = expected else {
            assert_eq!(problems, [], "{roll:?} {cones:?}");
            continue;
        };
        assert_eq!(problems.len(), 1, "{roll:?} {cones:?} {problems:?}");
        assert_eq!(problems[0].code, Code::NoRollLeft);
        assert_eq!(problems[0].pointer, "/targets/0/pointing");
        assert!(
            problems[0]
                .message
                .contains("limits and cones leave no roll")
        );
        assert!(
            problems[0].message.contains(words),
            "{}",
            problems[0].message
        );
    }
}

#[test]
fn a_reported_cone_is_warned_of_where_every_roll_violates_it() {
    for (half_angle_deg, warned) in [(100.0, true), (80.0, false)] {
        let mut spec = with(PointingSpec {
            boresight: BoresightChoice::Axis([1.0, 0.0, 0.0]),
            ..PointingSpec::default()
        });
        spec.targets.truncate(1);
        // The camera at body Z turns across the axis of the cone.
        spec.keep_out[0].half_angle_deg = half_angle_deg;
        // The start points the camera elsewhere.
        spec.start.attitude = AttitudeSpec::RollPitchYawDeg([0.0, -90.0, 0.0]);
        let warnings = Scenario::try_new(&spec).unwrap().warnings;
        let found = warnings
            .iter()
            .any(|w| w.code == Code::AttitudeInKeepOut && w.pointer == "/targets/0");
        assert_eq!(found, warned, "{warnings:?}");
    }
}
