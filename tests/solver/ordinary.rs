//! Ordinary spacecraft: every scenario whose momentum the wheels can hold has a verified plan.

use slewplan_solver::model::plan::{Optimality, Outcome};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, Shard};
use slewplan_tests::ordinary::{conditioned, scenario};
use slewplan_tests::solving::{on_threads, planned, scenario_of};

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
