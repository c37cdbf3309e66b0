//! Legs between states of one attitude: rates or wheel speeds change and the attitude returns, or the leg
//! has length zero.

use slewplan_solver::model::plan::Outcome;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, StateSpec, TargetSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, Shard};
use slewplan_tests::solving::{agree, on_threads, outcome_of, plan_of, scenario_of};
use slewplan_tests::{experiment_a_spec, pyramid_spec, target};

const TUMBLING: [f64; 3] = [0.002, -0.003, 0.004];
/// Wheel speeds of the published spacecraft that store momentum, rad/s.
const STORED: [f64; 3] = [120.0, -80.0, 100.0];

/// The published spacecraft without targets and end; with stored momentum or without.
fn published(momentum: bool) -> ScenarioSpec {
    let mut spec = experiment_a_spec();
    spec.targets.clear();
    spec.end = None;
    spec.start.wheel_speed_rad_s = momentum.then(|| STORED.to_vec());
    spec
}

/// A target at the attitude of the start, with fixed or free rate components.
fn here(id: &str, rates: [Option<f64>; 3]) -> TargetSpec {
    TargetSpec {
        rate_min_rad_s: Some(rates),
        rate_max_rad_s: Some(rates),
        ..target(id, [0.0; 3])
    }
}

/// Total time, s, of a scenario of which a plan is expected.
fn time_of(name: &str, spec: &ScenarioSpec) -> f64 {
    match outcome_of(spec) {
        Outcome::Planned(plan) if plan.verification.passed => plan.total_time_s,
        outcome => panic!("{name}: {outcome:?}"),
    }
}

/// Braking from a rate `w` turns by `w² / 2a`, which a bang-bang turn takes back.
#[test]
fn a_tumbling_spacecraft_returns_to_its_initial_attitude() {
    for momentum in [false, true] {
        for as_target in [false, true] {
            let mut spec = published(momentum);
            if as_target {
                spec.targets = vec![target("here", [0.0; 3])];
            } else {
                spec.end = Some(StateSpec::default());
            }
            let name = format!("momentum {momentum}, target {as_target}");
            spec.start.body_rate_rad_s = Some(TUMBLING);
            time_of(&name, &spec);
            spec.start.body_rate_rad_s = Some([0.0, 0.0, 0.004]);
            let time = time_of(&name, &spec);
            let braking = 0.004 * (9.63 - 0.000_169) / 0.0101;
            let share = time / ((1.0 + 2.0_f64.sqrt()) * braking);
            if !momentum {
                assert!((0.99..1.0001).contains(&share), "{name}: {time} s");
            }
        }
    }
}

#[test]
fn reaching_a_rate_at_the_initial_attitude_takes_longer_than_the_change_of_rate() {
    for momentum in [false, true] {
        for rates in [
            [Some(0.005), None, None],
            [Some(0.005), Some(-0.002), Some(0.0)],
        ] {
            let mut spec = published(momentum);
            spec.targets = vec![here("spinning", rates)];
            let time = time_of(&format!("momentum {momentum}, {rates:?}"), &spec);
            // The attitude has to return, which takes longer than to reach the rate alone.
            assert!(time > 0.005 * 6.63 / 0.0101, "{time} s");
        }
    }
}

#[test]
fn targets_that_the_start_meets_take_no_time() {
    let spinning = [Some(0.002), Some(-0.003), Some(0.004)];
    for momentum in [false, true] {
        for (rate, conditions) in [
            ([0.0; 3], [None, None, Some(0.0)]),
            ([0.0; 3], [None; 3]),
            ([0.0; 3], [Some(0.0); 3]),
            (TUMBLING, spinning),
            (TUMBLING, [None, Some(-0.003), None]),
        ] {
            let mut spec = published(momentum);
            spec.start.body_rate_rad_s = Some(rate);
            spec.targets = vec![here("met", conditions)];
            let time = time_of(&format!("momentum {momentum}, {conditions:?}"), &spec);
            assert!(time <= 0.0, "{time} s");
        }
    }
}

