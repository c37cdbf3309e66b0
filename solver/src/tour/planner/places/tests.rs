//! Places that cover each other, and scenarios whose tours are reversible.

use super::*;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::{ScenarioSpec, StateSpec, TargetSpec, WheelSpec};

/// Calls with the places of experiment A, cut to two targets without rate conditions and then
/// changed.
fn with<T>(change: impl FnOnce(&mut ScenarioSpec), ask: impl FnOnce(&Places<'_>) -> T) -> T {
    let mut spec = experiment_a();
    spec.targets.truncate(2);
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    change(&mut spec);
    let scenario = match Scenario::try_new(&spec) {
        Ok(valid) => valid.scenario,
        Err(problems) => panic!("{problems:?}"),
    };
    ask(&Places::of(&scenario))
}

fn is_symmetric(change: impl FnOnce(&mut ScenarioSpec)) -> bool {
    with(change, |places| {
        let symmetric = places.are_symmetric();
        assert!(!symmetric || places.scenario.end().is_some());
        symmetric
    })
}

/// Whether the first of two targets covers the second, and the second the first, with z rates
/// within the given bounds; both have one attitude unless they are `apart`.
fn covering(bounds: [[f64; 2]; 2], apart: bool) -> [bool; 2] {
    let (one, other) = (Place::Target(0), Place::Target(1));
    with(
        |spec| {
            let first = spec.targets[0].attitude.clone();
            for (target, [low, high]) in spec.targets.iter_mut().zip(bounds) {
                *target = TargetSpec {
                    rate_min_rad_s: Some([Some(0.0), Some(0.0), Some(low)]),
                    rate_max_rad_s: Some([Some(0.0), Some(0.0), Some(high)]),
                    ..target.clone()
                };
                if !apart {
                    target.attitude = first.clone();
                }
            }
        },
        |places| {
            let covers = [places.covers(one, other), places.covers(other, one)];
            let either = covers[0] || covers[1];
            assert_eq!(places.are_one_stop(one, other), either, "{bounds:?}");
            assert_eq!(places.are_one_stop(other, one), either, "{bounds:?}");
            covers
        },
    )
}

#[test]
fn the_stricter_of_two_equal_attitudes_covers_the_other() {
    assert_eq!(covering([[0.0, 0.0], [0.0, 0.0]], false), [true, true]);
    assert_eq!(covering([[0.0, 0.0], [-0.01, 0.01]], false), [true, false]);
    assert_eq!(
        covering([[-0.01, 0.01], [-0.01, 0.005]], false),
        [false, true]
    );
    assert_eq!(covering([[-0.01, 0.0], [0.0, 0.01]], false), [false, false]);
    assert_eq!(covering([[0.0, 0.0], [0.0, 0.0]], true), [false, false]);
}

#[test]
fn fixed_wheel_speeds_cover_free_ones_and_not_the_reverse() {
    let target = Place::Target(0);
    let at_the_start = |spec: &mut ScenarioSpec| {
        spec.targets[0].attitude = spec.start.attitude.clone();
    };
    let covers = |places: &Places<'_>| {
        [
            places.covers(Place::Start, target),
            places.covers(target, Place::Start),
        ]
    };
    assert_eq!(with(at_the_start, covers), [true, false]);
}

#[test]
fn tours_are_symmetric_only_if_ends_targets_order_and_momentum_are() {
    type Change = fn(&mut ScenarioSpec);
    assert!(is_symmetric(|_| {}));
    let changes: [(&str, Change); 6] = [
        ("no end", |s| s.end = None),
        ("another attitude", |s| {
            s.end = Some(StateSpec {
                attitude: s.targets[0].attitude.clone(),
                ..StateSpec::default()
            });
        }),
        ("a rate at the end", |s| {
            s.end = Some(StateSpec {
                body_rate_rad_s: Some([0.0, 1e-3, 0.0]),
                ..StateSpec::default()
            });
        }),
        ("a place in the order", |s| s.targets[1].position = Some(2)),
        ("momentum", |s| {
            s.start.wheel_speed_rad_s = Some(vec![10.0, 0.0, 0.0]);
        }),
        ("a window to one side", |s| {
            s.targets[1].rate_min_rad_s = Some([Some(0.0), Some(0.0), Some(-0.01)]);
            s.targets[1].rate_max_rad_s = Some([Some(0.0); 3]);
        }),
    ];
    for (what, change) in changes {
        assert!(!is_symmetric(change), "{what}");
    }
    // With four wheels the final speeds may differ from the initial ones, unless they are given.
    let fourth = |s: &mut ScenarioSpec| {
        s.spacecraft.wheels.push(WheelSpec {
            axis: [1.0, 1.0, 1.0],
            ..s.spacecraft.wheels[0].clone()
        });
    };
    assert!(!is_symmetric(fourth));
    let given = |s: &mut ScenarioSpec| {
        fourth(s);
        s.end = Some(StateSpec {
            wheel_speed_rad_s: Some(vec![0.0; 4]),
            ..StateSpec::default()
        });
    };
    assert!(is_symmetric(given));
}
