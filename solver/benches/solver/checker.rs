//! The independent verification.

use divan::Bencher;
use slewplan_solver::checker::verify;
use slewplan_tests::experiment_a_spec;
use slewplan_tests::solving::{plan_of, scenario_of};

/// One flight of experiment A, seven legs: integration and tests alone, nothing is optimised.
#[divan::bench]
fn experiment_a(bencher: Bencher) {
    let spec = experiment_a_spec();
    let (scenario, plan) = (scenario_of(&spec), plan_of(&spec));
    bencher.bench(|| verify(&scenario, &plan.flight));
}
