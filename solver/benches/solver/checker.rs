//! The independent verification.

use divan::Bencher;
use slewplan_solver::checker::verify;
use slewplan_tests::experiment_a_spec;
use slewplan_tests::solving::{plan_of, scenario_of};

/// Verification of one flight of experiment A with seven legs: integration and checks, no
/// optimization.
#[divan::bench]
fn experiment_a(bencher: Bencher) {
    let spec = experiment_a_spec();
    let (scenario, plan) = (scenario_of(&spec), plan_of(&spec));
    bencher.bench(|| verify(&scenario, &plan.flight));
}
