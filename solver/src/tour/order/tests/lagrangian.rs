//! Lagrangian bounds, on a convex model of legs with preferred boundary states.

use super::{SplitMix, alternatives, pool, run, unit};
use crate::model::order_rules::OrderRules;
use crate::run::stop::StopSignal;
use crate::tour::order::lagrangian::{LagrangianLegs, LagrangianPaths};
use crate::tour::order::{
    Evaluation, PairTable, PassageCostate, Place, TourEvaluation, TourModel, exhaustive,
};

/// Every leg has a preferred state at its begin and one at its end, in `[-1, 1]`, and costs time in
/// proportion to the deviations from them. The model is convex, so a single tour has no duality
/// gap.
struct MeetingModel {
    targets: usize,
    has_end: bool,
    symmetric: bool,
    /// For every leg: its duration in the preferred states, s, and the preferred states at its end
    /// and its begin.
    legs: Vec<[f64; 3]>,
    /// Time per unit of deviation from a preferred state, s.
    stiffness: f64,
    rules: OrderRules,
}

impl MeetingModel {
    fn new(targets: usize, has_end: bool, seed: u64) -> Self {
        let mut random = SplitMix::new(seed);
        let mut leg = || {
            let states = [(); 2].map(|()| 2.0 * unit(&mut random) - 1.0);
            [10.0 + 30.0 * unit(&mut random), states[0], states[1]]
        };
        Self {
            targets,
            has_end,
            symmetric: false,
            legs: (0..(targets + 2).pow(2)).map(|_| leg()).collect(),
            stiffness: 10.0,
            rules: OrderRules::none(targets),
        }
    }

    /// A model that is symmetric under reversal, with start and end exchanged: states change sign.
    fn symmetric(targets: usize, seed: u64) -> Self {
        let mut model = Self::new(targets, true, seed);
        let places = targets + 2;
        let twin = |place| match place {
            place if place == targets => targets + 1,
            place if place == targets + 1 => targets,
            place => place,
        };
        for (from, to) in (0..places).flat_map(|from| (0..places).map(move |to| (from, to))) {
            let [time, end, begin] = model.legs[from * places + to];
            model.legs[twin(to) * places + twin(from)] = [time, -begin, -end];
        }
        model.symmetric = true;
        model
    }

    fn number(&self, place: Place) -> usize {
        match place {
            Place::Target(target) => target,
            Place::Start => self.targets,
            Place::End => self.targets + 1,
        }
    }

    fn leg(&self, from: usize, to: usize) -> [f64; 3] {
        self.legs[from * (self.targets + 2) + to]
    }

    fn path(&self, order: &[usize], to_end: bool) -> Vec<usize> {
        let mut path = vec![self.targets];
        path.extend(order);
        path.extend((to_end && self.has_end).then_some(self.targets + 1));
        path
    }

    /// Duration along a path: the legs and the deviations at their meetings. Any state between the
    /// two preferred ones has the same cost.
    fn along(&self, path: &[usize]) -> f64 {
        let legs = path.windows(2).map(|leg| self.leg(leg[0], leg[1])[0]);
        let meetings = path.windows(3).map(|p| {
            let (end, begin) = (self.leg(p[0], p[1])[1], self.leg(p[1], p[2])[2]);
            self.stiffness * (end - begin).abs()
        });
        legs.sum::<f64>() + meetings.sum::<f64>()
    }
}

impl TourModel for MeetingModel {
    fn target_count(&self) -> usize {
        self.targets
    }

    fn has_end(&self) -> bool {
        self.has_end
    }

    fn rules(&self) -> &OrderRules {
        &self.rules
    }

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        self.leg(self.number(from), self.number(to))[0]
    }

    /// No tighter than the pair bounds, so that the search is long.
    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation {
        let path = self.path(prefix, false);
        Evaluation::Value(path.windows(2).map(|leg| self.leg(leg[0], leg[1])[0]).sum())
    }

    fn path_bound(&self, path: &[Place]) -> Evaluation {
        let path: Vec<usize> = path.iter().map(|&place| self.number(place)).collect();
        Evaluation::Value(self.along(&path))
    }

    fn couples(&self, _: usize) -> bool {
        true
    }

    fn tour(&self, order: &[usize]) -> TourEvaluation {
        assert!(self.rules.admits(order));
        TourEvaluation::Solved(self.along(&self.path(order, true)))
    }

    fn costates(&self, order: &[usize]) -> Option<Vec<PassageCostate>> {
        let path = self.path(order, true);
        let costate = |p: &[usize]| {
            let (end, begin) = (self.leg(p[0], p[1])[1], self.leg(p[1], p[2])[2]);
            vec![self.stiffness * (end - begin).signum()]
        };
        Some(path.windows(3).map(costate).collect())
    }

    /// The minimum over the states at both ends; it is at a preferred state or at an end of the
    /// range.
    fn lagrangian_leg(&self, leg: [Place; 2], costates: [Option<&[f64]>; 2]) -> Evaluation {
        let [time, end, begin] = self.leg(self.number(leg[0]), self.number(leg[1]));
        let [left, reached] = costates.map(|costate| costate.map_or(0.0, |costate| costate[0]));
        let least = |preferred: f64, costate: f64| {
            let states = [-1.0, preferred, 1.0].into_iter();
            let costs =
                states.map(|state| self.stiffness * (state - preferred).abs() + costate * state);
            costs.fold(f64::INFINITY, f64::min)
        };
        Evaluation::Value(time + least(begin, -left) + least(end, reached))
    }
}

