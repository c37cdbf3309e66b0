//! Prints how close certified bounds come to the durations of slews from rest to rest, by class:
//! the published table, the same with unequal ramps, and the random suite.

use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{LegRow, Shard, leg_table};
use slewplan_tests::experiment_c_spec;
use slewplan_tests::solving::{on_threads, scenario_of};
use slewplan_tests::suite::{LEGS_PER_SPACECRAFT, SPACECRAFT, leg};

/// Torques of the published wheels for unequal ramps, N m: ramp times in the ratios 2 : 1 : 5.
const UNEQUAL: [f64; 3] = [0.005, 0.0101, 0.002];

fn main() {
    let mut published = experiment_c_spec();
    published.end = None;
    let pairs = pairs(&published);
    assert_eq!(pairs.len(), 171);
    report("published, equal ramps", &pairs);
    for (wheel, torque) in published.spacecraft.wheels.iter_mut().zip(UNEQUAL) {
        wheel.max_torque_nm = torque;
    }
    published.targets.truncate(10);
    report("published, unequal ramps", &self::pairs(&published));
    for (group, name) in [
        "suite, any axes",
        "suite, momentum",
        "suite, any axes, rate limits",
        "suite, momentum, rate limits",
        "suite, little momentum, rate limits",
    ]
    .into_iter()
    .enumerate()
    {
        let crafts = (0..SPACECRAFT).filter(|craft| craft / 4 == group as u64);
        let legs = crafts.flat_map(|craft| (0..LEGS_PER_SPACECRAFT).map(move |n| leg(craft, n)));
        let rows: Vec<_> = legs.flat_map(|spec| rows(&spec, 2)).collect();
        report(name, &rows);
    }
}

/// One direction of every leg between the places of a scenario.
fn pairs(spec: &ScenarioSpec) -> Vec<LegRow> {
    let mut rows = rows(spec, 1);
    rows.retain(|row| row.from == "start" || (row.to != "start" && row.from < row.to));
    rows
}

/// The first of so many parts of the table.
fn rows(spec: &ScenarioSpec, parts: usize) -> Vec<LegRow> {
    let part = Shard {
        index: 0,
        of: parts,
    };
    let scenario = scenario_of(spec);
    on_threads(2, |run| {
        leg_table(&scenario, LegKind::RestToRest, part, run)
    })
    .0
}

fn report(name: &str, rows: &[LegRow]) {
    let bounds = rows
        .iter()
        .filter_map(|row| row.certified_lower_bound_s.zip(row.duration_s));
    let mut shares: Vec<f64> = bounds.map(|(bound, duration)| bound / duration).collect();
    shares.sort_by(f64::total_cmp);
    print!("{name}: {} legs, {} bounded", rows.len(), shares.len());
    if let (Some(least), Some(most)) = (shares.first(), shares.last()) {
        let median = shares[shares.len() / 2];
        print!("; bound / duration {least:.4} at least, median {median:.4}, {most:.6} at most");
    }
    println!();
}
