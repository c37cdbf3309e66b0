//! Pair bounds that are tightened where bounds and short orders depend on them.
//!
//! Among many targets almost no leg can be part of a good tour, and to solve all of them takes longer
//! than the rest of a search. So the pair table begins with what a model knows of every leg without
//! work. Then, in rounds, a bound on all tours is computed by spanning trees ([`SpanningTrees`]), and
//! the model raises the bounds of those edges that it can raise: of the other legs nobody needs to
//! know more, since the trees avoid them although they are underestimated. The same is done for the
//! legs of an order that is short in the table.
//!
//! Every bound stays valid whatever is raised, so the rounds may end at any time.

use super::completion::{Ascent, SpanningTrees};
use super::{PairTable, TourModel};
use crate::run::stop::StopSignal;
use std::collections::BTreeSet;

/// Nearest places of each target whose legs are raised first.
const NEAREST: usize = 6;
/// Largest number of rounds.
const MAX_ROUNDS: usize = 24;
/// A round in which the bound rises by less, relative, is the last one.
const MIN_RELATIVE_GAIN: f64 = 3e-4;
/// Ascents in the order in which they are used. The first, a single one, leads near the best potentials; short and
/// long ones follow, each in rounds until the bound rises no more: short ones end in many different trees, long ones
/// come closer to the best potentials.
const ASCENTS: [Ascent; 3] = [
    Ascent {
        first_step: 0.5,
        steps: 150,
    },
    Ascent {
        first_step: 0.05,
        steps: 20,
    },
    Ascent {
        first_step: 0.05,
        steps: 120,
    },
];
/// Trees at the end of an ascent whose edges are raised.
const LAST_TREES: usize = 15;

/// Tightens the pair bounds on which bounds and short orders depend. Returns spanning trees, if there was anything
/// to tighten: their potentials avoid the legs that stay underestimated, and others might not.
pub(super) fn tighten(
    table: &mut PairTable,
    model: &dyn TourModel,
    stop: &StopSignal,
) -> Option<SpanningTrees> {
    let nearest = nearest(table);
    if nearest.is_empty() {
        return None;
    }
    table.raise(model, &nearest);
    let (mut trees, mut rest) = round(table, model, vec![0.0; table.targets()], ASCENTS[0]);
    for ascent in &ASCENTS[1..] {
        for _ in 0..MAX_ROUNDS {
            if stop.is_set() || rest == 0 {
                break;
            }
            let before_s = trees.whole_s();
            (trees, rest) = round(table, model, trees.potentials().to_vec(), *ascent);
            if trees.whole_s() < before_s * (1.0 + MIN_RELATIVE_GAIN) {
                break;
            }
        }
    }
    Some(trees)
}

/// An ascent from known potentials. The legs of its last trees are raised; returns the trees and how many legs could
/// be raised.
fn round(
    table: &mut PairTable,
    model: &dyn TourModel,
    potentials: Vec<f64>,
    ascent: Ascent,
) -> (SpanningTrees, usize) {
    let mut open = BTreeSet::new();
    let mut seen = 0;
    let trees = SpanningTrees::ascended(table, potentials, ascent, |edges| {
        seen += 1;
        if seen + LAST_TREES > ascent.steps {
            open.extend(edges.iter().filter(|[a, b]| table.can_raise(*a, *b)));
        }
    });
    let open: Vec<[usize; 2]> = open.into_iter().collect();
    table.raise(model, &open);
    (trees, open.len())
}

/// A lower bound on all tours, s, from a model's pair bounds.
pub(crate) fn least_bound(model: &dyn TourModel, stop: &StopSignal) -> f64 {
    let mut table = PairTable::new(model);
    let trees = tighten(&mut table, model, stop);
    trees
        .unwrap_or_else(|| SpanningTrees::new(&table))
        .whole_s()
}

/// The legs between every target and the places nearest to it whose bounds can be raised.
fn nearest(table: &PairTable) -> Vec<[usize; 2]> {
    let targets = table.targets();
    let mut legs = BTreeSet::new();
    for target in 0..targets {
        let distance = |place: usize| {
            let (there, back) = (table.bound(target, place), table.bound(place, target));
            if place < targets {
                there.min(back)
            } else {
                there.max(back)
            }
        };
        let mut near: Vec<usize> = (0..targets + 2).collect();
        near.retain(|&place| place != target && table.can_raise(target, place));
        near.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
        near.truncate(NEAREST);
        legs.extend(
            near.into_iter()
                .map(|place| [target.min(place), target.max(place)]),
        );
    }
    legs.into_iter().collect()
}
