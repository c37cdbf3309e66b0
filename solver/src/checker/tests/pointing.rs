//! Targets and ends that point a boresight and leave the roll free.

use super::super::dynamics::Snapshot;
use super::super::visits::{Visit, inspect};
use super::build::{HALF, accepted, angle, bang_bang, refused, scenario, target, valid};
use crate::model::attitude::Attitude;
use crate::model::plan::Flight;
use crate::model::scenario::Scenario;
use crate::model::spec::{
    BoresightChoice, DirectionSpec, PointingSpec, ScenarioSpec, StateSpec, TargetSpec,
};
use nalgebra::Vector3;

/// Body X is pointed to a direction: along +X of the reference frame at every roll of the slews about X.
fn along_x(direction: [f64; 3], limits: Option<[f64; 2]>) -> PointingSpec {
    PointingSpec {
        boresight: BoresightChoice::Axis([1.0, 0.0, 0.0]),
        direction: Some(DirectionSpec::Vector(direction)),
        ra_dec_deg: None,
        roll_min_deg: limits.map(|[low, _]| low),
        roll_max_deg: limits.map(|[_, high]| high),
    }
}

fn to_star(pointing: PointingSpec) -> ScenarioSpec {
    scenario(vec![TargetSpec {
        pointing: Some(pointing),
        ..target("a", 0.0)
    }])
}

const X: [f64; 3] = [1.0, 0.0, 0.0];

#[test]
fn any_roll_of_a_pointed_boresight_is_accepted() {
    let spec = to_star(along_x(X, None));
    let report = accepted(&spec, &bang_bang());
    assert!(report.verification.max_attitude_error_rad < 1e-13);
}

#[test]
fn a_boresight_off_by_more_than_the_tolerance_is_refused() {
    // Perpendicular to the slew, so that no roll helps.
    for (off, fits) in [
        (0.9e-6, true),
        (1.1e-6, false),
        (-0.9e-6, true),
        (-1.1e-6, false),
    ] {
        for direction in [[1.0, off, 0.0], [1.0, 0.0, off]] {
            let spec = to_star(along_x(direction, None));
            let report = if fits {
                accepted(&spec, &bang_bang())
            } else {
                refused(&spec, &bang_bang(), "target 'a' is missed by")
            };
            let error = report.verification.max_attitude_error_rad;
            assert!((error - off.abs()).abs() < 1e-12, "{error}");
        }
    }
    refused(
        &to_star(along_x([-1.0, 0.0, 0.0], None)),
        &bang_bang(),
        "missed by",
    );
}

#[test]
fn a_roll_is_tested_against_its_limits() {
    let flown = angle(HALF).to_degrees();
    let slack = 1e-6_f64.to_degrees();
    let cases = [
        ([flown - 5.0, flown + 5.0], true),
        ([flown, flown + 10.0], true),
        ([flown + 355.0, flown + 365.0], true),
        ([flown - 20.0, flown - 0.9 * slack], true),
        ([flown - 20.0, flown - 1.1 * slack], false),
        ([flown + 0.9 * slack, flown + 200.0], true),
        ([flown + 1.1 * slack, flown + 200.0], false),
        ([flown + 1.0, flown + 359.0], false),
        // A single roll is an attitude.
        ([flown, flown], true),
    ];
    for (limits, fits) in cases {
        let spec = to_star(along_x(X, Some(limits)));
        if fits {
            accepted(&spec, &bang_bang());
        } else {
            refused(&spec, &bang_bang(), "outside the limits of its roll");
        }
    }
    let single = to_star(along_x(X, Some([flown + 1.0; 2])));
    refused(&single, &bang_bang(), "missed by");
}

#[test]
fn an_end_is_tested_like_a_target() {
    let at_end = |pointing| {
        let mut spec = scenario(Vec::new());
        spec.end = Some(StateSpec {
            pointing: Some(pointing),
            ..StateSpec::default()
        });
        spec
    };
    let flight = Flight {
        passages: Vec::new(),
        ..bang_bang()
    };
    let flown = angle(HALF).to_degrees();
    accepted(&at_end(along_x(X, None)), &flight);
    accepted(
        &at_end(along_x(X, Some([flown - 1.0, flown + 1.0]))),
        &flight,
    );
    refused(
        &at_end(along_x([1.0, 1e-5, 0.0], None)),
        &flight,
        "the end is missed by",
    );
    let outside = at_end(along_x(X, Some([flown + 1.0, flown + 2.0])));
    refused(&outside, &flight, "the end is passed 1.7");
}

/// What the checker says of an attitude at a target that is pointed in any direction.
fn failures(scenario: &Scenario, attitude: &Attitude, sign: f64) -> Vec<String> {
    let visit = Visit {
        target: &scenario.targets()[0],
        arrival_s: 1.0,
        departure_s: 1.0,
    };
    let state = Snapshot {
        time_s: 1.0,
        quaternion: attitude.xyzw().map(|component| sign * component),
        rate: Vector3::zeros(),
        wheel_speed: vec![0.0; 3],
    };
    inspect(scenario, &[visit], &[state]).failures
}

#[test]
fn attitudes_made_by_hand_are_accepted_at_admissible_rolls_only() {
    for (boresight, direction) in [
        ([0.3, -0.5, 0.8], [0.2, 0.9, -0.4]),
        ([0.0, 0.0, -1.0], [-0.6, 0.1, 0.7]),
        ([-1.0, 0.4, 0.0], [0.0, 0.0, 1.0]),
    ] {
        let spec = to_star(PointingSpec {
            boresight: BoresightChoice::Axis(boresight),
            ..along_x(direction, Some([100.0, 250.0]))
        });
        let scenario = valid(&spec);
        let axis = Vector3::from(boresight).normalize();
        let level = scenario.targets()[0].attitude;
        for degrees in (-180..540).step_by(10) {
            let rolled = level.retract(axis * f64::from(degrees).to_radians());
            let off = axis.cross(&Vector3::new(0.3, 0.2, 0.9)).normalize() * 2e-6;
            let is_admissible = (100..=250).contains(&degrees.rem_euclid(360));
            for sign in [1.0, -1.0] {
                let found = failures(&scenario, &rolled, sign);
                assert_eq!(found.is_empty(), is_admissible, "{degrees} {found:?}");
                assert!(!failures(&scenario, &rolled.retract(off), sign).is_empty());
            }
        }
    }
}
