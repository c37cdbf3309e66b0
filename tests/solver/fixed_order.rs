//! Given orders are solved as the search solves them.

use slewplan_solver::model::plan::{LowerBoundKind, Optimality, Outcome, Plan};
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::planner::{BoundFrom, OrderError, every_order, solve_order};
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{agree, on_threads, plan_of, planned, scenario_of};
use slewplan_tests::{experiment_a_spec, target};

fn plan_in_order(spec: &ScenarioSpec, order: &[usize], effort: BoundFrom) -> Plan {
    let scenario = scenario_of(spec);
    let outcome = on_threads(2, |run| solve_order(&scenario, order, effort, run));
    planned(outcome.expect("an order of the targets"))
}

fn order_in(plan: &Plan, spec: &ScenarioSpec) -> Vec<usize> {
    let index = |id: &String| spec.targets.iter().position(|target| target.id == *id);
    let passages = plan.flight.passages.iter();
    let order = passages.map(|passage| index(&passage.target).expect("a target"));
    order.collect()
}

#[test]
fn the_best_order_gives_the_plan_of_the_search() {
    let mut spec = experiment_a_spec();
    // A target at the place of another has no leg of its own.
    spec.targets.truncate(4);
    let mut twin = spec.targets[1].clone();
    twin.id = "twin".into();
    spec.targets.push(twin);
    let best = plan_of(&spec);
    let order = order_in(&best, &spec);
    let given = plan_in_order(&spec, &order, BoundFrom::Legs);
    assert_eq!(given.flight, best.flight);
    assert_eq!(given.legs, best.legs);
    assert_eq!(given.optimality, Optimality::Feasible);
    assert_eq!(given.lower_bound_kind, LowerBoundKind::PairTable);
    assert!(given.lower_bound_s > 0.9 * given.total_time_s);
    assert!(given.lower_bound_s < given.total_time_s);
}

#[test]
fn a_given_order_takes_as_long_as_in_the_list_of_all_orders() {
    let mut generator = Generator::new(21);
    let mut spec = experiment_a_spec();
    spec.targets = (0..3)
        .map(|i| generator.target(format!("t{i}"), i))
        .collect();
    spec.targets[0].dwell_s = 12.5;
    spec.end = None;
    let scenario = scenario_of(&spec);
    let orders = on_threads(2, |run| every_order(&scenario, run));
    assert_eq!(orders.len(), 6);
    for known in orders {
        let plan = plan_in_order(&spec, &known.order, BoundFrom::Legs);
        assert_eq!(order_in(&plan, &spec), known.order);
        let difference = plan.total_time_s - known.duration_s;
        assert!(difference.abs() < 1e-9, "{known:?}: {difference} s more");
        assert!(plan.lower_bound_s <= plan.total_time_s);
    }
}

/// A whole tour as one program from a cold start has the duration of that from solved legs.
#[test]
fn one_program_from_a_cold_start_is_as_good_as_one_from_solved_legs() {
    let spec = experiment_a_spec();
    let order = order_in(&plan_of(&spec), &spec);
    let careful = plan_in_order(&spec, &order, BoundFrom::Legs);
    let direct = plan_in_order(&spec, &order, BoundFrom::Certificates);
    assert_eq!(order_in(&direct, &spec), order);
    assert_eq!(direct.statistics.nlp_solves, 1);
    assert!(agree(direct.total_time_s, careful.total_time_s, 5e-4));
    // The certified bound is weaker than that of the solved legs with free ends.
    assert_eq!(direct.lower_bound_kind, LowerBoundKind::Certified);
    assert!(direct.lower_bound_s < careful.lower_bound_s);
    assert!(direct.lower_bound_s > 0.8 * direct.total_time_s);
    // Where targets leave nothing free, both solve leg by leg.
    let mut spec = spec;
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    let careful = plan_in_order(&spec, &order, BoundFrom::Legs);
    assert_eq!(
        plan_in_order(&spec, &order, BoundFrom::Certificates).flight,
        careful.flight
    );
}

#[test]
fn lists_that_are_not_permutations_of_the_targets_are_refused() {
    let scenario = scenario_of(&experiment_a_spec());
    let error = OrderError::NotAnOrder { targets: 6 };
    for wrong in [
        vec![],
        vec![0, 1, 2, 3, 4],
        vec![0, 1, 2, 3, 4, 4],
        vec![0, 1, 2, 3, 4, 6],
        vec![0, 1, 2, 3, 4, 5, 5],
    ] {
        let answer = on_threads(1, |run| {
            solve_order(&scenario, &wrong, BoundFrom::Certificates, run)
        });
        assert_eq!(answer.err(), Some(error.clone()), "{wrong:?}");
    }
}

#[test]
fn an_order_through_a_rest_that_the_wheels_cannot_hold_is_infeasible() {
    let mut spec = experiment_a_spec();
    spec.start.wheel_speed_rad_s = Some([700.0; 3].into());
    spec.targets = vec![target("turned", [45.0, 0.0, 45.0])];
    let scenario = scenario_of(&spec);
    let outcome = on_threads(1, |run| {
        solve_order(&scenario, &[0], BoundFrom::Certificates, run)
    });
    assert!(matches!(outcome, Ok(Outcome::Infeasible(_))), "{outcome:?}");
}
