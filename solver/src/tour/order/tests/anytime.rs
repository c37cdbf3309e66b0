//! Results of searches that end early, and reports of running searches.

use super::models::SLOW;
use super::{RandomModel, alternatives, pool, run};
use crate::model::order_rules::OrderRules;
use crate::run::progress::{Progress, Silent, Stage};
use crate::run::stop::{StopReason, StopSignal};
use crate::tour::order::{
    Evaluation, Incumbent, KnownOrders, Place, SearchEnd, SearchObserver, SearchSettings,
    SolvedOrder, TourEvaluation, TourModel, exhaustive, search,
};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Records all reports, and stops the search after a number of them.
struct Recorder {
    reported: Mutex<Vec<Progress>>,
    improved: Mutex<Vec<SolvedOrder>>,
    stop: StopSignal,
    stop_after: usize,
}

impl Recorder {
    fn new(stop_after: usize) -> Self {
        Self {
            reported: Mutex::default(),
            improved: Mutex::default(),
            stop: StopSignal::new(),
            stop_after,
        }
    }

    fn reported(self) -> Vec<Progress> {
        self.reported.into_inner().expect("no thread panicked")
    }
}

impl SearchObserver for Recorder {
    fn progress(&self, progress: Progress) {
        let mut reported = self.reported.lock().expect("no thread panicked");
        reported.push(progress);
        if reported.len() == self.stop_after {
            self.stop.request();
        }
    }

    fn improved(&self, incumbent: &Incumbent<'_>) {
        assert!(incumbent.lower_bound_s <= incumbent.best.duration_s);
        let mut improved = self.improved.lock().expect("no thread panicked");
        improved.push(incumbent.best.clone());
    }
}

/// A model that cancels the search during its evaluation number `stop_at`.
pub(super) struct StopsInside<'a> {
    pub(super) inner: RandomModel,
    pub(super) stop: &'a StopSignal,
    pub(super) evaluations: AtomicUsize,
    pub(super) stop_at: usize,
}

impl StopsInside<'_> {
    fn stopped(&self) -> bool {
        if self.evaluations.fetch_add(1, Ordering::Relaxed) + 1 >= self.stop_at {
            self.stop.cancel();
        }
        self.stop.is_set()
    }
}

impl TourModel for StopsInside<'_> {
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
        if self.stopped() {
            Evaluation::Stopped
        } else {
            self.inner.prefix_bound(prefix)
        }
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        if self.stopped() {
            Evaluation::Stopped
        } else {
            self.inner.path_bound(path)
        }
    }

    fn couples(&self, via: usize) -> bool {
        self.inner.couples(via)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        if self.stopped() {
            TourEvaluation::Stopped
        } else {
            self.inner.tour(order)
        }
    }
}

fn optimum(model: &dyn TourModel) -> f64 {
    exhaustive(model, 0, &pool(2))[0].duration_s
}

#[test]
fn a_search_within_a_node_limit_has_a_valid_bound() {
    for limit in [0, 1, 7, 8, 9, 40] {
        let model = RandomModel::new(7, true, 11);
        let settings = SearchSettings {
            node_limit: Some(limit),
            ..alternatives(1)
        };
        let result = run(&model, &settings);
        assert_eq!(result.end, SearchEnd::NodeLimit);
        assert_eq!(result.statistics.nodes_explored, limit);
        assert!(!result.complete);
        let optimum = optimum(&model);
        assert!(result.lower_bound_s <= optimum);
        assert!(optimum <= result.best.expect("a first order").duration_s);
    }
}

#[test]
fn a_search_stopped_between_rounds_returns_the_best_so_far() {
    let model = RandomModel::new(7, false, 12);
    let recorder = Recorder::new(4);
    let stop = recorder.stop.clone();
    let result = search(
        &model,
        KnownOrders::default(),
        &alternatives(1),
        &pool(2),
        &stop,
        &recorder,
    );
    assert_eq!(result.end, SearchEnd::Stopped(StopReason::Requested));
    assert!(!result.complete);
    let optimum = optimum(&model);
    assert!(result.lower_bound_s > 0.0 && result.lower_bound_s <= optimum);
    assert!(optimum <= result.best.expect("a first order").duration_s);
}