/// All orders of some targets.
fn permutations(targets: usize) -> Vec<Vec<usize>> {
    (0..targets).fold(vec![Vec::new()], |orders, target| {
        let places = orders.iter().flat_map(|order: &Vec<usize>| {
            (0..=order.len()).map(|place| {
                let mut longer = order.clone();
                longer.insert(place, target);
                longer
            })
        });
        places.collect()
    })
}

/// A model of every kind.
fn models(targets: usize, seed: u64) -> [MeetingModel; 3] {
    let mut ruled = MeetingModel::new(targets, false, seed);
    let mut before = vec![Vec::new(); targets];
    before[0] = vec![1, 2];
    ruled.rules = OrderRules::new(vec![None; targets], before);
    [
        MeetingModel::new(targets, true, seed),
        MeetingModel::symmetric(targets, seed),
        ruled,
    ]
}

/// For any costates, no bound exceeds the duration it bounds, and the first order listed is the one
/// of smallest bound.
#[test]
fn lagrangian_bounds_are_admissible_for_any_costates() {
    let (pool, stop) = (pool(2), StopSignal::new());
    for seed in 0..6_usize {
        for model in models(6, seed as u64) {
            let table = PairTable::new(&model);
            let mut legs = LagrangianLegs::new(&model, &table);
            let mut paths = LagrangianPaths::new(&legs, &model.rules);
            let all = permutations(6);
            let admitted: Vec<&Vec<usize>> = all
                .iter()
                .filter(|order| model.rules.admits(order))
                .collect();
            for round in 0..4 {
                assert!(paths.fill(&legs, &pool, &stop));
                let mut least = f64::INFINITY;
                for order in &admitted {
                    let duration = model.along(&model.path(order, true));
                    let bound = paths.whole(order, &[]);
                    assert!(
                        bound <= duration + 1e-9,
                        "seed {seed}, round {round}: {bound} {duration}"
                    );
                    least = least.min(bound);
                    for cut in 0..order.len() {
                        let (prefix, rest) = order.split_at(cut);
                        assert!(paths.whole(prefix, rest) <= bound + 1e-9);
                        let from = table.last_place(prefix);
                        let path = [&[from], rest, &model.path(&[], true)[1..]].concat();
                        let path_s = model.along(&path);
                        assert!(paths.bound(from, rest) <= path_s + 1e-9);
                    }
                }
                assert!(
                    (paths.root_bound() - least).abs() <= 1e-5 * least,
                    "seed {seed}"
                );
                let orders = paths.orders(2);
                assert!((paths.whole(&orders[0], &[]) - least).abs() <= 1e-5 * least);
                // In every second round, costates of an arbitrary order.
                let odd = admitted[(seed * 97 + round * 31) % admitted.len()].clone();
                let learned = if round % 2 == 0 { orders } else { vec![odd] };
                assert!(legs.update_costates(&learned, &model, &pool, &stop));
            }
        }
    }
}

#[test]
fn the_dual_ascent_closes_most_of_the_gap() {
    let (pool, stop) = (pool(2), StopSignal::new());
    for seed in 0..6 {
        for model in models(7, seed) {
            let best_s = exhaustive(&model, 0, &pool)[0].duration_s;
            let table = PairTable::new(&model);
            let mut legs = LagrangianLegs::new(&model, &table);
            let mut paths = LagrangianPaths::new(&legs, &model.rules);
            assert!(paths.fill(&legs, &pool, &stop));
            let pairs_s = paths.root_bound();
            let mut bound_s = pairs_s;
            for _ in 0..30 {
                assert!(legs.update_costates(&paths.orders(4), &model, &pool, &stop));
                assert!(paths.fill(&legs, &pool, &stop));
                bound_s = bound_s.max(paths.root_bound());
            }
            let closed = (bound_s - pairs_s) / (best_s - pairs_s);
            assert!(closed > 0.8, "seed {seed}: {pairs_s} {bound_s} {best_s}");
        }
    }
}

#[test]
fn a_stopped_update_changes_nothing() {
    let (pool, stop) = (pool(2), StopSignal::new());
    let model = MeetingModel::new(6, true, 1);
    let mut legs = LagrangianLegs::new(&model, &PairTable::new(&model));
    let mut paths = LagrangianPaths::new(&legs, &model.rules);
    assert!(paths.fill(&legs, &pool, &stop));
    let (orders, before) = (paths.orders(3), paths.root_bound());
    stop.request();
    assert!(!legs.update_costates(&orders, &model, &pool, &stop));
    assert!(!paths.fill(&legs, &pool, &stop));
    assert!(paths.fill(&legs, &pool, &StopSignal::new()));
    assert_eq!(
        paths.root_bound().total_cmp(&before),
        std::cmp::Ordering::Equal
    );
}

/// The searches are long enough to compute Lagrangian bounds.
#[test]
fn a_search_with_lagrangian_bounds_finds_the_best_orders() {
    let pool = pool(2);
    for seed in 0..3 {
        for model in models(8, seed) {
            let expected = exhaustive(&model, 2, &pool);
            let result = run(&model, &alternatives(2));
            assert!(result.complete, "seed {seed}");
            let found = result.best.iter().chain(&result.alternatives);
            for (found, expected) in found.zip(&expected) {
                assert!((found.duration_s - expected.duration_s).abs() <= 1e-9);
            }
            assert_eq!(result.statistics.bounds_contradicted, 0);
        }
    }
}
