//! Ordinary spacecraft: every scenario whose momentum the wheels can hold has a verified plan.

use slewplan_solver::model::plan::{Optimality, Outcome};
use slewplan_solver::model::spec::{
    AttitudeSpec, ScenarioSpec, SpacecraftSpec, StateSpec, TargetSpec,
};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, Shard};
use slewplan_tests::ordinary::{conditioned, scenario};
use slewplan_tests::solving::{on_threads, plan_of, planned, scenario_of};
use slewplan_tests::wheel;

/// Legs and tours of the suite.
const LEGS: u64 = 400;
const TOURS: u64 = 60;
/// Tours with conditions of every kind.
const CONDITIONED: u64 = 40;
/// Greatest ratio of the largest to the smallest wheel.
const SPREAD: f64 = 3.0;
const WILD_SPREAD: f64 = 1000.0;

#[test]
fn every_leg_is_solved_and_verified() {
    let mut constructed = Vec::new();
    for seed in 0..LEGS {
        let scenario = scenario_of(&scenario(seed, 1, SPREAD));
        // The leg from the start to the target; the checker verifies what the table lists.
        let there = Shard { index: 0, of: 2 };
        let (rows, _) = on_threads(1, |run| {
            planner::leg_table(&scenario, LegKind::LowerBound, there, run)
        });
        let row = &rows[0];
        let duration_s = row.duration_s;
        let duration_s = duration_s.unwrap_or_else(|| panic!("leg {seed}: {}", row.status));
        if let Some(bound) = row.certified_lower_bound_s {
            assert!(
                duration_s >= bound * (1.0 - 1e-6),
                "leg {seed} beats its bound"
            );
        }
        if row.status != "converged" {
            constructed.push(seed);
        }
    }
    assert!(constructed.len() <= 4, "constructed: {constructed:?}");
}

#[test]
fn every_tour_is_planned_and_verified() {
    for seed in 0..TOURS {
        let targets = 2 + usize::try_from(seed % 5).expect("few");
        let spec = scenario(1000 + seed, targets, SPREAD);
        let scenario = scenario_of(&spec);
        let outcome = on_threads(2, |run| planner::solve(&scenario, run));
        let Outcome::Planned(_) = &outcome else {
            panic!("tour {seed}: {outcome:?}");
        };
        let plan = planned(outcome);
        assert_eq!(plan.optimality, Optimality::Optimal, "tour {seed}");
        assert!(plan.largest_open_share().is_some_and(|open| open <= 1.0));
    }
}

/// Wheels that take minutes to exchange what they store: no program of a leg to the target converges.
fn slow_exchange() -> ScenarioSpec {
    let wheel = |axis, inertia, torque| wheel(axis, inertia, torque, 123.743);
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [
                [5.405_3e-3, 0.0, 0.0],
                [0.0, 4.779_3e-3, 0.0],
                [0.0, 0.0, 5.699_9e-3],
            ],
            wheels: vec![
                wheel([1.0, 0.0, 0.0], 1.575_8e-6, 1.412_5e-5),
                wheel([0.0, 1.0, 0.0], 1.817_3e-5, 2.508e-6),
                wheel([0.0, 0.0, 1.0], 3.747_2e-6, 7.825_1e-6),
                wheel([0.208_29, -0.830_45, -0.516_69], 1.911_7e-5, 9.955_3e-6),
            ],
            ..SpacecraftSpec::default()
        },
        start: StateSpec {
            wheel_speed_rad_s: Some(vec![9.299_2, 20.668_7, 10.851_7, -69.188_7]),
            ..StateSpec::default()
        },
        targets: vec![TargetSpec {
            id: "target".to_owned(),
            attitude: AttitudeSpec::Quaternion([0.331_27, -0.655_66, -0.041_78, 0.677_22]),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    }
}

#[test]
fn a_plan_with_a_constructed_leg_is_not_called_optimal() {
    let plan = plan_of(&slow_exchange());
    assert_eq!(plan.legs[0].solver_status, "constructed");
    assert_eq!(plan.optimality, Optimality::Feasible);
    let certified = plan.certified_lower_bound_s.expect("a bound");
    assert!((plan.lower_bound_s - certified).abs() < 1e-9 && certified < 0.1 * plan.total_time_s);
}

