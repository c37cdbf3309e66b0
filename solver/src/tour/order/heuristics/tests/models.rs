//! Random costs of orders.

use crate::math::random::SplitMix;
use crate::model::order_rules::OrderRules;
use crate::tour::order::heuristics::cost::OrderCost;
use crate::tour::order::tests::unit;
use crate::tour::order::{Evaluation, Place, TourEvaluation, TourModel};

/// Kinds of leg costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Legs {
    /// Distances between random points.
    Points,
    /// The same with a dwell at every target, part of the legs into it.
    Dwells,
    /// Random numbers, different in the two directions.
    Directed,
}

/// Kinds of coupling costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Couplings {
    None,
    BothWays,
    Directed,
}

/// Random legs of up to some 40 s and couplings of up to 15 s.
pub(super) struct RandomCost {
    targets: usize,
    legs: Vec<f64>,
    couplings: Vec<f64>,
    couplings_kind: Couplings,
    rules: OrderRules,
}

impl RandomCost {
    pub(super) fn new(targets: usize, legs: Legs, couplings_kind: Couplings, seed: u64) -> Self {
        let mut random = SplitMix::new(seed);
        let places = targets + 2;
        let points: Vec<[f64; 3]> = (0..places)
            .map(|_| [(); 3].map(|()| 25.0 * unit(&mut random)))
            .collect();
        let dwells: Vec<f64> = (0..places).map(|_| 10.0 * unit(&mut random)).collect();
        let distance = |a: usize, b: usize| {
            let squares = (0..3).map(|k| (points[a][k] - points[b][k]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let legs = (0..places * places)
            .map(|place| (place / places, place % places))
            .map(|(from, to)| match legs {
                Legs::Points => distance(from, to),
                Legs::Dwells => distance(from, to) + dwells[to],
                Legs::Directed => 40.0 * unit(&mut random),
            })
            .collect();
        let mut couplings: Vec<f64> = (0..places.pow(3))
            .map(|_| 15.0 * unit(&mut random))
            .collect();
        let number = |from: usize, via: usize, to: usize| (from * places + via) * places + to;
        for from in 0..places {
            for via in 0..places {
                for to in 0..places {
                    match couplings_kind {
                        Couplings::None => couplings[number(from, via, to)] = 0.0,
                        Couplings::BothWays => {
                            couplings[number(from, via, to)] = couplings[number(to, via, from)];
                        }
                        Couplings::Directed => {}
                    }
                }
            }
        }
        Self {
            targets,
            legs,
            couplings,
            rules: OrderRules::none(targets),
            couplings_kind,
        }
    }

    /// Least cost of all orders from the start, s, by enumeration.
    pub(super) fn least(&self) -> f64 {
        let mut order: Vec<usize> = Vec::new();
        let mut best = f64::INFINITY;
        self.extend(&mut order, 0.0, &mut best);
        best
    }

    fn extend(&self, order: &mut Vec<usize>, so_far: f64, best: &mut f64) {
        let done = order.len() == self.targets;
        let open: Vec<usize> = if done {
            vec![self.targets + 1]
        } else {
            (0..self.targets).filter(|t| !order.contains(t)).collect()
        };
        for to in open {
            let at = order.last().copied().unwrap_or(self.targets);
            let before = order.iter().rev().nth(1).copied().unwrap_or(self.targets);
            let coupling = if order.is_empty() {
                0.0
            } else {
                self.coupling(before, at, to)
            };
            let sum = so_far + self.leg(at, to) + coupling;
            if done {
                *best = best.min(sum);
            } else if sum < *best {
                order.push(to);
                self.extend(order, sum, best);
                order.pop();
            }
        }
    }
}

impl OrderCost for RandomCost {
    fn targets(&self) -> usize {
        self.targets
    }

    fn leg(&self, from: usize, to: usize) -> f64 {
        self.legs[from * (self.targets + 2) + to]
    }

    fn coupling(&self, from: usize, via: usize, to: usize) -> f64 {
        let places = self.targets + 2;
        self.couplings[(from * places + via) * places + to]
    }

    fn couplings_are_symmetric(&self) -> bool {
        self.couplings_kind != Couplings::Directed
    }
}

/// A model with pair bounds only, for pair tables.
impl TourModel for RandomCost {
    fn target_count(&self) -> usize {
        self.targets
    }

    fn has_end(&self) -> bool {
        true
    }

    fn rules(&self) -> &OrderRules {
        &self.rules
    }

    fn pair_bound(&self, from: Place, to: Place) -> f64 {
        let number = |place| match place {
            Place::Start => self.targets,
            Place::Target(target) => target,
            Place::End => self.targets + 1,
        };
        self.leg(number(from), number(to))
    }

    fn prefix_bound(&self, _: &[usize]) -> Evaluation {
        Evaluation::Unresolved
    }

    fn path_bound(&self, _: &[Place]) -> Evaluation {
        Evaluation::Unresolved
    }

    fn couples(&self, _: usize) -> bool {
        false
    }

    fn tour(&self, _: &[usize]) -> TourEvaluation {
        TourEvaluation::Unresolved
    }
}
