//! Tours in a fixed order: the multi-phase program, which has no search.

use divan::Bencher;
use divan::counter::ItemsCount;
use nalgebra::Vector3;
use slewplan_solver::attitude::Attitude;
use slewplan_solver::legs::{LegStore, StoredLeg};
use slewplan_solver::planner::{Run, fly_order};
use slewplan_solver::scenario::Scenario;
use slewplan_solver::spec::{AttitudeSpec, ScenarioSpec, TargetSpec};
use slewplan_tests::experiment_a_spec;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, planned, scenario_of};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// Remembers legs, to set them apart from the program of the tour.
#[derive(Default)]
struct Memory(Mutex<HashMap<String, StoredLeg>>);

impl LegStore for Memory {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        let legs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        legs.get(identity).cloned()
    }

    fn put(&self, identity: &str, leg: &StoredLeg) {
        let mut legs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        legs.insert(identity.into(), leg.clone());
    }
}

/// Flies the targets in the order in which they are listed, by one thread; the items counted are
/// the phases.
fn fly(bencher: Bencher<'_, '_>, scenario: &Scenario, legs_are_known: bool) {
    let order: Vec<usize> = (0..scenario.targets().len()).collect();
    let phases = order.len() + usize::from(scenario.end().is_some());
    let memory = Memory::default();
    on_threads(1, |run| {
        let filling = Run {
            legs: &memory,
            ..run
        };
        let plan = planned(fly_order(scenario, &order, filling).expect("an order"));
        assert_eq!(plan.legs.len(), phases);
        let run = if legs_are_known { filling } else { run };
        bencher
            .counter(ItemsCount::new(phases))
            .bench_local(|| fly_order(scenario, &order, run));
    });
}

/// Targets at which only the z rate vanishes, each turned against the one before by 40 to 80
/// degrees about any axis: the program does not fall into pieces, no leg is like another, and a
/// longer tour has legs of the same kind as a shorter one.
fn walk(targets: usize) -> Scenario {
    let mut generator = Generator::new(0);
    let mut attitude = Attitude::identity();
    let targets = (0..targets).map(|i| {
        let angle = generator.between(40.0, 80.0).to_radians();
        let turn = Vector3::from(generator.direction()) * angle;
        attitude = attitude.then_in_body(&Attitude::from_rotation_vector(turn));
        TargetSpec {
            id: format!("t{i}"),
            attitude: AttitudeSpec::Quaternion(attitude.xyzw()),
            zero_rate_axes: Some([false, false, true]),
            ..TargetSpec::default()
        }
    });
    scenario_of(&ScenarioSpec {
        targets: targets.collect(),
        end: None,
        ..experiment_a_spec()
    })
}

/// The best order of experiment A when nothing is known: legs, tour and verification.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn experiment_a(bencher: Bencher) {
    fly(bencher, &scenario_of(&experiment_a_spec()), false);
}

/// The same when its legs are known: the multi-phase program and the verification alone.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn experiment_a_with_known_legs(bencher: Bencher) {
    fly(bencher, &scenario_of(&experiment_a_spec()), true);
}

/// Growth with the number of phases, everything included: the rate of items is to stay the same.
#[divan::bench(args = [10, 20, 50, 100], sample_count = 3, sample_size = 1)]
fn phases(bencher: Bencher, targets: usize) {
    fly(bencher, &walk(targets), false);
}

/// Growth of the multi-phase program and the verification alone.
#[divan::bench(args = [10, 20, 50, 100], sample_count = 3, sample_size = 1)]
fn phases_with_known_legs(bencher: Bencher, targets: usize) {
    fly(bencher, &walk(targets), true);
}
