//! Random bodies with random wheels: every feasible scenario is solved.

use slewplan_solver::model::plan::Outcome;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::outcome_of;

/// Twenty seeds, and two whose long intervals are the most difficult to integrate.
fn seeds() -> impl Iterator<Item = u64> {
    (100..120).chain([213, 227])
}

#[test]
fn scenarios_of_random_spacecraft_are_solved_and_verified() {
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
