//! Random bodies with random wheels: whatever is asked within their means is flown.

use slewplan_solver::model::plan::Outcome;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::outcome_of;

/// A run of seeds, and two whose long intervals ask most of the integration.
fn seeds() -> impl Iterator<Item = u64> {
    (100..120).chain([213, 227])
}

#[test]
fn random_arrays_fly_their_slews() {
    let mut failed = Vec::new();
    for seed in seeds() {
        let spec = Generator::new(seed).single_slews();
        match outcome_of(&spec) {
            Outcome::Planned(plan) if plan.verification.passed => {}
            other => failed.push((seed, other)),
        }
    }
    let all = seeds().count();
    println!("{} of {all} random spacecraft solved", all - failed.len());
    assert!(failed.is_empty(), "not solved, by seed: {failed:#?}");
}
