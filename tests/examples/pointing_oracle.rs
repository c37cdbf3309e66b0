//! Twenty random scenarios of four and five pointed targets at rest: is the plan as short as the best of
//! all orders and rolls?
//!
//! The oracle knows no free roll. Every target is replaced by rest-to-rest targets with given rolls all
//! around, and the shortest path through one roll of each, in any order, is found by a dynamic program
//! over the table of their legs; then again with finer rolls around the best ones. Takes some minutes.
//! With numbers, only the scenarios with these seeds.

use slewplan_solver::model::spec::{
    AttitudeSpec, BoresightChoice, ScenarioSpec, StateSpec, TargetSpec,
};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{Shard, leg_table, solve};
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, planned, scenario_of};
use slewplan_tests::{experiment_a_spec, pointed_target, pyramid_spec};
use std::collections::HashMap;
use std::time::Instant;

/// Scenarios, and the relative excess of a plan over the oracle that is accepted.
const COUNT: u64 = 20;
const ACCEPTED: f64 = 1e-3;
/// Distances of rolls, degrees, in the rounds of the oracle, and rolls on either side of the best one.
const SPACINGS_DEG: [f64; 4] = [15.0, 5.0, 1.5, 0.5];
const AROUND: i32 = 2;

/// A direction with the limits of the roll, degrees.
struct Pointed {
    ra_dec_deg: [f64; 2],
    roll_deg: Option<[f64; 2]>,
}

fn main() {
    let chosen: Vec<u64> = std::env::args()
        .skip(1)
        .map(|seed| seed.parse().expect("a seed"))
        .collect();
    let seeds = if chosen.is_empty() {
        (0..COUNT).collect()
    } else {
        chosen
    };
    let mut worst: f64 = 0.0;
    for seed in seeds {
        let (spec, targets, boresight) = scenario(seed);
        let begin = Instant::now();
        let scenario = scenario_of(&spec);
        let plan = on_threads(2, |run| planned(solve(&scenario, run)));
        let plan_time = begin.elapsed().as_secs_f64();
        let found: Vec<&str> = plan.flight.passages.iter().map(|p| &*p.target).collect();
        let (order, best_s) = oracle(&spec, &targets, boresight);
        let order: Vec<String> = order.iter().map(|i| format!("t{i}")).collect();
        let ratio = plan.total_time_s / best_s;
        worst = worst.max(ratio);
        println!(
            "seed {seed}: {} targets, {found:?} {:.4} s ({:?}), oracle {order:?} {best_s:.4} s, ratio {ratio:.6}, \
             bound {:.4}, certified {:.4}, {plan_time:.1} s and {:.1} s",
            targets.len(),
            plan.total_time_s,
            plan.optimality,
            plan.lower_bound_s / plan.total_time_s,
            plan.certified_lower_bound_s.unwrap_or(0.0) / plan.total_time_s,
            begin.elapsed().as_secs_f64() - plan_time,
        );
    }
    println!("largest ratio {worst:.6}");
    assert!(worst <= 1.0 + ACCEPTED);
}

/// A random scenario: its targets as pointings, and the boresight.
fn scenario(seed: u64) -> (ScenarioSpec, Vec<Pointed>, [f64; 3]) {
    let mut generator = Generator::new(9000 + seed);
    let mut spec = if seed % 3 == 2 {
        pyramid_spec()
    } else {
        experiment_a_spec()
    };
    let boresight = generator.vector(-1.0, 1.0);
    let count = if seed.is_multiple_of(2) { 4 } else { 5 };
    let targets: Vec<Pointed> = (0..count)
        .map(|i| {
            let middle = generator.between(-180.0, 180.0);
            let half = generator.between(10.0, 60.0);
            Pointed {
                ra_dec_deg: [
                    generator.between(0.0, 360.0),
                    generator.between(-1.0, 1.0).asin().to_degrees(),
                ],
                roll_deg: (seed % 4 == 3 && i % 2 == 0).then_some([middle - half, middle + half]),
            }
        })
        .collect();
    let target = |(i, target): (usize, &Pointed)| {
        pointed_target(
            &format!("t{i}"),
            boresight,
            target.ra_dec_deg,
            target.roll_deg,
        )
    };
    spec.targets = targets.iter().enumerate().map(target).collect();
    spec.end = (seed % 5 != 4).then(StateSpec::default);
    (spec, targets, boresight)
}

