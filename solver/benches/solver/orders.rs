//! Tours in a fixed order: the multi-phase program without a search.

use divan::Bencher;
use divan::counter::ItemsCount;
use nalgebra::Vector3;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeSpec, TargetSpec};
use slewplan_solver::tour::legs::{LegStore, StoredLeg};
use slewplan_solver::tour::planner::{BoundFrom, Run, solve_order};
use slewplan_tests::experiment_a_spec;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, planned, scenario_of};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// A store of legs, to measure the program of the tour without them.
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

/// What is known or solved before a tour is solved.
#[derive(Clone, Copy)]
enum Given {
    /// Nothing, and no leg is solved: one program from eigenaxis slews.
    ColdStart,
    /// Nothing; the legs are solved first.
    Nothing,
    /// The legs are stored.
    Legs,
}

/// Measures the tours through the targets in the order in which they are listed, on one thread; the
/// items counted are the phases.
fn measure(bencher: Bencher<'_, '_>, tours: &[Scenario], given: Given) {
    let effort = match given {
        Given::ColdStart => BoundFrom::Certificates,
        Given::Nothing | Given::Legs => BoundFrom::Legs,
    };
    let memory = Memory::default();
    on_threads(1, |run| {
        let filling = Run {
            legs: &memory,
            ..run
        };
        let solve = |tour: &Scenario, run| {
            let order: Vec<usize> = (0..tour.targets().len()).collect();
            planned(solve_order(tour, &order, effort, run).expect("an order"))
        };
        let phases: usize = tours
            .iter()
            .map(|tour| solve(tour, filling).legs.len())
            .sum();
        let run = match given {
            Given::ColdStart | Given::Nothing => run,
            Given::Legs => filling,
        };
        bencher.counter(ItemsCount::new(phases)).bench_local(|| {
            tours
                .iter()
                .map(|tour| solve(tour, run))
                .collect::<Vec<_>>()
        });
    });
}

/// Number of phases of [`walk`].
const WALK: usize = 100;

/// A random walk cut into tours of so many phases. At its targets only the z rate vanishes, and
/// each target is turned by 40 to 80 degrees about a random axis from the one before. So no tour
/// falls into segments, no two legs are equal, and tours of every length have the same legs.
fn walk(phases: usize) -> Vec<Scenario> {
    let mut generator = Generator::new(0);
    let mut attitude = Attitude::identity();
    let mut step = || {
        let angle = generator.between(40.0, 80.0).to_radians();
        let turn = Vector3::from(generator.direction()) * angle;
        attitude = attitude.then_in_body(&Attitude::from_rotation_vector(turn));
        AttitudeSpec::Quaternion(attitude.xyzw())
    };
    let mut start = AttitudeSpec::default();
    let tours = (0..WALK / phases).map(|_| {
        let mut spec = experiment_a_spec();
        spec.start.attitude = start.clone();
        spec.end = None;
        spec.targets = (0..phases)
            .map(|i| TargetSpec {
                id: format!("t{i}"),
                attitude: step(),
                zero_rate_axes: Some([false, false, true]),
                ..TargetSpec::default()
            })
            .collect();
        start = spec.targets[phases - 1].attitude.clone();
        scenario_of(&spec)
    });
    tours.collect()
}

/// The best order of experiment A.
fn best_of_a() -> [Scenario; 1] {
    let mut spec = experiment_a_spec();
    spec.targets.reverse();
    [scenario_of(&spec)]
}

/// The best order of experiment A as one program from a cold start, with its verification.
#[divan::bench(sample_count = 50, sample_size = 1)]
fn experiment_a(bencher: Bencher) {
    measure(bencher, &best_of_a(), Given::ColdStart);
}

/// The same as in the search: legs first, then the program from two initial guesses.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn experiment_a_from_legs(bencher: Bencher) {
    measure(bencher, &best_of_a(), Given::Nothing);
}

/// The same when its legs are known.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn experiment_a_with_known_legs(bencher: Bencher) {
    measure(bencher, &best_of_a(), Given::Legs);
}

/// A hundred phases in tours of so many phases: the time per phase should not depend on their
/// number.
#[divan::bench(args = [10, 20, 50, 100], sample_count = 5, sample_size = 1)]
fn phases(bencher: Bencher, in_a_tour: usize) {
    measure(bencher, &walk(in_a_tour), Given::ColdStart);
}

/// The same with legs and two programs.
#[divan::bench(args = [10, 20, 50, 100], sample_count = 3, sample_size = 1)]
fn phases_from_legs(bencher: Bencher, in_a_tour: usize) {
    measure(bencher, &walk(in_a_tour), Given::Nothing);
}