#[test]
fn a_search_stopped_during_an_evaluation_keeps_the_bound_of_that_node() {
    for stop_at in 1..40 {
        let stop = StopSignal::new();
        let model = StopsInside {
            inner: RandomModel::new(6, true, 13),
            stop: &stop,
            evaluations: AtomicUsize::new(0),
            stop_at,
        };
        let result = search(
            &model,
            KnownOrders::default(),
            &alternatives(0),
            &pool(2),
            &stop,
            &Silent,
        );
        let optimum = optimum(&model.inner);
        assert_eq!(result.end, SearchEnd::Stopped(StopReason::Cancelled));
        assert!(!result.complete && result.lower_bound_s <= optimum + 1e-9);
        assert_eq!(result.best.is_some(), stop_at > 1, "stopped at {stop_at}");
    }
}

#[test]
fn a_search_stopped_before_it_begins_has_a_bound_and_no_order() {
    let stop = StopSignal::new();
    stop.cancel();
    let model = RandomModel::new(5, true, 14);
    let result = search(
        &model,
        KnownOrders::default(),
        &alternatives(0),
        &pool(1),
        &stop,
        &Silent,
    );
    assert_eq!(result.end, SearchEnd::Stopped(StopReason::Cancelled));
    assert_eq!(result.best, None);
    assert!(result.lower_bound_s > 0.0 && result.lower_bound_s <= optimum(&model));
}

#[test]
fn unresolved_prefixes_do_not_change_the_result() {
    for seed in 0..20 {
        let mut model = RandomModel::new(6, seed % 2 == 0, seed);
        let expected = optimum(&model);
        model.fails = |prefix| prefix.len() < 6 && prefix[0] % 2 == 0;
        let result = run(&model, &alternatives(0));
        assert!(result.complete && result.statistics.prefixes_unresolved > 0);
        let found = result.best.expect("a best order").duration_s;
        assert!((found - expected).abs() < 1e-9 * expected);
    }
}

#[test]
fn an_unresolved_leaf_that_could_be_best_leaves_the_search_incomplete() {
    let mut open = 0;
    for seed in 0..20 {
        let mut model = RandomModel::new(5, seed % 2 == 0, seed);
        let truth = optimum(&model);
        model.fails = |order| order.len() == 5 && order[4] < 3;
        let result = run(&model, &alternatives(0));
        let found = result
            .best
            .as_ref()
            .expect("other orders resolve")
            .duration_s;
        assert_eq!(result.end, SearchEnd::Exhausted);
        // The true optimum, which may be an unresolved order, must respect the bound.
        assert!(result.lower_bound_s <= truth + 1e-9);
        if found > truth {
            assert!(!result.complete && !result.best_is_proven(0.0));
            open += 1;
        }
    }
    assert!(open > 5, "only {open} cases test anything");
}

#[test]
fn a_search_in_which_nothing_resolves_has_a_bound_and_no_order() {
    for targets in [0, 1, 4] {
        let mut model = RandomModel::new(targets, true, 3);
        let truth = optimum(&model);
        model.fails = |_| true;
        let result = run(&model, &alternatives(1));
        assert_eq!((&result.best, result.complete), (&None, false));
        assert!(result.lower_bound_s > 0.0 && result.lower_bound_s <= truth);
    }
}

#[test]
fn a_flight_that_is_no_minimum_is_found_and_closes_no_order() {
    for seed in 0..10 {
        let mut model = RandomModel::new(4, seed % 2 == 0, seed);
        let truth = optimum(&model);
        model.fails = |order| order.len() == 4;
        model.flyable = true;
        let result = run(&model, &alternatives(0));
        let found = result.best.as_ref().expect("a flight").duration_s;
        assert!((found - SLOW * truth).abs() < 1e-9 * found, "seed {seed}");
        assert!(result.lower_bound_s <= truth + 1e-9);
        assert!(!result.complete && !result.best_is_proven(0.0));
        // Nor where it is known before the search.
        let known = [0, 1, 2, 3];
        let settings = alternatives(0);
        let first = KnownOrders {
            evaluated: Some((&known, model.tour(&known))),
            first: None,
        };
        let stop = StopSignal::new();
        let again = search(&model, first, &settings, &pool(1), &stop, &Silent);
        assert!(!again.complete && again.lower_bound_s <= truth + 1e-9);
    }
}

