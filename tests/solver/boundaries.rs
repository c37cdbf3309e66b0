//! Every kind of condition at the ends of a leg and every set of limits, one case each: a plan is found
//! and passes its verification.

use slewplan_solver::model::plan::{Outcome, Plan};
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, StateSpec, TargetSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, Shard};
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{agree, on_threads, plan_of, scenario_of};
use slewplan_tests::{experiment_a_spec, pyramid_spec, target, wheel};

/// A condition of a rate component, by its bounds.
type RateBounds = (Option<f64>, Option<f64>);
const ZERO: RateBounds = (Some(0.0), Some(0.0));
const BOUNDED: RateBounds = (Some(-0.004), Some(0.006));
const PRESCRIBED: RateBounds = (Some(0.005), Some(0.005));
const FREE: RateBounds = (None, None);

/// The published spacecraft with a target but no end; with stored momentum or without.
fn published(momentum: bool) -> ScenarioSpec {
    let mut spec = experiment_a_spec();
    spec.targets = vec![target("there", [40.0, -20.0, 75.0])];
    spec.end = None;
    if momentum {
        spec.start.wheel_speed_rad_s = Some(vec![120.0, -80.0, 100.0]);
    }
    spec
}

/// The same from its start to an end, without targets.
fn to_an_end(momentum: bool) -> ScenarioSpec {
    let mut spec = published(momentum);
    spec.end = Some(StateSpec {
        attitude: spec.targets[0].attitude.clone(),
        ..StateSpec::default()
    });
    spec.targets.clear();
    spec
}

/// Name and outcome of a case without a verified plan.
fn fault(name: &str, spec: &ScenarioSpec) -> Option<String> {
    let scenario = scenario_of(spec);
    match on_threads(1, |run| planner::solve(&scenario, run)) {
        Outcome::Planned(plan) if plan.verification.passed => None,
        outcome => Some(format!("{name}: {outcome:?}")),
    }
}

