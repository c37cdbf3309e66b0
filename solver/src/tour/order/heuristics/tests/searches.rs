//! Iterated searches: quality, reproducibility, rules and stops.

use super::models::{Couplings, Legs, RandomCost};
use crate::run::stop::StopSignal;
use crate::tour::order::completion::SpanningTrees;
use crate::tour::order::heuristics::cost::{OrderCost, length};
use crate::tour::order::heuristics::iterated::IteratedSearch;
use crate::tour::order::heuristics::local_search::OrderTask;
use crate::tour::order::{PairTable, SolvedOrder};
use std::sync::atomic::{AtomicUsize, Ordering};

fn all(targets: usize) -> Vec<usize> {
    (0..targets).collect()
}

/// The search for the shortest order after a place, without rules.
fn after<C>(cost: &C, from: usize) -> OrderTask<'_, C> {
    let admits = None;
    OrderTask { cost, from, admits }
}

/// The best orders from the start after so many kicks, beginning at `0, 1, ..`.
fn found<C: OrderCost>(cost: &C, kicks: usize, alternatives: usize, seed: u64) -> Vec<SolvedOrder> {
    let task = after(cost, cost.targets());
    let mut search = IteratedSearch::new(&task, &all(cost.targets()), alternatives, seed);
    search.run(kicks, &StopSignal::new());
    search.best().to_vec()
}

#[test]
fn the_search_finds_the_optimum_of_up_to_nine_targets() {
    let kinds = [
        (Legs::Points, Couplings::None),
        (Legs::Dwells, Couplings::BothWays),
        (Legs::Directed, Couplings::None),
        (Legs::Directed, Couplings::Directed),
    ];
    let mut solved = 0;
    for seed in 0..100 {
        let (legs, couplings) = kinds[seed % 4];
        let targets = 1 + seed % 9;
        let cost = RandomCost::new(targets, legs, couplings, seed as u64);
        let best = found(&cost, 200, 0, 1)[0].duration_s;
        let least = cost.least();
        assert!(best > least - 1e-9, "seed {seed}: {best} below {least}");
        solved += usize::from(best < least + 1e-9);
    }
    assert_eq!(solved, 100);
}

#[test]
fn fifty_targets_end_within_one_percent_of_the_spanning_tree_bound() {
    for seed in 0..3 {
        let table = PairTable::new(&RandomCost::new(50, Legs::Dwells, Couplings::None, seed));
        let bound = SpanningTrees::new(&table).bound(&table, table.start(), &all(50));
        let best = found(&table, 3000, 0, seed)[0].duration_s;
        assert!(bound < best + 1e-9 && best < 1.01 * bound, "{bound} {best}");
    }
}

#[test]
fn the_best_order_has_the_same_targets_and_is_never_longer() {
    for targets in [0, 1, 2, 3, 4, 40] {
        let cost = RandomCost::new(targets, Legs::Directed, Couplings::Directed, 3);
        let initial = length(&cost, targets, &all(targets));
        for kicks in [0, 1, 50] {
            let best = &found(&cost, kicks, 0, 9)[0];
            assert!(best.duration_s <= initial);
            assert!((best.duration_s - length(&cost, targets, &best.order)).abs() < 1e-9);
            let mut order = best.order.clone();
            order.sort_unstable();
            assert_eq!(order, all(targets));
        }
    }
}

#[test]
fn a_subset_of_targets_after_another_target_is_searched() {
    let cost = RandomCost::new(30, Legs::Points, Couplings::BothWays, 8);
    let some: Vec<usize> = (0..30).filter(|t| t % 3 != 0).collect();
    let mut search = IteratedSearch::new(&after(&cost, 6), &some, 0, 0);
    search.run(300, &StopSignal::new());
    let best = &search.best()[0];
    assert!(best.duration_s < length(&cost, 6, &some));
    assert!((best.duration_s - length(&cost, 6, &best.order)).abs() < 1e-9);
    let mut order = best.order.clone();
    order.sort_unstable();
    assert_eq!(order, some);
}

#[test]
fn the_result_depends_on_the_seed_alone() {
    let cost = RandomCost::new(40, Legs::Directed, Couplings::BothWays, 5);
    assert_eq!(found(&cost, 200, 5, 1), found(&cost, 200, 5, 1));
    assert_ne!(found(&cost, 200, 5, 1), found(&cost, 200, 5, 2));
}

#[test]
fn alternatives_are_distinct_and_sorted() {
    let cost = RandomCost::new(40, Legs::Points, Couplings::BothWays, 5);
    let best = found(&cost, 2000, 30, 1);
    assert_eq!(best.len(), 31);
    for (place, known) in best.iter().enumerate() {
        assert!((known.duration_s - length(&cost, 40, &known.order)).abs() < 1e-9);
        assert!(best[..place].iter().all(|other| other.order != known.order));
        assert!(
            best[..place]
                .iter()
                .all(|other| other.duration_s <= known.duration_s + 1e-6)
        );
    }
}

#[test]
fn listed_orders_satisfy_the_rules() {
    let cost = RandomCost::new(30, Legs::Points, Couplings::BothWays, 2);
    // Target 0 comes third, and the targets 20 to 29 are in ascending order.
    let admits =
        |order: &[usize]| order[2] == 0 && order.iter().filter(|&&target| target >= 20).is_sorted();
    let mut initial = all(30);
    initial[..3].rotate_left(1);
    assert!(admits(&initial));
    let task = OrderTask {
        cost: &cost,
        from: 30,
        admits: Some(&admits),
    };
    let mut search = IteratedSearch::new(&task, &initial, 10, 3);
    search.run(500, &StopSignal::new());
    assert!(search.best().iter().all(|best| admits(&best.order)));
    let free = found(&cost, 500, 0, 3)[0].duration_s;
    let ruled = search.best()[0].duration_s;
    let at_first = length(&cost, 30, &initial);
    assert!(
        free <= ruled && ruled < 0.8 * at_first,
        "{free} {ruled} {at_first}"
    );
}

#[test]
fn a_stop_ends_the_search_within_few_moves() {
    let cost = RandomCost::new(40, Legs::Points, Couplings::None, 2);
    let stop = StopSignal::new();
    let seen = AtomicUsize::new(0);
    // The rules are asked before every move.
    let admits = |_: &[usize]| {
        if seen.fetch_add(1, Ordering::Relaxed) == 2000 {
            stop.request();
        }
        true
    };
    let task = OrderTask {
        cost: &cost,
        from: 40,
        admits: Some(&admits),
    };
    let mut search = IteratedSearch::new(&task, &all(40), 0, 3);
    let kicks = search.run(100_000, &stop);
    assert!(0 < kicks && kicks < 2000, "{kicks}");
    let asked = seen.load(Ordering::Relaxed);
    assert!(asked < 2100, "{asked}");
    // The result so far is improved, and a further run does nothing.
    let best = search.best()[0].clone();
    assert!(best.duration_s < length(&cost, 40, &all(40)));
    assert_eq!(search.run(10, &stop), 0);
    assert_eq!(search.best()[0], best);
}
