//! Heuristic orders against full evaluation of costs and enumeration.

mod models;
mod moves;
mod searches;

use super::cost::length;
use super::{
    SearchEffort, candidates, complete, nearest_neighbours, short_coupled_order, shorter_orders,
};
use crate::math::random::SplitMix;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::CompletionBound;
use crate::tour::order::exhaustive::permutations;
use crate::tour::order::tests::RandomModel;
use crate::tour::order::{PairTable, Place};

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

#[test]
fn a_first_order_is_the_shortest_one_by_its_legs_and_the_changes_between_them() {
    for seed in 0..12 {
        let has_end = seed % 2 == 0;
        let model = RandomModel::new(6, has_end, seed);
        let mut random = SplitMix::new(seed);
        let mut state = || [(); 3].map(|()| random.below(400) as f64 / 4.0 - 50.0);
        let ends: Vec<[[f64; 3]; 2]> = (0..64).map(|_| [state(), state()]).collect();
        let free_ends = |from: Place, to: Place| ends[8 * from.number(8) + to.number(8)];
        let table = PairTable::new(&model);
        // What a change of this time costs where no gap is known.
        let gap = |legs: &[[Place; 2]]| {
            let [[_, arriving], [leaving, _]] =
                [legs[0], legs[1]].map(|leg| free_ends(leg[0], leg[1]));
            let change = |axis: usize| (arriving[axis] - leaving[axis]).abs();
            0.35 * (0..3).map(change).fold(0.0, f64::max)
        };
        let cost = |order: &[usize]| {
            let targets = order.iter().map(|&target| Place::Target(target));
            let mut places = vec![Place::Start];
            places.extend(targets);
            places.extend(has_end.then_some(Place::End));
            let legs: Vec<[Place; 2]> = places.windows(2).map(|leg| [leg[0], leg[1]]).collect();
            let gaps: f64 = legs.windows(2).map(gap).sum();
            length(&table, table.start(), order) + gaps
        };
        let all = permutations(6);
        let least_s = all
            .iter()
            .map(|order| cost(order))
            .fold(f64::INFINITY, f64::min);
        let found = short_coupled_order(&model, &free_ends, &StopSignal::new()).expect("targets");
        assert!((cost(&found) - least_s).abs() < 1e-3, "seed {seed}");
    }
}
