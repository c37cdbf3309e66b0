//! Heuristic orders against full evaluation of costs and enumeration.

mod models;
mod moves;
mod searches;

use super::cost::length;
use super::{SearchEffort, candidates, complete, nearest_neighbours, shorter_orders};
use crate::run::stop::StopSignal;
use crate::tour::order::PairTable;
use crate::tour::order::completion::CompletionBound;
use crate::tour::order::tests::RandomModel;

#[test]
fn iterated_search_shortens_an_order_of_the_same_targets() {
    for seed in 0..5 {
        let table = PairTable::new(&RandomModel::new(30, seed % 2 == 0, seed));
        let start = table.start();
        let all: Vec<usize> = (0..30).collect();
        let built = nearest_neighbours(&table, &[], &all);
        let effort = SearchEffort {
            kicks: 300,
            alternatives: 0,
            seed,
        };
        let orders = (&[][..], built.as_slice());
        let stop = StopSignal::new();
        let improved = shorter_orders(&table, table.rules(), orders, &effort, &stop).remove(0);
        assert!(length(&table, start, &improved) < length(&table, start, &built));
        let mut targets = improved;
        targets.sort_unstable();
        assert!(targets.into_iter().eq(0..30));
    }
}

#[test]
fn a_completion_begins_with_the_prefix_and_visits_all_targets() {
    for targets in [6, 24] {
        let table = PairTable::new(&RandomModel::new(targets, true, 9));
        let completion = CompletionBound::new(&table, table.rules(), None, &StopSignal::new());
        let prefix = [3, 1];
        let remaining: Vec<usize> = (0..targets).filter(|t| !prefix.contains(t)).collect();
        let mut order = complete(&table, &completion, &prefix, &remaining, &StopSignal::new());
        assert_eq!(order[..2], prefix);
        order.sort_unstable();
        assert!(order.into_iter().eq(0..targets));
    }
}

#[test]
fn candidates_of_few_targets_are_the_shortest_order_and_its_reverse() {
    let table = PairTable::new(&RandomModel::new(5, true, 3));
    let completion = CompletionBound::new(&table, table.rules(), None, &StopSignal::new());
    let orders = candidates(&table, &completion, &StopSignal::new());
    let least = completion.bound(&table, table.start(), &[0, 1, 2, 3, 4]);
    assert!((length(&table, table.start(), &orders[0]) - least).abs() < 1e-9);
    assert!(orders[1].iter().rev().eq(&orders[0]));
}

#[test]
fn many_targets_have_several_candidates() {
    let table = PairTable::new(&RandomModel::new(24, true, 3));
    let completion = CompletionBound::new(&table, table.rules(), None, &StopSignal::new());
    let orders = candidates(&table, &completion, &StopSignal::new());
    assert_eq!(orders.len(), 5);
    let of = |order: &[usize]| length(&table, table.start(), order);
    for order in &orders {
        assert!(of(&orders[0]) <= of(order));
        let mut targets = order.clone();
        targets.sort_unstable();
        assert!(targets.into_iter().eq(0..24));
    }
}
