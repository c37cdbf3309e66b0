//! Every leg of the random suite is solved and verified.

use slewplan_solver::model::plan::Outcome;
use slewplan_solver::tour::planner;
use slewplan_tests::solving::{on_threads, scenario_of};
use slewplan_tests::suite::{LEGS_PER_SPACECRAFT, SPACECRAFT, leg};

/// How a leg failed; `None` when it converged, passed its verification and is no faster than its
/// certified bound.
fn failure(spacecraft: u64, number: u64) -> Option<String> {
    let scenario = scenario_of(&leg(spacecraft, number));
    match on_threads(1, |run| planner::solve(&scenario, run)) {
        Outcome::Planned(plan) if plan.verification.passed => {
            let leg = &plan.legs[0];
            let bound = leg.certified_lower_bound_s.unwrap_or(0.0);
            // The checker's relative tolerance of limits.
            (bound > leg.duration_s * (1.0 + 2e-6))
                .then(|| format!("spacecraft {spacecraft}, leg {number}: {leg:?}"))
        }
        outcome => Some(format!(
            "spacecraft {spacecraft}, leg {number}: {outcome:?}"
        )),
    }
}

#[test]
fn every_leg_of_the_random_suite_converges_and_is_verified() {
    let half = |parity: u64| {
        (0..SPACECRAFT)
            .flat_map(|spacecraft| (0..LEGS_PER_SPACECRAFT).map(move |leg| (spacecraft, leg)))
            .filter(move |(_, leg)| leg % 2 == parity)
            .filter_map(|(spacecraft, leg)| failure(spacecraft, leg))
            .collect::<Vec<_>>()
    };
    let failures: Vec<_> = std::thread::scope(|scope| {
        let other = scope.spawn(|| half(1));
        let mut all = half(0);
        all.extend(other.join().expect("the other half runs to its end"));
        all
    });
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Long intervals with small turns whose motion is curved by stored momentum: the number of integration
/// steps that they need does not follow from the turns.
#[test]
fn slow_motions_with_stored_momentum_are_integrated_accurately() {
    assert_eq!(failure(12, 6), None);
}
