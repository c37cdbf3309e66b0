//! Bounds of pairs that are raised only where something depends on them.

use super::*;
use crate::model::order_rules::OrderRules;
use crate::tour::order::completion::SpanningTrees;
use crate::tour::order::tightening::least_bound;
use crate::tour::order::triple_bounds::TripleBounds;
use crate::tour::order::{Evaluation, PairTable, Place, TourEvaluation, exhaustive};
use std::collections::BTreeSet;
use std::sync::Mutex;

/// What a pair bound is before it is raised, relative to the bound then.
const AT_FIRST: f64 = 0.6;

/// A model whose pair bounds are all open at first.
struct Opened<M> {
    model: M,
    raised: Mutex<BTreeSet<[usize; 2]>>,
}

impl<M: TourModel> Opened<M> {
    fn new(model: M) -> Self {
        Self {
            model,
            raised: Mutex::default(),
        }
    }

    fn pair(&self, from: Place, to: Place) -> [usize; 2] {
        let targets = self.target_count();
        [from, to].map(|place| match place {
            Place::Target(target) => target,
            Place::Start => targets,
            Place::End => targets + 1,
        })
    }

    fn raised(&self) -> usize {
        self.raised.lock().expect("no panic").len()
    }
}

impl<M: TourModel> TourModel for Opened<M> {
    fn target_count(&self) -> usize {
        self.model.target_count()
    }

    fn has_end(&self) -> bool {
        self.model.has_end()
    }

    fn rules(&self) -> &OrderRules {
        self.model.rules()
    }

    fn is_symmetric(&self) -> bool {
        self.model.is_symmetric()
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let share = if self.is_open(from, to) {
            AT_FIRST
        } else {
            1.0
        };
        share * self.model.pair_bound(from, to)
    }

    fn is_open(&self, from: Place, to: Place) -> bool {
        let raised = self.raised.lock().expect("no panic");
        !raised.contains(&self.pair(from, to))
    }

    fn raise_pair_bounds(&self, pairs: &[(Place, Place)]) {
        for (from, to) in pairs {
            assert!(self.is_open(*from, *to));
            let mut raised = self.raised.lock().expect("no panic");
            raised.insert(self.pair(*from, *to));
        }
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        self.model.prefix_bound(prefix)
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        self.model.path_bound(path)
    }

    fn couples(&self, via: usize) -> bool {
        self.model.couples(via)
    }

    fn free_ends(&self, from: Place, to: Place) -> [[f64; 3]; 2] {
        self.model.free_ends(from, to)
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        self.model.tour(order)
    }
}

/// Points in a square with their distances. At each target the time to turn from the direction of
/// arrival into that of departure is lost, a quarter of a second for each unit of their difference.
struct Points {
    places: Vec<[f64; 2]>,
    rules: OrderRules,
    turns: bool,
}

const LOST: f64 = 0.25;

impl Points {
    fn new(targets: usize, turns: bool, seed: u64) -> Self {
        let mut random = SplitMix::new(seed);
        Self {
            places: (0..=targets)
                .map(|_| [0; 2].map(|_: i32| 100.0 * unit(&mut random)))
                .collect(),
            rules: OrderRules::none(targets),
            turns,
        }
    }

    fn at(&self, place: Place) -> [f64; 2] {
        match place {
            Place::Target(target) => self.places[target],
            Place::Start | Place::End => self.places[self.places.len() - 1],
        }
    }

    fn direction(&self, from: Place, to: Place) -> [f64; 3] {
        let (a, b) = (self.at(from), self.at(to));
        let length = self.pair_bound(from, to).max(1e-9);
        [(b[0] - a[0]) / length, (b[1] - a[1]) / length, 0.0]
    }

    fn along(&self, path: &[Place]) -> f64 {
        let legs: f64 = path
            .windows(2)
            .map(|leg| self.pair_bound(leg[0], leg[1]))
            .sum();
        let lost = path.windows(3).map(|triple| {
            let [one, other] = [[0, 1], [1, 2]].map(|[a, b]| self.direction(triple[a], triple[b]));
            let change = one.iter().zip(other).map(|(a, b)| (a - b).abs());
            LOST * change.fold(0.0, f64::max)
        });
        legs + if self.turns { lost.sum() } else { 0.0 }
    }
}

impl TourModel for Points {
    fn target_count(&self) -> usize {
        self.places.len() - 1
    }

    fn has_end(&self) -> bool {
        true
    }

    fn rules(&self) -> &OrderRules {
        &self.rules
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let (a, b) = (self.at(from), self.at(to));
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let targets = prefix.iter().map(|target| Place::Target(*target));
        let path: Vec<Place> = std::iter::once(Place::Start).chain(targets).collect();
        Evaluation::Value(self.along(&path))
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        Evaluation::Value(self.along(path))
    }

