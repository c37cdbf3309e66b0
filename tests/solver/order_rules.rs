//! Fixed positions and precedences of targets.

use slewplan_solver::model::plan::{Optimality, Plan};
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::planner::{BoundFrom, OrderError, every_order, solve_order};
use slewplan_tests::solving::{agree, on_threads, order_of, plan_of, scenario_of};
use slewplan_tests::{experiment_a_spec, published_targets_spec};

/// Experiment A with c second, and d after both b and f, which its best orders do not keep.
fn ruled_spec() -> ScenarioSpec {
    let mut spec = experiment_a_spec();
    spec.targets[2].position = Some(2);
    spec.targets[3].after = vec!["b".into(), "f".into()];
    spec
}

fn indices(order: &str) -> Vec<usize> {
    order.bytes().map(|name| usize::from(name - b'a')).collect()
}

fn keeps_the_rules(order: &str) -> bool {
    let place = |name| order.find(name).expect("every target is visited");
    place('c') == 1 && place('d') > place('b') && place('d') > place('f')
}

#[test]
fn experiment_a_under_rules_is_the_best_of_the_orders_that_keep_them() {
    let spec = ruled_spec();
    let free = plan_of(&experiment_a_spec());
    let plan: Plan = plan_of(&spec);
    assert!(keeps_the_rules(&order_of(&plan)), "{}", order_of(&plan));
    assert_eq!(plan.optimality, Optimality::Optimal);
    assert!(plan.verification.passed && plan.total_time_s > free.total_time_s + 1.0);
    // The certified bound takes the rules into account too.
    let certified = plan.certified_lower_bound_s.expect("a proved bound");
    assert!(Some(certified) > free.certified_lower_bound_s && certified <= plan.total_time_s);
    for other in &plan.alternatives {
        assert!(keeps_the_rules(&other.sequence.concat()), "{other:?}");
    }
    let scenario = scenario_of(&spec);
    let orders = on_threads(2, |run| every_order(&scenario, run));
    // Of the 120 orders with c second, d is the last of three in a third.
    assert_eq!(orders.len(), 40);
    assert!(
        agree(plan.total_time_s, orders[0].duration_s, 1e-6),
        "{orders:?}"
    );
}

#[test]
fn every_fixed_position_is_kept() {
    for (target, place) in (0..3).flat_map(|target| (1..=3).map(move |place| (target, place))) {
        let mut spec = published_targets_spec(&["a", "b", "e"]);
        spec.targets[target].position = Some(place);
        let plan = plan_of(&spec);
        let case = format!("target {target} at place {place}");
        let visited = &plan.flight.passages[place - 1].target;
        assert_eq!(*visited, spec.targets[target].id, "{case}");
        for other in &plan.alternatives {
            assert_eq!(other.sequence[place - 1], spec.targets[target].id, "{case}");
        }
    }
}

#[test]
fn a_given_order_has_to_keep_the_rules() {
    let scenario = scenario_of(&ruled_spec());
    let solve = |order: &str| {
        let order = indices(order);
        on_threads(2, |run| {
            solve_order(&scenario, &order, BoundFrom::Certificates, run)
        })
    };
    for wrong in ["cabfde", "acdbfe", "acfdbe"] {
        assert_eq!(solve(wrong).err(), Some(OrderError::NotAdmitted), "{wrong}");
    }
    assert!(solve("acbfde").is_ok());
}
