//! Triple bounds against all orders.

use super::anytime::StopsInside;
use super::{RandomModel, pool};
use crate::run::stop::StopSignal;
use crate::tour::order::completion::SpanningTrees;
use crate::tour::order::triple_bounds::{AscentEffort, TripleBoundSubsets, TripleBounds};
use crate::tour::order::{Evaluation, PairTable, Place, TourEvaluation, TourModel};
use std::sync::atomic::{AtomicUsize, Ordering};

const EFFORT: AscentEffort = AscentEffort {
    triples: 1000,
    fives: 1000,
    fives_before_triples_end: true,
    steps: 200,
};

/// Selects paths that do not resolve.
fn some_paths(path: &[usize]) -> bool {
    path.iter().sum::<usize>() % 3 == 0
}

/// Models of each kind, whose path bounds contain all penalties.
fn models() -> impl Iterator<Item = RandomModel> {
    (0..63).map(|seed| {
        let kinds = [
            RandomModel::new,
            RandomModel::reversible,
            RandomModel::with_ties,
        ];
        let targets = 1 + (seed % 7) as usize;
        let mut model = kinds[(seed % 3) as usize](targets, seed % 2 == 0, seed);
        model.known_share = 1.0;
        if seed % 5 == 0 {
            model.couples = |via| via % 2 == 0;
        }
        model
    })
}

fn prepared(model: &dyn TourModel) -> (PairTable, SpanningTrees, TripleBounds) {
    let table = PairTable::new(model);
    let trees = SpanningTrees::new(&table);
    let triple_bounds = TripleBounds::new(model, &table, &trees).expect("legs are coupled");
    (table, trees, triple_bounds)
}

/// The sum of pair bounds and weighted penalties along a path that the triple bounds relax, s, when
/// all gaps are known: a penalty counts half, or three quarters with two places on either side.
fn relaxed(model: &RandomModel, path: &[Place]) -> f64 {
    let pair = |leg: &[Place]| model.pair_bound(leg[0], leg[1]);
    let penalties = path
        .windows(3)
        .enumerate()
        .map(|(first, triple)| match triple[1] {
            Place::Target(via) if model.couples(via) => {
                let Evaluation::Value(bound) = model.path_bound(triple) else {
                    panic!("the model resolves");
                };
                let share = if first > 0 && first + 4 <= path.len() {
                    0.75
                } else {
                    0.5
                };
                share * (bound - pair(&triple[..2]) - pair(&triple[1..]))
            }
            _ => 0.0,
        });
    path.windows(2).map(pair).chain(penalties).sum()
}