#[test]
fn dropped_nodes_leave_the_search_incomplete_and_the_bound_valid() {
    let model = RandomModel::new(7, false, 15);
    let settings = SearchSettings {
        frontier_bytes: 0,
        ..alternatives(3)
    };
    let result = run(&model, &settings);
    assert!(result.statistics.dropped > 0 && !result.complete);
    assert!(result.lower_bound_s <= optimum(&model) + 1e-9);
}

#[test]
fn bounds_that_are_not_admissible_are_counted() {
    let mut model = RandomModel::new(6, true, 16);
    model.known_share = 4.0;
    let result = run(&model, &alternatives(5));
    assert!(result.statistics.bounds_contradicted > 0);
    assert!(result.lower_bound_s <= result.best.expect("a best order").duration_s);
}

#[test]
fn reported_incumbents_never_rise_and_bounds_never_fall() {
    for seed in 0..6 {
        let recorder = Recorder::new(usize::MAX);
        let model = RandomModel::new(7, seed % 2 == 0, seed);
        let result = search(
            &model,
            KnownOrders::default(),
            &alternatives(2),
            &pool(2),
            &StopSignal::new(),
            &recorder,
        );
        let reported = recorder.reported();
        assert!(reported.len() > 2 && reported.iter().all(|p| p.stage == Stage::Search));
        for pair in reported.windows(2) {
            assert!(pair[0].done <= pair[1].done);
            assert!(pair[0].lower_bound_s <= pair[1].lower_bound_s);
            assert!(pair[0].incumbent_s >= pair[1].incumbent_s);
        }
        let last = reported[reported.len() - 1];
        assert!(reported.iter().all(|p| p.lower_bound_s <= last.incumbent_s));
        assert_eq!(last.done, result.statistics.nodes_explored);
        assert_eq!(last.incumbent_s, result.best.map(|best| best.duration_s));
    }
}

#[test]
fn searches_over_many_targets_have_an_order_and_a_bound_at_any_node_limit() {
    let mut bounds = Vec::new();
    for limit in [0, 60] {
        let model = RandomModel::new(21, true, 17);
        let settings = SearchSettings {
            node_limit: Some(limit),
            ..alternatives(1)
        };
        let result = run(&model, &settings);
        let best = result.best.expect("a first order");
        let mut targets = best.order.clone();
        targets.sort_unstable();
        assert!(targets.into_iter().eq(0..21));
        assert!(result.lower_bound_s > 0.0 && result.lower_bound_s <= best.duration_s);
        assert_eq!(result.end, SearchEnd::NodeLimit);
        bounds.push(result.lower_bound_s);
    }
    assert!(bounds[0] <= bounds[1]);
}

#[test]
fn a_search_over_many_targets_ends_once_the_gap_is_reached() {
    let model = RandomModel::new(24, true, 18);
    let within = |relative_gap| {
        let settings = SearchSettings {
            relative_gap,
            node_limit: Some(0),
            ..alternatives(0)
        };
        run(&model, &settings)
    };
    let (wide, none) = (within(0.9), within(0.0));
    assert!(wide.complete && wide.best_is_proven(0.9));
    assert!(!none.complete);
    let tours = [wide, none].map(|found| found.statistics.tours);
    assert!(tours[0] < tours[1], "{tours:?}");
}

#[test]
fn every_better_order_is_announced_once_before_its_progress() {
    let mut better = 0;
    for seed in 0..10 {
        let recorder = Recorder::new(usize::MAX);
        let model = RandomModel::new(7, seed % 2 == 0, seed);
        let stop = StopSignal::new();
        let result = search(
            &model,
            KnownOrders::default(),
            &alternatives(1),
            &pool(2),
            &stop,
            &recorder,
        );
        assert!(result.complete);
        let improved = recorder
            .improved
            .lock()
            .expect("no thread panicked")
            .clone();
        let durations: Vec<f64> = improved.iter().map(|order| order.duration_s).collect();
        assert!(durations.windows(2).all(|pair| pair[1] < pair[0]));
        for order in &improved {
            let solved = TourEvaluation::Solved(order.duration_s);
            assert_eq!(model.tour(&order.order), solved, "seed {seed}");
        }
        let reported = recorder.reported();
        let (_, while_running) = reported.split_last().expect("at least one report");
        for progress in while_running {
            let incumbent = progress
                .incumbent_s
                .expect("candidates are evaluated first");
            assert!(durations.contains(&incumbent), "seed {seed}");
        }
        better += improved.len() - 1;
    }
    assert!(better > 0, "no search found a better order after its first");
}
