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
/// The ascent of a round: that of the first leads near the best potentials, from which the others go
/// on.
const FIRST_ASCENT: Ascent = Ascent {
    first_step: 0.5,
    steps: 150,
};
const LATER_ASCENT: Ascent = Ascent {
    first_step: 0.05,
    steps: 20,
};
/// Trees at the end of an ascent whose edges are raised.
const LAST_TREES: usize = 15;

/// Tightens the pair bounds on which bounds and short orders depend.
pub(super) fn tighten(table: &mut PairTable, model: &dyn TourModel, stop: &StopSignal) {
    let nearest = nearest(table);
    if nearest.is_empty() {
        return;
    }
    table.raise(model, &nearest);
    let mut potentials = vec![0.0; table.targets()];
    let mut ascent = FIRST_ASCENT;
    let mut before_s = 0.0;
    for _ in 0..MAX_ROUNDS {
        if stop.is_set() {
            break;
        }
        let mut open = BTreeSet::new();
        let mut seen = 0;
        let trees = SpanningTrees::ascended(table, potentials, ascent, |edges| {
            seen += 1;
            if seen + LAST_TREES > ascent.steps {
                open.extend(edges.iter().filter(|[a, b]| table.can_raise(*a, *b)));
            }
        });
        let bound_s = trees.whole_s();
        let is_last = open.is_empty() || bound_s < before_s * (1.0 + MIN_RELATIVE_GAIN);
        before_s = bound_s;
        let open: Vec<[usize; 2]> = open.into_iter().collect();
        table.raise(model, &open);
        if is_last {
            break;
        }
        potentials = trees.potentials().to_vec();
        ascent = LATER_ASCENT;
    }
}

/// A lower bound on all tours, s, from a model's pair bounds.
pub(crate) fn least_bound(model: &dyn TourModel, stop: &StopSignal) -> f64 {
    let mut table = PairTable::new(model);
    tighten(&mut table, model, stop);
    let all: Vec<usize> = (0..table.targets()).collect();
    SpanningTrees::new(&table).bound(&table, table.start(), &all)
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