#[test]
fn null_space_momentum_can_be_shifted_at_the_attitude_of_the_start() {
    let mut spec = pyramid_spec();
    spec.targets.clear();
    let shift = 30.0;
    spec.end = Some(StateSpec {
        wheel_speed_rad_s: Some([shift, -shift, shift, -shift].into()),
        ..StateSpec::default()
    });
    let wheel = &spec.spacecraft.wheels[0];
    let least = shift * wheel.inertia_kg_m2 / wheel.max_torque_nm;
    let time = time_of("shifted", &spec);
    assert!(agree(time, least, 1e-4), "{time} s instead of {least} s");
    // In the other direction, with momentum at both ends.
    spec.start.wheel_speed_rad_s = Some(vec![60.0, 20.0, -30.0, 10.0]);
    spec.end.as_mut().expect("an end").wheel_speed_rad_s = Some(vec![80.0, 0.0, -10.0, -10.0]);
    let time = time_of("shifted with momentum", &spec);
    assert!(agree(time, least * 2.0 / 3.0, 1e-4), "{time} s");
}

/// From a zero turn to one that the rate at the start dominates.
#[test]
fn the_duration_of_small_turns_tends_to_that_of_a_zero_turn() {
    let time = |angle: f64| {
        let mut spec = published(false);
        spec.start.body_rate_rad_s = Some(TUMBLING);
        let (sine, cosine) = (0.5 * angle).sin_cos();
        spec.end = Some(StateSpec {
            attitude: AttitudeSpec::Quaternion([0.6 * sine, 0.0, 0.8 * sine, cosine]),
            ..StateSpec::default()
        });
        time_of(&format!("{angle} rad"), &spec)
    };
    let none = time(0.0);
    for angle in [1e-12, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4] {
        let some = time(angle);
        assert!(agree(some, none, 1e-4 + 100.0 * angle), "{angle}: {some} s");
    }
}

/// Several targets of one attitude, some with conditions that imply those of others.
#[test]
fn targets_of_one_attitude_with_compatible_conditions_are_passed_together() {
    let angles = [40.0, -20.0, 75.0];
    let twin = |id: &str, rates: [Option<f64>; 3]| TargetSpec {
        attitude: target(id, angles).attitude,
        ..here(id, rates)
    };
    for momentum in [false, true] {
        let mut spec = published(momentum);
        spec.end = Some(StateSpec::default());
        spec.targets = vec![
            twin("a", [None, None, Some(0.0)]),
            TargetSpec {
                zero_rate_axes: Some([false, false, true]),
                ..target("elsewhere", [-30.0, 10.0, 20.0])
            },
        ];
        let alone = plan_of(&spec).total_time_s;
        spec.targets.extend([
            twin("b", [None; 3]),
            twin("c", [None; 3]),
            here("d", [None, None, Some(0.0)]),
        ]);
        let plan = plan_of(&spec);
        let together = plan.total_time_s;
        assert!(agree(together, alone, 1e-4), "{together} s, {alone} s");
        assert!(plan.lower_bound_s <= together * (1.0 + 1e-9));
        // A target that requires rest is a separate passage, or shares that of the others.
        spec.targets.push(target("e", angles));
        assert!(plan_of(&spec).total_time_s >= together * (1.0 - 1e-4));
    }
}

#[test]
fn legs_between_targets_of_one_attitude_converge() {
    let kinds = [
        [None; 3],
        [None, None, Some(0.0)],
        [Some(0.0), Some(0.003), None],
        [Some(0.005), None, Some(0.0)],
        [Some(0.0); 3],
    ];
    for momentum in [false, true] {
        let mut spec = published(momentum);
        spec.targets = kinds
            .iter()
            .enumerate()
            .map(|(i, rates)| here(&format!("kind {i}"), *rates))
            .collect();
        let scenario = scenario_of(&spec);
        let whole = Shard { index: 0, of: 1 };
        let (rows, complete) = on_threads(2, |run| {
            planner::leg_table(&scenario, LegKind::LowerBound, whole, run)
        });
        assert!(complete && rows.len() == 30, "{rows:?}");
        for row in rows {
            assert_eq!(row.status, "converged", "momentum {momentum}: {row:?}");
        }
        assert!(plan_of(&spec).total_time_s > 0.0);
    }
}