    fn couples(&self, _: usize) -> bool {
        self.turns
    }

    fn free_ends(&self, from: Place, to: Place) -> [[f64; 3]; 2] {
        [self.direction(from, to); 2]
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        let targets = order.iter().map(|target| Place::Target(*target));
        let path: Vec<Place> = std::iter::once(Place::Start)
            .chain(targets)
            .chain([Place::End])
            .collect();
        TourEvaluation::Solved(self.along(&path))
    }
}

#[test]
fn the_bound_of_all_tours_needs_few_pairs() {
    for seed in 0..4 {
        let points = Points::new(120, false, seed);
        let table = PairTable::new(&points);
        let all: Vec<usize> = (0..120).collect();
        let expected = SpanningTrees::new(&table).bound(&table, table.start(), &all);
        let opened = Opened::new(points);
        let bound = least_bound(&opened, &StopSignal::new());
        assert!((bound / expected - 1.0).abs() < 2e-3, "{bound} {expected}");
        let pairs = 120 * 121;
        assert!(
            opened.raised() * 5 < pairs,
            "{} of {pairs}",
            opened.raised()
        );
    }
}

#[test]
fn open_pairs_hide_no_order() {
    for seed in 0..12 {
        let expected = exhaustive(&RandomModel::new(6, seed % 2 == 0, seed), 0, &pool(2));
        let opened = Opened::new(RandomModel::new(6, seed % 2 == 0, seed));
        let found = run(&opened, &SearchSettings::default());
        assert_eq!(found.best.as_ref(), Some(&expected[0]));
        assert!(found.complete && opened.raised() > 0);
    }
}

#[test]
fn an_order_of_legs_that_do_not_couple_is_short_among_all_of_them() {
    let settings = SearchSettings {
        node_limit: Some(0),
        ..SearchSettings::default()
    };
    for seed in 0..4 {
        let known = run(&Points::new(100, false, seed), &settings);
        let opened = Opened::new(Points::new(100, false, seed));
        let first: Vec<usize> = (0..100).collect();
        let orders = KnownOrders {
            evaluated: Some((&first, opened.tour(&first))),
            first: Some(&first),
        };
        let stop = StopSignal::new();
        let found = search(&opened, orders, &settings, &pool(2), &stop, &Silent);
        let duration_s = |found: SearchResult| found.best.expect("an order").duration_s;
        let (found_s, known_s) = (duration_s(found), duration_s(known));
        assert!(found_s < known_s * (1.0 + 1e-9), "{found_s} {known_s}");
        let pairs = 100 * 101;
        assert!(
            opened.raised() * 4 < pairs,
            "{} of {pairs}",
            opened.raised()
        );
    }
}

#[test]
fn a_stopped_search_raises_nothing() {
    let opened = Opened::new(Points::new(60, false, 1));
    let stop = StopSignal::new();
    stop.cancel();
    let bound = least_bound(&opened, &stop);
    let tour = match opened.tour(&(0..60).collect::<Vec<_>>()) {
        TourEvaluation::Solved(duration_s) => duration_s,
        other => panic!("{other:?}"),
    };
    assert!(0.0 < bound && bound < tour);
}

#[test]
fn gaps_are_estimated_from_those_that_are_known() {
    let opened = Opened::new(Points::new(40, true, 5));
    let table = PairTable::new(&opened);
    let mut bounds =
        TripleBounds::new(&opened, &table, &SpanningTrees::new(&table)).expect("couplings");
    let order: Vec<usize> = (0..30).collect();
    bounds.ask_along(&[order], &opened, &pool(2), &StopSignal::new());
    let mut unknown = 0;
    for via in 31..40 {
        let ends = [via - 1, 20].map(Place::Target);
        let path = [ends[0], Place::Target(via), ends[1]];
        let pairs: f64 = path
            .windows(2)
            .map(|leg| opened.model.pair_bound(leg[0], leg[1]))
            .sum();
        let gap = opened.model.along(&path) - pairs;
        let estimate = bounds.coupling_gap(via - 1, via, 20);
        assert!((estimate - gap).abs() < 1e-3 * LOST, "{estimate} {gap}");
        unknown += usize::from(gap > 0.1 * LOST);
    }
    assert!(unknown > 3);
}

#[test]
fn a_search_over_many_coupled_targets_has_a_valid_bound() {
    let opened = Opened::new(Points::new(45, true, 2));
    let settings = SearchSettings {
        node_limit: Some(40),
        ..SearchSettings::default()
    };
    let found = run(&opened, &settings);
    let best = found.best.expect("an order");
    assert!(found.lower_bound_s <= best.duration_s);
    assert!(
        found.lower_bound_s > 0.93 * best.duration_s,
        "{}",
        found.lower_bound_s
    );
    assert!(opened.raised() * 2 < 45 * 46, "{}", opened.raised());
}