/// The best order and its duration, s.
fn oracle(spec: &ScenarioSpec, targets: &[Pointed], boresight: [f64; 3]) -> (Vec<usize>, f64) {
    let all_around = |target: &Pointed| -> Vec<f64> {
        let [least, greatest] = target.roll_deg.unwrap_or([-180.0, 180.0 - SPACINGS_DEG[0]]);
        let spacing = SPACINGS_DEG[0].min(greatest - least);
        let parts = (0..).take_while(|i| f64::from(*i) * spacing <= greatest - least);
        // The last one may be less than a spacing from the greatest roll, which is admissible too.
        let rolls = parts.map(|i| least + spacing * f64::from(i));
        rolls.chain([greatest]).collect()
    };
    let mut rolls: Vec<Vec<f64>> = targets.iter().map(all_around).collect();
    let mut best = shortest(spec, targets, boresight, &rolls);
    for spacing in &SPACINGS_DEG[1..] {
        // The order may change as the rolls become finer.
        for (target, (rolls, at)) in targets.iter().zip(rolls.iter_mut().zip(&best.rolls)) {
            let [least, greatest] = target.roll_deg.unwrap_or([f64::MIN, f64::MAX]);
            let near = (-AROUND..=AROUND).map(|i| at + spacing * f64::from(i));
            *rolls = near.map(|roll| roll.clamp(least, greatest)).collect();
            rolls.dedup();
        }
        let finer = shortest(spec, targets, boresight, &rolls);
        if finer.duration_s <= best.duration_s {
            best = finer;
        }
    }
    (best.order, best.duration_s)
}

struct Shortest {
    order: Vec<usize>,
    rolls: Vec<f64>,
    duration_s: f64,
}

/// The shortest path through one of the rolls of every target.
fn shortest(
    spec: &ScenarioSpec,
    targets: &[Pointed],
    boresight: [f64; 3],
    rolls: &[Vec<f64>],
) -> Shortest {
    let mut fixed = spec.clone();
    fixed.targets.clear();
    let mut nodes = Vec::new();
    for (i, (target, rolls)) in targets.iter().zip(rolls).enumerate() {
        for (k, roll) in rolls.iter().enumerate() {
            let [ra, dec] = target.ra_dec_deg;
            nodes.push((i, k));
            fixed.targets.push(TargetSpec {
                id: format!("{i}-{k}"),
                attitude: AttitudeSpec::RaDecRollDeg {
                    angles: [ra, dec, *roll],
                    boresight: BoresightChoice::Axis(boresight),
                },
                ..TargetSpec::default()
            });
        }
    }
    let scenario = scenario_of(&fixed);
    let whole = Shard { index: 0, of: 1 };
    let (rows, complete) = on_threads(2, |run| {
        leg_table(&scenario, LegKind::RestToRest, whole, run)
    });
    assert!(complete);
    let legs: HashMap<(&str, &str), f64> = rows
        .iter()
        .filter_map(|row| Some(((&*row.from, &*row.to), row.duration_s?)))
        .collect();
    let names: Vec<String> = nodes.iter().map(|(i, k)| format!("{i}-{k}")).collect();
    let leg = |from: &str, to: &str| legs.get(&(from, to)).copied().unwrap_or(f64::INFINITY);
    // Least time to have visited a set of targets, the last one with a roll.
    let mut least: HashMap<(u32, usize), (f64, Option<usize>)> = HashMap::new();
    for (node, (target, _)) in nodes.iter().enumerate() {
        least.insert((1 << target, node), (leg("start", &names[node]), None));
    }
    let every = (1_u32 << targets.len()) - 1;
    for set in 1..=every {
        for (from, (of, _)) in nodes.iter().enumerate() {
            let Some((elapsed, _)) = least
                .get(&(set, from))
                .copied()
                .filter(|_| set >> of & 1 == 1)
            else {
                continue;
            };
            for (to, (next, _)) in nodes.iter().enumerate() {
                if set >> next & 1 == 0 {
                    let arrived = elapsed + leg(&names[from], &names[to]);
                    let entry = least.entry((set | 1 << next, to));
                    let entry = entry.or_insert((f64::INFINITY, None));
                    if arrived < entry.0 {
                        *entry = (arrived, Some(from));
                    }
                }
            }
        }
    }
    let total = |node: usize| {
        let home = if spec.end.is_some() {
            leg(&names[node], "end")
        } else {
            0.0
        };
        least
            .get(&(every, node))
            .map_or(f64::INFINITY, |(elapsed, _)| elapsed + home)
    };
    let last = (0..nodes.len()).min_by(|a, b| total(*a).total_cmp(&total(*b)));
    let last = last.expect("there are targets");
    let duration_s = total(last);
    let (mut order, mut chosen, mut set, mut node) =
        (Vec::new(), vec![0.0; targets.len()], every, Some(last));
    while let Some(at) = node {
        let (target, roll) = nodes[at];
        order.push(target);
        chosen[target] = rolls[target][roll];
        node = least[&(set, at)].1;
        set &= !(1 << target);
    }
    order.reverse();
    Shortest {
        order,
        rolls: chosen,
        duration_s,
    }
}