fn assert_all_are_verified(cases: &[(String, ScenarioSpec)]) {
    let faults: Vec<_> = cases
        .iter()
        .filter_map(|(name, spec)| fault(name, spec))
        .collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn every_condition_of_every_rate_component_is_met() {
    let kinds = [ZERO, BOUNDED, PRESCRIBED, FREE];
    let mut cases = Vec::new();
    for (i, x) in kinds.iter().enumerate() {
        for (j, y) in kinds.iter().enumerate() {
            for (k, z) in kinds.iter().enumerate() {
                let mut spec = published((i + j + k) % 2 == 1);
                spec.targets[0].rate_min_rad_s = Some([x.0, y.0, z.0]);
                spec.targets[0].rate_max_rad_s = Some([x.1, y.1, z.1]);
                cases.push((format!("kinds {i} {j} {k}"), spec));
            }
        }
    }
    assert_all_are_verified(&cases);
}

/// With four targets that permute the kinds of conditions, every rate component has each kind at either
/// end of some leg.
#[test]
fn legs_between_every_two_kinds_of_conditions_converge() {
    let kinds = [ZERO, BOUNDED, PRESCRIBED, FREE];
    for momentum in [false, true] {
        let mut spec = published(momentum);
        spec.targets = (0..kinds.len())
            .map(|i| {
                let [x, y, z] = [0, 1, 3].map(|shift| kinds[(i + shift) % kinds.len()]);
                let turned = 35.0 * i as f64;
                TargetSpec {
                    rate_min_rad_s: Some([x.0, y.0, z.0]),
                    rate_max_rad_s: Some([x.1, y.1, z.1]),
                    ..target(&format!("kind {i}"), [20.0 - turned, 10.0, turned])
                }
            })
            .collect();
        let scenario = scenario_of(&spec);
        let whole = Shard { index: 0, of: 1 };
        let (rows, complete) = on_threads(2, |run| {
            planner::leg_table(&scenario, LegKind::LowerBound, whole, run)
        });
        assert!(complete && rows.len() == 20, "{rows:?}");
        for row in rows {
            assert_eq!(row.status, "converged", "momentum {momentum}: {row:?}");
        }
    }
}

#[test]
fn rates_at_start_and_end_are_met() {
    let rates = [[0.0; 3], [0.002, -0.003, 0.004], [-0.004, 0.0, 0.005]];
    let mut cases = Vec::new();
    for (i, first) in rates.into_iter().enumerate() {
        for (j, last) in rates.into_iter().enumerate() {
            for momentum in [false, true] {
                let mut spec = to_an_end(momentum);
                spec.start.body_rate_rad_s = Some(first);
                // The total momentum is that of the wheels' speeds, turning or not.
                let end = spec.end.as_mut().expect("an end");
                end.body_rate_rad_s = Some(last);
                cases.push((format!("rates {i} to {j}, momentum {momentum}"), spec));
            }
        }
    }
    assert_all_are_verified(&cases);
}

fn last_wheel_speeds(plan: &Plan) -> Vec<f64> {
    let last = plan.states.last().expect("a state at the end");
    last.wheel_speed_rad_s.clone()
}

#[test]
fn wheel_speeds_at_the_end_are_met() {
    for momentum in [false, true] {
        // With three wheels the speeds at the end follow from the momentum.
        let mut spec = to_an_end(momentum);
        let free = plan_of(&spec);
        spec.end.as_mut().expect("an end").wheel_speed_rad_s = Some(last_wheel_speeds(&free));
        let held = plan_of(&spec);
        assert!(agree(free.total_time_s, held.total_time_s, 1e-4));
    }
    for share in [0.0, 0.3, 0.9] {
        // With four wheels the null-space momentum can be chosen.
        let mut spec = pyramid_spec();
        spec.end = Some(StateSpec {
            attitude: spec.targets[0].attitude.clone(),
            wheel_speed_rad_s: Some(
                [1.0, -1.0, 1.0, -1.0]
                    .map(|sign| sign * share * 314.0)
                    .into(),
            ),
            ..StateSpec::default()
        });
        spec.targets.clear();
        let plan = plan_of(&spec);
        let speeds = last_wheel_speeds(&plan);
        assert!((speeds[0] - share * 314.0).abs() <= 1e-4, "{speeds:?}");
    }
    // Four wheels with stored momentum: the null-space momentum is shifted from its free end value.
    let mut spec = pyramid_spec();
    spec.start.wheel_speed_rad_s = Some(vec![60.0, 20.0, -30.0, 10.0]);
    let attitude = spec.targets[0].attitude.clone();
    spec.targets.clear();
    spec.end = Some(StateSpec {
        attitude,
        ..StateSpec::default()
    });
    let free = last_wheel_speeds(&plan_of(&spec));
    let shifted: Vec<f64> = free
        .iter()
        .zip([25.0, -25.0, 25.0, -25.0])
        .map(|(speed, shift)| speed + shift)
        .collect();
    spec.end.as_mut().expect("an end").wheel_speed_rad_s = Some(shifted.clone());
    let held = last_wheel_speeds(&plan_of(&spec));
    for (held, wanted) in held.iter().zip(&shifted) {
        assert!((held - wanted).abs() <= 1e-4, "{held} of {wanted} rad/s");
    }
}

#[test]
fn plans_with_3_to_17_wheels_of_different_sizes_are_verified() {
    let mut cases = Vec::new();
    // Up to eight wheels, and the greatest number that can be enabled.
    for count in (3..=8_u32).chain([17]) {
        for momentum in [false, true] {
            let mut generator = Generator::new(u64::from(count));
            let mut spec = published(false);
            spec.spacecraft.inertia_kg_m2 = generator.inertia(6.0, 11.0, true);
            let wheels = usize::try_from(count).expect("small");
            spec.spacecraft.wheels = generator.wheel_array(wheels, wheels, |generator| {
                let size = generator.logarithmic(0.3, 3.0);
                wheel(generator.direction(), 2e-4 * size, 0.01 * size, 600.0)
            });
            if momentum {
                let speeds = (0..count).map(|_| generator.between(-90.0, 90.0));
                spec.start.wheel_speed_rad_s = Some(speeds.collect());
            }
            cases.push((format!("{count} wheels, momentum {momentum}"), spec));
        }
    }
    assert_all_are_verified(&cases);
}

#[test]
fn plans_under_every_subset_of_limits_are_verified() {
    let mut cases = Vec::new();
    for subset in 0..32_u32 {
        let has = |bit: u32| subset & (1 << bit) != 0;
        let mut spec = published(has(0) != has(4));
        let limit = |bit, value| has(bit).then_some(value);
        spec.spacecraft.max_body_rate_rad_s = [limit(0, 0.02), limit(1, 0.04), limit(2, 0.01)];
        spec.spacecraft.max_body_rate_norm_rad_s = limit(3, 0.025);
        if !has(4) {
            for wheel in &mut spec.spacecraft.wheels {
                wheel.max_speed_rad_s = None;
            }
        }
        cases.push((format!("limits {subset:05b}"), spec));
    }
    assert_all_are_verified(&cases);
}

#[test]
fn plans_that_start_near_wheel_speed_limits_are_verified() {
    let mut cases = Vec::new();
    for share in [0.9, 0.99, 1.0] {
        let mut spec = published(false);
        spec.start.wheel_speed_rad_s = Some(vec![share * 710.0, 0.0, 0.0]);
        cases.push((format!("one of three at {share}"), spec));
        let mut spec = pyramid_spec();
        let limit = share * spec.spacecraft.wheels[0].max_speed_rad_s.expect("a limit");
        spec.start.wheel_speed_rad_s = Some([1.0, -1.0, 1.0, -1.0].map(|sign| sign * limit).into());
        cases.push((format!("all of four at {share}, no momentum"), spec.clone()));
        spec.start.wheel_speed_rad_s = Some(vec![limit, 0.0, 0.0, 0.0]);
        cases.push((format!("one of four at {share}"), spec));
    }
    assert_all_are_verified(&cases);
}

#[test]
fn half_a_revolution_is_the_same_plan_for_any_number_of_threads() {
    for quaternion in [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.6, 0.8, 0.0],
        [-0.48, 0.6, 0.64, 0.0],
    ] {
        let mut spec = published(false);
        spec.targets[0].attitude = AttitudeSpec::Quaternion(quaternion);
        let scenario = scenario_of(&spec);
        let [one, three, again] = [1, 3, 1].map(|threads| {
            match on_threads(threads, |run| planner::solve(&scenario, run)) {
                Outcome::Planned(plan) => plan,
                outcome => panic!("{quaternion:?}: {outcome:?}"),
            }
        });
        assert!(one.verification.passed);
        assert_eq!(one.flight, three.flight);
        assert_eq!(one.flight, again.flight);
        // The sign of the quaternion does not decide between equal plans.
        spec.targets[0].attitude = AttitudeSpec::Quaternion(quaternion.map(|c| -c));
        assert_eq!(one.flight, plan_of(&spec).flight);
    }
}