/// Minimum of that sum over all paths that begin with these places and go through the remaining
/// targets to the end, s.
fn cheapest(model: &RandomModel, begin: &[Place], remaining: &[usize]) -> f64 {
    if remaining.is_empty() {
        let end = model.has_end().then_some(Place::End);
        return relaxed(model, &begin.iter().copied().chain(end).collect::<Vec<_>>());
    }
    let onward = |&to: &usize| {
        let rest: Vec<usize> = remaining.iter().copied().filter(|&t| t != to).collect();
        cheapest(model, &[begin, &[Place::Target(to)]].concat(), &rest)
    };
    remaining.iter().map(onward).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_bound_exceeds_the_cheapest_path() {
    let pool = pool(2);
    for (case, mut model) in models().enumerate() {
        if case % 4 == 0 {
            model.fails = some_paths;
        }
        let (table, _, mut triple_bounds) = prepared(&model);
        let before = triple_bounds.root_bound();
        triple_bounds.raise(&model, &EFFORT, &pool, &StopSignal::new(), &mut |_| ());
        assert!(triple_bounds.root_bound() >= before, "case {case}");
        model.fails = |_| false;
        let all: Vec<usize> = (0..table.targets()).collect();
        // After the ascent the multipliers are those of the best bound.
        let root = triple_bounds.bound(table.start(), &all);
        assert!(
            (triple_bounds.root_bound() - root).abs() <= 1e-9,
            "case {case}"
        );
        let mut parts = vec![(table.start(), Place::Start, all.clone())];
        for &from in &all {
            for size in 0..all.len() {
                let others = all.iter().copied().filter(|&t| t != from);
                parts.push((from, Place::Target(from), others.take(size).collect()));
            }
        }
        let bound = |(from, _, remaining): &(usize, Place, Vec<usize>)| {
            triple_bounds.bound(*from, remaining)
        };
        let trees: Vec<f64> = parts.iter().map(bound).collect();
        let subsets = TripleBoundSubsets::new(triple_bounds, table.rules(), &StopSignal::new());
        for ((from, place, remaining), tree) in parts.into_iter().zip(trees) {
            let least = cheapest(&model, &[place], &remaining);
            let path = subsets.bound(from, &remaining);
            assert!(tree <= path + 1e-9, "case {case}");
            assert!(path <= least + 1e-9, "case {case}: {path} above {least}");
        }
    }
}

#[test]
fn triples_raise_the_held_karp_bound_and_fives_raise_it_further() {
    let pool = pool(2);
    for seed in 0..12 {
        let kinds = [RandomModel::new, RandomModel::reversible];
        let mut model = kinds[seed % 2](8, seed % 4 < 2, seed as u64);
        model.known_share = 1.0;
        let (table, trees, mut triple_bounds) = prepared(&model);
        let all: Vec<usize> = (0..8).collect();
        let mut bound = trees.bound(&table, table.start(), &all);
        assert!(triple_bounds.root_bound() >= bound - 1e-9, "seed {seed}");
        for fives in [0, EFFORT.fives] {
            let effort = AscentEffort { fives, ..EFFORT };
            triple_bounds.raise(&model, &effort, &pool, &StopSignal::new(), &mut |_| ());
            assert!(triple_bounds.root_bound() > bound * 1.005, "seed {seed}");
            bound = triple_bounds.root_bound();
        }
    }
}

#[test]
fn triple_bounds_do_not_depend_on_the_number_of_threads() {
    for seed in 0..3 {
        let model = RandomModel::new(20, seed % 2 == 0, seed);
        let some: Vec<usize> = (3..17).collect();
        let results = [1, 2, 3].map(|threads| {
            let (_, _, mut triple_bounds) = prepared(&model);
            let raised = triple_bounds.raise(
                &model,
                &EFFORT,
                &pool(threads),
                &StopSignal::new(),
                &mut |_| (),
            );
            let bounds = [triple_bounds.root_bound(), triple_bounds.bound(0, &some)];
            (raised, bounds.map(f64::to_bits))
        });
        assert!(results.iter().all(|result| *result == results[0]));
    }
}

/// A model that counts its evaluations and cancels at evaluation number `stop_at`.
fn counting(stop: &StopSignal, stop_at: usize) -> StopsInside<'_> {
    StopsInside {
        inner: RandomModel::new(12, true, 5),
        stop,
        evaluations: AtomicUsize::new(0),
        stop_at,
    }
}

#[test]
fn a_stop_ends_the_ascent_at_once_and_leaves_a_bound() {
    let stop = StopSignal::new();
    let model = counting(&stop, 10);
    let (_, _, mut triple_bounds) = prepared(&model);
    let before = triple_bounds.root_bound();
    let raised = triple_bounds.raise(&model, &EFFORT, &pool(2), &stop, &mut |_| ());
    assert!(!raised.settled && raised.steps < EFFORT.steps);
    // The other worker may already have polled the signal.
    assert!(model.evaluations.load(Ordering::Relaxed) <= 11);
    assert!(triple_bounds.root_bound() >= before);
    let again = triple_bounds.raise(&model, &EFFORT, &pool(2), &stop, &mut |_| ());
    assert_eq!((again.steps, again.triples), (0, 0));
}

