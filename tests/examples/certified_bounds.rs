//! Prints how close proved bounds come to durations, by class: legs from rest to rest of the published table,
//! of the same with unequal ramps, of the random suite, and tours of the published experiments.
//!
//! Of every class first the bounds that steer the search, by boxes of rates, then the strongest that are
//! proved. The argument is a part of the names of the classes that are wanted.

use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{
    LegRow, ProofEffort, Shard, StrongestBounds, leg_table, strongest_bounds,
};
use slewplan_tests::solving::{on_threads, plan_of, scenario_of};
use slewplan_tests::suite::{LEGS_PER_SPACECRAFT, SPACECRAFT, leg};
use slewplan_tests::{experiment_a_spec, experiment_b_spec, experiment_c_spec};
use std::ops::Range;
use std::time::Instant;

/// Torques of the published wheels for unequal ramps, N m: ramp times in the ratios 2 : 1 : 5.
const UNEQUAL: [f64; 3] = [0.005, 0.0101, 0.002];

/// The groups of the random suite.
const GROUPS: [&str; 5] = [
    "suite, any axes",
    "suite, momentum",
    "suite, any axes, rate limits",
    "suite, momentum, rate limits",
    "suite, little momentum, rate limits",
];

/// More spacecraft than the suite has, with momentum.
const FURTHER: &str = "further spacecraft, momentum";

/// Shares of the duration of a leg that are proved.
struct Share {
    boxed: Option<f64>,
    strongest: Option<f64>,
    is_confirmed: bool,
}

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    let is_asked = |name: &str| name.contains(&asked);
    if is_asked("published") {
        published();
    }
    for (group, name) in GROUPS.into_iter().enumerate() {
        let first = 4 * group as u64;
        if is_asked(name) {
            suite(first..first + 4, name);
        }
    }
    if is_asked(FURTHER) {
        suite(SPACECRAFT..3 * SPACECRAFT, FURTHER);
    }
    for (name, spec) in [
        ("experiment A", experiment_a_spec()),
        ("experiment B", experiment_b_spec()),
        ("experiment C", experiment_c_spec()),
    ] {
        if is_asked(name) {
            tour(name, &spec);
        }
    }
}

/// The legs of the published table, and of the same with unequal ramps.
fn published() {
    let mut published = experiment_c_spec();
    published.end = None;
    for target in &mut published.targets {
        target.zero_rate_axes = None;
    }
    let pairs = pairs(&published);
    assert_eq!(pairs.len(), 171);
    report("published, equal ramps", &pairs);
    for (wheel, torque) in published.spacecraft.wheels.iter_mut().zip(UNEQUAL) {
        wheel.max_torque_nm = torque;
    }
    published.targets.truncate(10);
    report("published, unequal ramps", &self::pairs(&published));
}

/// The legs of some spacecraft of the random suite, or made like it.
fn suite(crafts: Range<u64>, name: &str) {
    let legs = crafts.flat_map(|craft| (0..LEGS_PER_SPACECRAFT).map(move |n| leg(craft, n)));
    let shares: Vec<_> = legs
        .flat_map(|spec| shares(&spec, &rows(&spec, 2)))
        .collect();
    report(name, &shares);
}

/// The bounds on the tour of an experiment, and on the legs of its plan.
fn tour(name: &str, spec: &ScenarioSpec) {
    let plan = plan_of(spec);
    let legs: Vec<_> = plan
        .legs
        .iter()
        .map(|leg| (leg.from.clone(), leg.to.clone()))
        .collect();
    let begin = Instant::now();
    let StrongestBounds {
        legs: strongest,
        tour: strongest_tour,
    } = on_threads(2, |run| {
        strongest_bounds(&scenario_of(spec), &legs, ProofEffort::Confirmed, run)
    });
    let time = begin.elapsed().as_secs_f64();
    let share = |bound: Option<f64>| bound.map_or(f64::NAN, |bound| bound / plan.total_time_s);
    println!(
        "{name}: tour {:.4}, strongest {:.4}, in {time:.3} s",
        share(plan.certified_lower_bound_s),
        share(strongest_tour.map(|tour| tour.bound_s))
    );
    let bounds = plan
        .legs
        .iter()
        .zip(strongest)
        .map(|(leg, strongest)| Share {
            boxed: leg
                .certified_lower_bound_s
                .map(|bound| bound / leg.duration_s),
            strongest: strongest.map(|bound| bound.bound_s / leg.duration_s),
            is_confirmed: strongest.is_some_and(|bound| bound.is_confirmed),
        });
    report(
        &format!("its {} legs", plan.legs.len()),
        &bounds.collect::<Vec<_>>(),
    );
}

/// One direction of every leg between the places of a scenario.
fn pairs(spec: &ScenarioSpec) -> Vec<Share> {
    let mut rows = rows(spec, 1);
    rows.retain(|row| row.from == "start" || (row.to != "start" && row.from < row.to));
    shares(spec, &rows)
}

/// The shares of the durations of legs that are proved.
fn shares(spec: &ScenarioSpec, rows: &[LegRow]) -> Vec<Share> {
    let names: Vec<_> = rows
        .iter()
        .map(|row| (row.from.clone(), row.to.clone()))
        .collect();
    let bounds = on_threads(2, |run| {
        strongest_bounds(&scenario_of(spec), &names, ProofEffort::Confirmed, run)
    });
    let share = |bound: Option<f64>, row: &LegRow| Some(bound? / row.duration_s?);
    rows.iter()
        .zip(bounds.legs)
        .map(|(row, strongest)| Share {
            boxed: share(row.certified_lower_bound_s, row),
            strongest: share(strongest.map(|bound| bound.bound_s), row),
            is_confirmed: strongest.is_some_and(|bound| bound.is_confirmed),
        })
        .collect()
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

fn report(name: &str, shares: &[Share]) {
    print!("{name}: {} legs", shares.len());
    print_range("boxes", shares.iter().filter_map(|share| share.boxed));
    print_range(
        "strongest",
        shares.iter().filter_map(|share| share.strongest),
    );
    let confirmed = shares.iter().filter(|share| share.is_confirmed).count();
    println!("; {confirmed} confirmed");
}

fn print_range(kind: &str, shares: impl Iterator<Item = f64>) {
    let mut known: Vec<f64> = shares.collect();
    known.sort_by(f64::total_cmp);
    if let (Some(least), Some(most)) = (known.first(), known.last()) {
        let (count, median) = (known.len(), known[known.len() / 2]);
        print!(
            "; {kind}: {count} bounded, {least:.4} at least, median {median:.4}, {most:.6} at most"
        );
    }
}
