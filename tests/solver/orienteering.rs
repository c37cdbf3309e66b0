//! Published orienteering problems with windows have the published scores.

use slewplan_solver::tour::schedule::{SearchLimits, search};
use slewplan_tests::orienteering::instances;

#[test]
fn best_known_scores_are_reached_and_proved() {
    for instance in instances() {
        let (problem, distances) = instance.problem();
        let found = search(
            &problem,
            &distances,
            SearchLimits::default(),
            &|| false,
            &mut |_| (),
        );
        let score = found.best.map(|best| best.value);
        assert_eq!(score, Some(instance.best), "{instance:?}");
        assert!(found.complete, "{instance:?}");
    }
}
