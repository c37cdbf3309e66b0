//! Bounds before and after their proof.

use super::*;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::ScenarioSpec;
use crate::run::progress::Silent;
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegKind, NoStore};
use crate::tour::planner::tests::with_leg_solver;
use crate::tour::planner::tour_pairs;

/// Bounds of all legs before and after they are proved, s.
fn bounds(spec: &ScenarioSpec) -> Vec<[f64; 2]> {
    let scenario = Scenario::try_new(spec).expect("valid").scenario;
    with_leg_solver(
        &scenario,
        &Silent,
        &NoStore,
        &StopSignal::new(),
        |solver, _| {
            let places = solver.places();
            let prove = |pairs: &[_]| solver.certified_legs(LegKind::LowerBound, pairs);
            let proved = ProvedLegs::new(places, Box::new(prove));
            let pairs = tour_pairs(places);
            let all = || pairs.iter().map(|(from, to)| proved.leg_s(*from, *to));
            let before: Vec<f64> = all().collect();
            assert!(!proved.has_bounds() && pairs.iter().all(|leg| proved.is_open(leg.0, leg.1)));
            proved.raise(&pairs);
            assert!(!pairs.iter().any(|leg| proved.is_open(leg.0, leg.1)));
            before.into_iter().zip(all()).map(|(a, b)| [a, b]).collect()
        },
    )
}

#[test]
fn the_turn_at_the_largest_rate_is_a_smaller_bound() {
    for bias in [0.0, 20.0] {
        let mut spec = experiment_a();
        spec.start.wheel_speed_rad_s = Some([bias, -bias, bias].into());
        spec.end = None;
        let bounds = bounds(&spec);
        assert!(
            bounds
                .iter()
                .all(|[quick, proved]| 0.0 < *quick && quick <= proved),
            "{bounds:?}"
        );
    }
}

#[test]
fn without_limits_of_speed_nothing_is_known() {
    let mut spec = experiment_a();
    spec.spacecraft.max_body_rate_rad_s = [None; 3];
    for wheel in &mut spec.spacecraft.wheels {
        wheel.max_speed_rad_s = None;
    }
    let bounds = bounds(&spec);
    assert!(
        bounds.iter().flatten().all(|bound| bound.abs() < 1e-12),
        "{bounds:?}"
    );
}
