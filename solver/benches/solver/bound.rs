//! The certified kinematic bounds, on the 171 turns of experiment C in turn.

use divan::{Bencher, black_box};
use nalgebra::Vector3;
use slewplan_solver::bounds::kinematic::RateBox;
use slewplan_solver::model::attitude::Attitude;
use slewplan_tests::experiment_c_spec;
use slewplan_tests::solving::scenario_of;

/// Relative tolerance of a query: small beside the accuracy of solved legs, 0.05 %.
const TOLERANCE: f64 = 1e-4;

fn rates() -> Vector3<f64> {
    let scenario = scenario_of(&experiment_c_spec());
    let craft = scenario.spacecraft();
    let limit = |i: usize| {
        let wheel = &craft.wheels()[i];
        let by_wheel = wheel.inertia * wheel.max_speed / craft.inertia()[(i, i)];
        by_wheel.min(craft.max_rate()[i])
    };
    Vector3::new(limit(0), limit(1), limit(2))
}

fn turns() -> Vec<Attitude> {
    let scenario = scenario_of(&experiment_c_spec());
    let targets = scenario.targets().iter().map(|target| target.attitude);
    let places: Vec<_> = std::iter::once(scenario.start().attitude)
        .chain(targets)
        .collect();
    let pairs = places.iter().enumerate();
    pairs
        .flat_map(|(i, from)| places[i + 1..].iter().map(|to| to.turn_to(from)))
        .collect()
}

/// Construction of the table of extremals, once per spacecraft.
#[divan::bench]
fn table(bencher: Bencher) {
    let rates = rates();
    bencher.bench(|| RateBox::new(black_box(rates)));
}

/// One query of the table: the branch and bound over extremals.
#[divan::bench(sample_count = 171, sample_size = 1)]
fn query(bencher: Bencher) {
    let (table, turns) = (RateBox::new(rates()).expect("ordinary rates"), turns());
    let mut next = turns.iter().cycle();
    bencher
        .with_inputs(|| next.next().copied())
        .bench_local_values(|turn| turn.map(|turn| table.lower_bound(&turn, TOLERANCE)));
}
