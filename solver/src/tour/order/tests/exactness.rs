//! Results equal to exhaustive enumeration, for any number of threads.

use super::{RandomModel, alternatives, pool, run};
use crate::model::order_rules::OrderRules;
use crate::run::progress::Silent;
use crate::run::stop::StopSignal;
use crate::tour::order::{
    Evaluation, KnownOrders, Place, SearchEnd, SearchResult, SearchSettings, SolvedOrder,
    TourEvaluation, TourModel, exhaustive, search,
};
use std::collections::BTreeMap;
use std::sync::Mutex;

fn orders_of(result: &SearchResult) -> Vec<SolvedOrder> {
    result
        .best
        .iter()
        .chain(&result.alternatives)
        .cloned()
        .collect()
}

fn assert_same_orders(found: &[SolvedOrder], expected: &[SolvedOrder], case: &str) {
    let orders = |list: &[SolvedOrder]| list.iter().map(|o| o.order.clone()).collect::<Vec<_>>();
    assert_eq!(orders(found), orders(expected), "{case}");
    assert_same_durations(found, expected, case);
}

fn assert_same_durations(found: &[SolvedOrder], expected: &[SolvedOrder], case: &str) {
    assert_eq!(found.len(), expected.len(), "{case}");
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a.duration_s - b.duration_s).abs() <= 1e-9 * b.duration_s,
            "{case}"
        );
    }
}

#[test]
fn the_search_finds_the_best_orders_of_coupled_models() {
    let pool = pool(2);
    for seed in 0..240 {
        let targets = 1 + (seed % 6) as usize;
        let wanted = (seed / 6 % 5) as usize;
        let model = RandomModel::new(targets, seed % 4 < 2, seed);
        let expected = exhaustive(&model, wanted, &pool);
        let result = run(&model, &alternatives(wanted));
        assert_same_orders(&orders_of(&result), &expected, &format!("seed {seed}"));
        assert!(result.complete && result.end == SearchEnd::Exhausted);
        let best_s = expected[0].duration_s;
        assert!((result.lower_bound_s - best_s).abs() <= 1e-9 * best_s);
        assert!(result.best_is_proven(0.0));
        assert_eq!(result.statistics.bounds_contradicted, 0);
    }
}

#[test]
fn the_search_finds_the_best_of_orders_that_hardly_differ() {
    let pool = pool(2);
    for seed in 0..96 {
        // With eight targets the search is long enough to compute the triple bounds.
        let targets = 3 + (seed / 4 % 6) as usize;
        let model = RandomModel::with_near_ties(targets, seed % 2 == 0, seed);
        let expected = exhaustive(&model, 4, &pool);
        let result = run(&model, &alternatives(4));
        assert_same_durations(&orders_of(&result), &expected, &format!("seed {seed}"));
        assert!(result.complete && result.best_is_proven(0.0), "seed {seed}");
        assert_eq!(result.statistics.bounds_contradicted, 0, "seed {seed}");
    }
}

#[test]
fn symmetric_models_are_solved_by_searching_half_of_the_orders() {
    let pool = pool(2);
    let mut explored = [0, 0];
    for seed in 0..120 {
        let targets = 1 + (seed % 6) as usize;
        let model = RandomModel::symmetric(targets, seed);
        // An order and its reverse are listed together.
        let wanted = 1 + 2 * (seed / 6 % 3) as usize;
        let expected = exhaustive(&model, wanted, &pool);
        let result = run(&model, &alternatives(wanted));
        assert_same_orders(&orders_of(&result), &expected, &format!("seed {seed}"));
        assert!(result.complete && result.best_is_proven(0.0));
        explored[0] += result.statistics.nodes_explored;
        let all = run(&model.searched_whole(), &alternatives(wanted));
        assert_same_orders(&orders_of(&all), &expected, &format!("seed {seed}"));
        explored[1] += all.statistics.nodes_explored;
    }
    assert!(4 * explored[0] < 3 * explored[1], "{explored:?}");
}

#[test]
fn equal_orders_are_listed_lexicographically() {
    let pool = pool(2);
    for seed in 0..60 {
        let targets = 2 + (seed % 5) as usize;
        let model = RandomModel::with_ties(targets, seed % 2 == 0, seed);
        let expected = exhaustive(&model, 3, &pool);
        let result = run(&model, &alternatives(3));
        assert_same_orders(&orders_of(&result), &expected, &format!("seed {seed}"));
        assert!(result.complete);
    }
}