#[test]
fn the_model_is_asked_within_the_limits_and_never_twice_for_a_path() {
    let stop = StopSignal::new();
    let model = counting(&stop, usize::MAX);
    let (_, _, mut triple_bounds) = prepared(&model);
    let mut paths = 0;
    let mut bound = triple_bounds.root_bound();
    for (triples, fives) in [
        (0, 0),
        (1, 1),
        (10, 0),
        (10_000, 10),
        (10_000, 0),
        (10_000, 0),
    ] {
        let effort = AscentEffort {
            triples,
            fives,
            ..EFFORT
        };
        let raised = triple_bounds.raise(&model, &effort, &pool(2), &stop, &mut |_| ());
        assert!(raised.triples <= triples && raised.fives <= fives);
        paths += raised.triples + raised.fives;
        // Paths from the start or to the end have one direction, all others two.
        let asked = model.evaluations.load(Ordering::Relaxed);
        assert!((paths..=2 * paths).contains(&asked));
        assert!(triple_bounds.root_bound() >= bound);
        bound = triple_bounds.root_bound();
    }
    // There are 12 targets, each with 11 others, start and end around it.
    assert!(paths <= 12 * (13 * 12 / 2 - 1) + 11);
}

#[test]
fn estimates_lie_between_the_pair_bounds_and_the_duration() {
    let mut model = RandomModel::new(6, true, 2);
    model.known_share = 1.0;
    let (table, _, mut triple_bounds) = prepared(&model);
    triple_bounds.raise(&model, &EFFORT, &pool(2), &StopSignal::new(), &mut |_| ());
    let mut raised = 0;
    let mut order: Vec<usize> = (0..6).collect();
    for turn in 0..6 {
        order.swap(turn, 5 - turn / 2);
        let mut path = vec![table.start()];
        path.extend(&order);
        path.push(table.end());
        let pairs: f64 = path.windows(2).map(|leg| table.bound(leg[0], leg[1])).sum();
        let gap = |triple: &[usize]| triple_bounds.coupling_gap(triple[0], triple[1], triple[2]);
        let estimate = pairs + path.windows(3).map(gap).sum::<f64>();
        let TourEvaluation::Solved(duration) = model.tour(&order) else {
            panic!("the model resolves");
        };
        assert!(pairs <= estimate && estimate <= duration + 1e-9);
        raised += usize::from(estimate > pairs);
    }
    assert!(raised > 0);
}

#[test]
fn the_estimate_of_a_solved_tour_is_its_duration() {
    for (seed, symmetric) in (0..6).flat_map(|seed| [(seed, true), (seed, false)]) {
        let mut model = if symmetric {
            RandomModel::symmetric(6, seed)
        } else {
            RandomModel::new(6, seed % 2 == 0, seed)
        };
        model.known_share = 0.6;
        let (table, _, mut triple_bounds) = prepared(&model);
        let order = [4, 1, 5, 0, 2, 3];
        let mut path = vec![table.start()];
        path.extend(order);
        path.extend(model.has_end().then(|| table.end()));
        let pairs: f64 = path.windows(2).map(|leg| table.bound(leg[0], leg[1])).sum();
        let estimate = |triple_bounds: &TripleBounds| {
            let gap = |p: &[usize]| triple_bounds.coupling_gap(p[0], p[1], p[2]);
            pairs + path.windows(3).map(gap).sum::<f64>()
        };
        let TourEvaluation::Solved(duration) = model.tour(&order) else {
            panic!("the model resolves");
        };
        triple_bounds.ask_along(&[order.into()], &model, &pool(1), &StopSignal::new());
        assert!(estimate(&triple_bounds) < duration - 1.0);
        triple_bounds.learn(&order, &model);
        assert!((estimate(&triple_bounds) - duration).abs() < 1e-9, "{seed}");
        if symmetric {
            let triple = triple_bounds.coupling_gap(table.start(), 4, 1);
            let twin = triple_bounds.coupling_gap(1, 4, table.end());
            assert!((triple - twin).abs() < 1e-12);
        }
    }
}

#[test]
fn a_model_without_couplings_has_no_triple_bounds() {
    let mut model = RandomModel::new(5, true, 1);
    model.couples = |_| false;
    let table = PairTable::new(&model);
    assert!(TripleBounds::new(&model, &table, &SpanningTrees::new(&table)).is_none());
}