/// Inertias of 0.01 to 1e5 kg m², durations from milliseconds to hours, turns from 1e-7 rad to half a
/// turn.
#[test]
fn legs_of_every_scale_are_verified() {
    let mut cases = Vec::new();
    for inertia in [0.01, 1.0, 100.0, 1e5] {
        for acceleration in [1e-6_f64, 1e-2, 10.0] {
            for angle in [1e-7, 1e-4, 0.1, std::f64::consts::PI] {
                for momentum in [false, true] {
                    let mut spec = published(false);
                    let (torque, rate) = (inertia * acceleration, 0.5 * acceleration.sqrt());
                    spec.spacecraft.inertia_kg_m2 = [
                        [0.8 * inertia, 0.03 * inertia, 0.0],
                        [0.03 * inertia, inertia, 0.0],
                        [0.0, 0.0, 1.1 * inertia],
                    ];
                    spec.spacecraft.max_body_rate_rad_s = [None; 3];
                    for wheel in &mut spec.spacecraft.wheels {
                        wheel.max_torque_nm = torque;
                        wheel.max_speed_rad_s = Some(600.0);
                        wheel.inertia_kg_m2 = inertia * rate / 600.0;
                    }
                    spec.targets[0].attitude = AttitudeSpec::Quaternion([
                        0.6 * (angle / 2.0).sin(),
                        0.0,
                        0.8 * (angle / 2.0).sin(),
                        (angle / 2.0).cos(),
                    ]);
                    spec.start.wheel_speed_rad_s = momentum.then(|| vec![60.0, -40.0, 100.0]);
                    let name = format!(
                        "{inertia} kg m2, {acceleration} rad/s2, {angle} rad, momentum {momentum}"
                    );
                    cases.push((name, spec));
                }
            }
        }
    }
    assert_all_are_verified(&cases);
}
