//! The search against exhaustive enumeration, on cost models whose neighbouring legs couple.

mod anytime;
mod exactness;
mod lagrangian;
mod models;
mod rules;
mod tightening;
mod triple_bounds;

use models::SplitMix;
pub(super) use models::{RandomModel, unit};

use super::{
    Incumbent, KnownOrders, SearchObserver, SearchResult, SearchSettings, TourModel, search,
};
use crate::run::pool::SolverPool;
use crate::run::progress::{Progress, Silent};
use crate::run::stop::StopSignal;
use std::num::NonZeroUsize;

impl SearchObserver for Silent {
    fn progress(&self, _: Progress) {}

    fn improved(&self, _: &Incumbent<'_>) {}
}

fn pool(threads: usize) -> SolverPool {
    SolverPool::new(NonZeroUsize::new(threads)).expect("test threads start")
}

fn alternatives(count: usize) -> SearchSettings {
    SearchSettings {
        alternatives: count,
        ..SearchSettings::default()
    }
}

/// Searches on two threads without limits or observers.
fn run(model: &dyn TourModel, settings: &SearchSettings) -> SearchResult {
    let (pool, stop) = (pool(2), StopSignal::new());
    search(
        model,
        KnownOrders::default(),
        settings,
        &pool,
        &stop,
        &Silent,
    )
}
