//! The bound on all tours where few legs are proved, beside that of all legs.

use super::*;
use crate::math::random::SplitMix;
use crate::model::attitude::Attitude;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::{AttitudeSpec, ScenarioSpec};
use crate::run::progress::Silent;
use crate::tour::legs::{LegKind, NoStore};
use crate::tour::planner::additive_tours::LegTimes;
use crate::tour::planner::places::MAX_TARGETS_ALL_LEGS;
use crate::tour::planner::tests::with_leg_solver;
use crate::tour::planner::tour_pairs;
use nalgebra::Vector3;

/// More targets than have all their legs proved, two of them with a place of their own.
fn many() -> ScenarioSpec {
    let mut spec = experiment_a();
    let mut random = SplitMix::new(3);
    let mut component = || random.below(2000) as f64 / 500.0 - 2.0;
    let first = spec.targets[0].clone();
    spec.targets = (0..MAX_TARGETS_ALL_LEGS + 4)
        .map(|index| {
            let turn = Vector3::from_fn(|_, _| component());
            let mut target = first.clone();
            target.id = format!("t{index}");
            target.attitude = AttitudeSpec::Quaternion(Attitude::from_rotation_vector(turn).xyzw());
            target
        })
        .collect();
    spec.targets[7].position = Some(1);
    spec.targets[3].position = Some(spec.targets.len());
    spec
}

/// The bound on all tours, s, where all legs are proved before, or none, and the share of the legs that are
/// not proved after.
fn bound(spec: &ScenarioSpec, all: bool) -> (f64, f64) {
    let scenario = Scenario::try_new(spec).expect("valid").scenario;
    let stop = StopSignal::new();
    with_leg_solver(&scenario, &Silent, &NoStore, &stop, |solver, run| {
        let places = solver.places();
        let pairs = tour_pairs(places);
        let prove = |pairs: &[_]| solver.certified_legs(LegKind::LowerBound, pairs);
        let proved = ProvedLegs::new(places, Box::new(prove));
        if all {
            proved.raise(&pairs);
        }
        let bound = tour_bound(places, &proved, run.pool, &stop).expect("limited rates");
        let open = pairs.iter().filter(|leg| proved.is_open(leg.0, leg.1));
        (bound, open.count() as f64 / pairs.len() as f64)
    })
}

#[test]
fn few_legs_have_the_bound_of_all() {
    let (all, few) = (bound(&many(), true), bound(&many(), false));
    assert!(all.1 <= 0.0 && few.1 > 0.5, "{few:?}");
    assert!((few.0 / all.0 - 1.0).abs() < 5e-3, "{few:?} {all:?}");
}

#[test]
fn places_in_the_order_raise_the_bound() {
    let mut free = many();
    for target in &mut free.targets {
        target.position = None;
    }
    let (fixed, free) = (bound(&many(), false).0, bound(&free, false).0);
    assert!(fixed > 1.005 * free, "{fixed} {free}");
}
