//! Orders under rules: completions, bounds and searches against enumeration.

use super::models::SplitMix;
use super::{RandomModel, alternatives, pool, run};
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{CompletionBound, SpanningTrees, SubsetTable};
use crate::tour::order::exhaustive::permutations;
use crate::tour::order::heuristics::{candidates, complete};
use crate::tour::order::{PairTable, SearchEnd, SearchSettings, exhaustive};

/// Random rules, feasible or not.
fn any_rules(targets: usize, random: &mut SplitMix) -> OrderRules {
    let positions = (0..targets).map(|_| (random.below(4) == 0).then(|| random.below(targets)));
    let positions = positions.collect();
    let mut after = vec![Vec::new(); targets];
    for _ in 0..random.below(targets + 1) {
        after[random.below(targets)].push(random.below(targets));
    }
    OrderRules::new(positions, after)
}

/// Random rules that at least one order satisfies: some of the positions and precedences that hold
/// in it.
fn feasible_rules(targets: usize, random: &mut SplitMix) -> OrderRules {
    let mut order: Vec<usize> = (0..targets).collect();
    for place in (1..targets).rev() {
        order.swap(place, random.below(place + 1));
    }
    let mut positions = vec![None; targets];
    let mut after = vec![Vec::new(); targets];
    for (place, &target) in order.iter().enumerate() {
        if random.below(5) == 0 {
            positions[target] = Some(place);
        }
        if place > 0 && random.below(3) == 0 {
            after[target].push(order[random.below(place)]);
        }
    }
    let rules = OrderRules::new(positions, after);
    assert!(rules.admits(&order));
    rules
}

#[test]
fn a_prefix_is_completed_if_and_only_if_an_admitted_order_begins_with_it() {
    let mut random = SplitMix::new(5);
    let (mut found, mut none) = (0, 0);
    for case in 0..600 {
        let targets = 1 + case % 6;
        let rules = any_rules(targets, &mut random);
        let mut admitted = permutations(targets);
        admitted.retain(|order| rules.admits(order));
        for order in permutations(targets) {
            let prefix = &order[..random.below(targets + 1)];
            let expected = admitted.iter().any(|order| order.starts_with(prefix));
            let completed = rules.some_order(prefix);
            assert_eq!(completed.is_some(), expected, "{rules:?} {prefix:?}");
            if let Some(completed) = completed {
                assert!(completed.starts_with(prefix) && admitted.contains(&completed));
                found += 1;
            } else {
                none += 1;
            }
        }
    }
    assert!(found > 5000 && none > 5000, "{found} and {none}");
}

#[test]
fn the_search_finds_the_best_of_the_admitted_orders() {
    let pool = pool(2);
    let mut random = SplitMix::new(7);
    let mut restricted = 0;
    for seed in 0..300 {
        let targets = 2 + (seed % 6) as usize;
        let wanted = (seed / 6 % 4) as usize;
        let new = if seed % 5 == 0 {
            RandomModel::with_ties
        } else {
            RandomModel::new
        };
        let mut model = new(targets, seed % 4 < 2, seed);
        model.rules = feasible_rules(targets, &mut random);
        restricted += usize::from(!model.rules.is_free());
        let expected = exhaustive(&model, wanted, &pool);
        let result = run(&model, &alternatives(wanted));
        assert!(result.complete && result.end == SearchEnd::Exhausted);
        let found: Vec<_> = result.best.iter().chain(&result.alternatives).collect();
        assert_eq!(found.len(), expected.len(), "seed {seed}");
        for (found, expected) in found.into_iter().zip(&expected) {
            assert_eq!(found.order, expected.order, "seed {seed}");
        }
        let best_s = expected[0].duration_s;
        assert!((result.lower_bound_s - best_s).abs() <= 1e-9 * best_s);
        assert_eq!(result.statistics.bounds_contradicted, 0);
    }
    assert!(restricted > 240, "{restricted}");
}

#[test]
fn subsets_give_the_shortest_admitted_path_and_trees_do_not_exceed_it() {
    let mut random = SplitMix::new(8);
    for seed in 0..60 {
        let targets = 5;
        let mut model = RandomModel::new(targets, seed % 2 == 0, seed);
        model.rules = feasible_rules(targets, &mut random);
        let table = PairTable::new(&model);
        let exact = SubsetTable::new(&table, table.rules(), &StopSignal::new());
        let (exact, trees) = (exact.expect("not stopped"), SpanningTrees::new(&table));
        let mut orders = permutations(targets);
        orders.retain(|order| model.rules.admits(order));
        let prefix = &orders[random.below(orders.len())][..random.below(targets)];
        let from = table.last_place(prefix);
        let length = |order: &Vec<usize>| {
            let path = [&[from], &order[prefix.len()..], &[table.end()]].concat();
            path.windows(2).map(|leg| table.bound(leg[0], leg[1])).sum()
        };
        let completions = orders.iter().filter(|order| order.starts_with(prefix));
        let least: f64 = completions.map(length).fold(f64::INFINITY, f64::min);
        let mut remaining: Vec<usize> = (0..targets).filter(|t| !prefix.contains(t)).collect();
        remaining.sort_unstable();
        let found = exact.bound(&table, from, &remaining);
        assert!((found - least).abs() < 1e-9, "seed {seed}");
        assert!(trees.bound(&table, from, &remaining) <= least + 1e-9);
    }
}

#[test]
fn heuristic_orders_and_completions_satisfy_the_rules() {
    let mut random = SplitMix::new(9);
    let stop = StopSignal::new();
    for (seed, targets) in [(0, 9), (1, 9), (2, 21)] {
        let mut model = RandomModel::new(targets, seed % 2 == 0, seed);
        model.rules = feasible_rules(targets, &mut random);
        let table = PairTable::new(&model);
        let completion = CompletionBound::new(&table, table.rules(), None, &StopSignal::new());
        let orders = candidates(&table, &completion, &stop);
        assert!(!orders.is_empty());
        for order in &orders {
            assert!(order.len() == targets && model.rules.admits(order));
        }
        let prefix = &model.rules.some_order(&[]).expect("an order")[..4];
        let remaining: Vec<usize> = (0..targets).filter(|t| !prefix.contains(t)).collect();
        let order = complete(&table, &completion, prefix, &remaining, &stop);
        assert!(order.starts_with(prefix) && model.rules.admits(&order));
        // The model panics when it is asked for an order that the rules do not admit.
        let settings = SearchSettings {
            node_limit: Some(20),
            ..alternatives(1)
        };
        assert!(run(&model, &settings).best.is_some());
    }
}
