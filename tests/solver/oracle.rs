//! Branch and bound against all orders, flown one by one.

use slewplan_solver::plan::Optimality;
use slewplan_solver::planner::every_order;
use slewplan_solver::spec::{AttitudeEquivalence, AttitudeSpec, ScenarioSpec, StateSpec};
use slewplan_tests::experiment_a_spec;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{agree, on_threads, plan_of, scenario_of};

/// What a random scenario is to have; the seed decides the rest.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says whether a scenario has a trait"
)]
struct Case {
    seed: u64,
    targets: usize,
    /// Kind of rate condition of every target, or `None` for a mixture.
    rate_kind: Option<usize>,
    momentum: bool,
    end: bool,
    dwell: bool,
    signed: bool,
}

const PLAIN: Case = Case {
    seed: 0,
    targets: 4,
    rate_kind: None,
    momentum: false,
    end: true,
    dwell: false,
    signed: false,
};

fn random_spec(case: &Case) -> ScenarioSpec {
    let mut generator = Generator::new(case.seed);
    let mut spec = experiment_a_spec();
    spec.targets = (0..case.targets)
        .map(|i| {
            let kind = case.rate_kind.unwrap_or(i % 4);
            generator.target(format!("t{i}"), kind)
        })
        .collect();
    if case.momentum {
        spec.start.wheel_speed_rad_s = Some(generator.vector(-150.0, 150.0).into());
    }
    spec.end = case.end.then(|| StateSpec {
        attitude: AttitudeSpec::Quaternion(generator.quaternion()),
        ..StateSpec::default()
    });
    if case.dwell {
        // The first kind of rate condition is rest, which dwelling is compatible with.
        spec.targets[0].dwell_s = 12.5;
        spec.targets[0].settle_s = 3.0;
    }
    if case.signed {
        spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    }
    spec
}

fn assert_search_finds_the_best_order(case: &Case) {
    let spec = random_spec(case);
    let plan = plan_of(&spec);
    let scenario = scenario_of(&spec);
    let orders = on_threads(2, |run| every_order(&scenario, run));
    let seed = case.seed;
    let all: usize = (1..=case.targets).product();
    assert_eq!(orders.len(), all, "seed {seed}: orders left unsolved");
    let (found, best) = (plan.total_time_s, orders[0].duration_s);
    assert!(
        agree(found, best, 1e-6),
        "seed {seed}: the search found {found} s, all orders {best} s"
    );
    assert_eq!(plan.optimality, Optimality::Optimal, "seed {seed}");
    assert!(
        plan.lower_bound_s <= best * (1.0 + 1e-9),
        "seed {seed}: bound {} s above the best order, {best} s",
        plan.lower_bound_s
    );
}

/// The same for scenarios with one kind of rate condition at every target: seed, targets, stored
/// momentum, end.
fn assert_found_with(rate_kind: usize, cases: [(u64, usize, bool, bool); 2]) {
    for (seed, targets, momentum, end) in cases {
        assert_search_finds_the_best_order(&Case {
            seed,
            targets,
            rate_kind: Some(rate_kind),
            momentum,
            end,
            ..PLAIN
        });
    }
}

#[test]
fn the_best_order_is_found_when_every_target_is_a_rest() {
    assert_found_with(0, [(1, 5, false, true), (2, 4, false, false)]);
}

#[test]
fn the_best_order_is_found_when_only_the_z_rate_vanishes() {
    assert_found_with(1, [(3, 4, false, true), (4, 3, true, true)]);
}

#[test]
fn the_best_order_is_found_when_the_rate_is_free() {
    assert_found_with(2, [(5, 4, false, true), (6, 3, false, false)]);
}

#[test]
fn the_best_order_is_found_when_the_rate_is_bounded() {
    assert_found_with(3, [(7, 3, false, true), (8, 2, true, true)]);
}

#[test]
fn the_best_order_is_found_among_mixed_conditions_with_dwell() {
    assert_search_finds_the_best_order(&Case {
        seed: 9,
        dwell: true,
        ..PLAIN
    });
    assert_search_finds_the_best_order(&Case {
        seed: 10,
        momentum: true,
        end: false,
        dwell: true,
        ..PLAIN
    });
}

#[test]
fn the_best_order_is_found_with_signed_quaternions() {
    assert_search_finds_the_best_order(&Case {
        seed: 11,
        targets: 3,
        rate_kind: Some(1),
        signed: true,
        ..PLAIN
    });
}