/// That no program converges does not exclude a target that is worth more than all others.
#[test]
fn a_schedule_is_not_called_optimal_that_leaves_out_what_was_not_solved() {
    let mut spec = slow_exchange();
    spec.latest_end_s = Some(20_000.0);
    spec.targets[0].value = Some(10.0);
    spec.targets.push(TargetSpec {
        id: "near".to_owned(),
        attitude: AttitudeSpec::Quaternion([0.0, 0.0, 0.02, 0.999_8]),
        value: Some(1.0),
        after: vec!["target".to_owned()],
        ..TargetSpec::default()
    });
    let plan = plan_of(&spec);
    let schedule = plan.schedule.as_ref().expect("a schedule");
    assert!(schedule.value_bound >= 11.0 - 1e-9);
    assert_eq!(plan.optimality, Optimality::Feasible);
}

/// Six wheels with torques of many sizes that take minutes to reach their speeds, so that targets that stop z alone are
/// passed at rates far from those of the first motion.
fn slow_wheels(order: [usize; 5]) -> ScenarioSpec {
    let torques = [0.0042, 0.0066, 0.0025, 0.0064, 0.0039, 0.0056];
    let around = (0..6).map(|n| f64::from(n) * std::f64::consts::FRAC_PI_3);
    let wheels = around.zip(torques).map(|(angle, torque)| {
        let axis = [0.82 * angle.cos(), 0.82 * angle.sin(), 0.57];
        wheel(axis, 0.002, torque, 600.0)
    });
    let attitudes = [
        [0.393, 0.716, -0.085, 0.571],
        [0.231, -0.656, 0.112, 0.71],
        [0.101, 0.598, -0.239, 0.758],
        [-0.066, 0.656, 0.048, 0.75],
        [-0.234, -0.553, -0.04, 0.799],
    ];
    let targets = (0..5).map(|target| TargetSpec {
        id: format!("t{target}"),
        attitude: AttitudeSpec::Quaternion(attitudes[target]),
        zero_rate_axes: Some([false, false, true]),
        position: order
            .iter()
            .position(|other| *other == target)
            .map(|at| at + 1),
        ..TargetSpec::default()
    });
    ScenarioSpec {
        spacecraft: SpacecraftSpec {
            inertia_kg_m2: [[20.0, 0.5, 0.0], [0.5, 25.0, -0.3], [0.0, -0.3, 18.0]],
            wheels: wheels.collect(),
            ..SpacecraftSpec::default()
        },
        targets: targets.collect(),
        ..ScenarioSpec::default()
    }
}

#[test]
fn bounds_on_legs_of_arrays_agree_with_tours_within_the_accuracy_of_programs() {
    for weakest in [0.02, 1.0] {
        let mut spec = slow_wheels([0, 1, 2, 3, 4]);
        spec.spacecraft.wheels[0].max_torque_nm *= weakest;
        for target in &mut spec.targets {
            target.zero_rate_axes = None;
            target.position = None;
        }
        let plan = plan_of(&spec);
        assert_eq!(plan.optimality, Optimality::Optimal);
        assert!(plan.warnings.is_empty(), "{weakest}: {:?}", plan.warnings);
    }
}

#[test]
fn tours_whose_first_motion_is_far_from_the_fastest_are_solved() {
    for (order, stopping_s) in [([0, 2, 4, 3, 1], 601.6), ([3, 4, 2, 1, 0], 655.3)] {
        let plan = plan_of(&slow_wheels(order));
        assert_eq!(plan.optimality, Optimality::Optimal, "{order:?}");
        assert!(
            plan.total_time_s < 0.7 * stopping_s,
            "{}",
            plan.total_time_s
        );
    }
}

#[test]
fn conditions_of_every_kind_are_met_with_momentum_and_limits() {
    for seed in 0..CONDITIONED {
        let targets = 1 + usize::try_from(seed % 4).expect("few");
        let scenario = scenario_of(&conditioned(3000 + seed, targets, SPREAD));
        let outcome = on_threads(2, |run| planner::solve(&scenario, run));
        let Outcome::Planned(_) = &outcome else {
            panic!("tour {seed}: {outcome:?}");
        };
        assert_eq!(planned(outcome).optimality, Optimality::Optimal, "{seed}");
    }
}

#[test]
fn scenarios_with_wheels_of_very_different_sizes_are_solved() {
    for seed in 0..20 {
        let mut spec = scenario(
            2000 + seed,
            1 + usize::try_from(seed % 2).expect("few"),
            WILD_SPREAD,
        );
        spec.options.node_limit = Some(20);
        let scenario = scenario_of(&spec);
        let plan = planned(on_threads(2, |run| planner::solve(&scenario, run)));
        assert!(!plan.flight.controls.is_empty(), "{seed}");
    }
}
