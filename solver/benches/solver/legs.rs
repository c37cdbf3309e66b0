//! Legs from rest to rest, with all starts.

use divan::Bencher;
use divan::counter::ItemsCount;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{Shard, leg_table};
use slewplan_tests::solving::{on_threads, scenario_of};
use slewplan_tests::{experiment_c_spec, published_targets_spec};

/// Pairs of the start and 18 targets.
const PAIRS: usize = 19 * 18 / 2;
const ALL: Shard = Shard { index: 0, of: 1 };

/// One leg with both directions from one solve, from a cold start.
#[divan::bench(args = ["a", "n", "r"], sample_count = 50, sample_size = 1)]
fn from_start(bencher: Bencher, target: &str) {
    let scenario = scenario_of(&published_targets_spec(&[target]));
    on_threads(1, |run| {
        bencher.bench_local(|| leg_table(&scenario, LegKind::RestToRest, ALL, run));
    });
}

/// All pairs of experiment C, counted as items; equal legs share one solve.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn experiment_c(bencher: Bencher) {
    let mut spec = experiment_c_spec();
    spec.end = None;
    let scenario = scenario_of(&spec);
    on_threads(1, |run| {
        bencher
            .counter(ItemsCount::new(PAIRS))
            .bench_local(|| leg_table(&scenario, LegKind::RestToRest, ALL, run));
    });
}