#[test]
fn the_tree_is_pruned() {
    let result = run(&RandomModel::new(8, true, 1), &alternatives(0));
    assert!(result.complete);
    // There are 69 280 prefixes of 1 to 7 targets and 40 320 orders.
    assert!(
        result.statistics.nodes_explored < 10_000,
        "{:?}",
        result.statistics
    );
    assert!(result.statistics.pruned_by_table > 0);
    assert!(result.statistics.pruned_by_prefix > 0);
}

#[test]
fn results_and_counts_do_not_depend_on_threads() {
    for seed in 0..6 {
        let model = RandomModel::new(7, seed % 2 == 0, seed);
        let settings = SearchSettings {
            node_limit: (seed >= 4).then_some(50),
            ..alternatives(2)
        };
        let reference = search(
            &model,
            KnownOrders::default(),
            &settings,
            &pool(1),
            &StopSignal::new(),
            &Silent,
        );
        for threads in [2, 3, 8] {
            let result = search(
                &model,
                KnownOrders::default(),
                &settings,
                &pool(threads),
                &StopSignal::new(),
                &Silent,
            );
            assert_eq!(result, reference, "seed {seed}, {threads} threads");
        }
    }
}

#[test]
fn a_gap_saves_nodes_and_the_result_is_within_it() {
    let model = RandomModel::new(8, false, 7);
    let exact = run(&model, &alternatives(0));
    let optimum = exact.best.expect("a best order").duration_s;
    let loose = run(
        &model,
        &SearchSettings {
            relative_gap: 0.1,
            ..alternatives(0)
        },
    );
    let found = loose.best.as_ref().expect("a best order").duration_s;
    assert!(loose.complete && loose.best_is_proven(0.1));
    assert!(loose.statistics.nodes_explored < exact.statistics.nodes_explored);
    assert!(found * 0.9 <= loose.lower_bound_s && loose.lower_bound_s <= optimum);
    assert!(optimum <= found);
}

#[test]
fn without_targets_the_tour_goes_straight_to_the_end() {
    for has_end in [false, true] {
        let model = RandomModel::new(0, has_end, 5);
        let expected = exhaustive(&model, 1, &pool(1));
        let result = run(&model, &alternatives(1));
        assert_same_orders(&orders_of(&result), &expected, "no targets");
        assert!(result.complete);
        assert_eq!(result.lower_bound_s > 0.0, has_end);
    }
}

#[test]
fn more_alternatives_than_orders_list_them_all() {
    let result = run(&RandomModel::new(3, true, 2), &alternatives(50));
    assert!(result.complete);
    assert_eq!(result.alternatives.len(), 5);
}

/// Counts the evaluations of every order and prefix.
struct Counted {
    inner: RandomModel,
    asked: Mutex<BTreeMap<Vec<usize>, u64>>,
}

impl Counted {
    fn count(&self, places: &[usize]) {
        let mut asked = self.asked.lock().expect("no thread panicked");
        *asked.entry(places.to_vec()).or_default() += 1;
    }
}

impl TourModel for Counted {
    fn target_count(&self) -> usize {
        self.inner.target_count()
    }

    fn has_end(&self) -> bool {
        self.inner.has_end()
    }

    fn rules(&self) -> &OrderRules {
        self.inner.rules()
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        self.inner.pair_bound(from, to)
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        self.count(prefix);
        self.inner.prefix_bound(prefix)
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        self.inner.path_bound(path)
    }

    fn couples(&self, via: usize) -> bool {
        self.inner.couples(via)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        self.count(order);
        self.inner.tour(order)
    }
}

#[test]
fn every_prefix_and_order_is_evaluated_once_and_counted() {
    for targets in 0..9 {
        let model = Counted {
            inner: RandomModel::new(targets, true, 21),
            asked: Mutex::default(),
        };
        let statistics = run(&model, &alternatives(4)).statistics;
        let asked = model.asked.into_inner().expect("no thread panicked");
        assert!(asked.values().all(|&times| times == 1));
        let tours = asked
            .keys()
            .filter(|places| places.len() == targets)
            .count() as u64;
        assert_eq!(statistics.tours, tours);
        assert_eq!(statistics.prefixes, asked.len() as u64 - tours);
    }
}
