//! Raising the bound: subgradient ascent over the shares, and asking for the triples that matter.

use super::triples::Triple;
use super::{Charges, Part};
use crate::pool::SolverPool;
use crate::sequence::TourModel;
use crate::sequence::remainder::LegCosts;
use crate::sequence::remainder::least_tree::{cheapest, least_tree};
use crate::stop::StopSignal;
use std::cmp::Reverse;
use std::collections::BTreeMap;

// Found by trial on points on a sphere and in clusters, 50 to 200 of them: within 400 steps the
// bound is within 0.05 % of where it ends, and few triples are asked for.

/// First step, as a share of the mean leg.
const FIRST_STEP: f64 = 0.03;
/// The ascent ends at steps of this share of the mean leg.
const LAST_STEP: f64 = 1e-5;
/// A step is this much shorter than the one before when the bound has not risen for so many steps.
const STEP_DECAY: f64 = 0.7;
const PATIENCE: usize = 5;
/// Share of its direction that a step keeps for the next: the choices jump to and fro.
const MOMENTUM: f64 = 0.85;
/// Weight of prices, which raise all shares of a target, beside that of single shares.
const PRICE_WEIGHT: f64 = 0.5;
/// So many steps go by between asking for triples, and so many per target are asked for at once:
/// those that were chosen most often.
const STEPS_PER_BATCH: usize = 30;
const TRIPLES_PER_TARGET: usize = 4;

/// How much work to spend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Triples to ask for at most, each in both directions.
    pub triples: usize,
    /// Steps of the ascent at most, of a millisecond each when there are two hundred targets.
    pub steps: usize,
}

/// How much work was spent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Raised {
    /// Triples asked for.
    pub triples: usize,
    /// Steps taken.
    pub steps: usize,
    /// Whether all triples that matter are known and the ascent has settled.
    pub settled: bool,
}

/// An ascent under way.
struct Ascent<'a> {
    charges: &'a mut Charges,
    all: &'a [usize],
    part: Part<'a>,
    /// Edges between targets, by rows, less the shares taken over, s.
    weights: Vec<f64>,
    /// Direction of the next step in the shares and in the prices.
    heading: Vec<f64>,
    price_heading: Vec<f64>,
    step: f64,
    /// Steps since the bound last rose.
    stale: usize,
    best_s: f64,
    best: Vec<f64>,
    /// How often open triples were chosen since triples were last asked for.
    wanted: BTreeMap<Triple, usize>,
}

/// The two relaxed choices for some shares.
struct Choices {
    bound: f64,
    /// The neighbours that each target chooses.
    neighbours: Vec<[usize; 2]>,
    /// The tree with its outer edges.
    edges: Vec<[usize; 2]>,
}

impl Charges {
    /// Raises the bound as far as it rises within the effort or until the solve is stopped. It
    /// never falls. May be called again, to go on with more effort.
    pub fn raise(
        &mut self,
        model: &dyn TourModel,
        effort: &Effort,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> Raised {
        let all: Vec<usize> = (0..self.targets()).collect();
        let mean_leg = self.root_s / (all.len() + 1) as f64;
        let mut raised = Raised {
            triples: 0,
            steps: 0,
            settled: false,
        };
        let mut ascent = Ascent::new(self, &all, FIRST_STEP * mean_leg);
        while raised.steps < effort.steps && !stop.is_set() {
            raised.steps += 1;
            let choices = ascent.choose();
            ascent.judge(&choices);
            let left = effort.triples - raised.triples;
            raised.settled = ascent.step <= LAST_STEP * mean_leg;
            if left > 0 && (raised.settled || raised.steps.is_multiple_of(STEPS_PER_BATCH)) {
                let asked = ascent.ask(left, model, pool, stop);
                raised.triples += asked;
                raised.settled &= asked == 0;
            }
            if raised.settled {
                break;
            }
            ascent.advance(&choices);
        }
        let best = ascent.best;
        self.shares = best;
        self.settle();
        raised
    }
}

impl<'a> Ascent<'a> {
    fn new(charges: &'a mut Charges, all: &'a [usize], step: f64) -> Self {
        let targets = all.len();
        Self {
            part: charges.part(charges.legs.table().start(), all),
            weights: vec![0.0; targets * targets],
            heading: vec![0.0; targets * (targets + 2)],
            price_heading: vec![0.0; targets],
            step,
            stale: 0,
            best_s: charges.root_s,
            best: charges.shares.clone(),
            wanted: BTreeMap::new(),
            all,
            charges,
        }
    }

    /// Both choices for the shares as they are.
    fn choose(&mut self) -> Choices {
        let targets = self.all.len();
        for &via in self.all {
            let places = targets + 2;
            let shares = &self.charges.shares[via * places..][..places];
            self.charges.neighbours.sort(via, shares);
        }
        let charges = &*self.charges;
        for a in 0..targets {
            for b in 0..a {
                let weight = charges.cost(a, b);
                self.weights[a * targets + b] = weight;
                self.weights[b * targets + a] = weight;
            }
        }
        let mut choices = Choices {
            bound: 0.0,
            neighbours: Vec::with_capacity(targets),
            edges: Vec::with_capacity(targets + 1),
        };
        for &via in self.all {
            let choice = charges.choice(&self.part, via);
            choices.bound += charges.legs.charge(via) + choice.cost;
            choices.neighbours.push(choice.ends);
        }
        for outer in [self.part.entry, charges.end()] {
            let (target, weight) = cheapest(self.all, |target| charges.cost(target, outer));
            choices.bound += weight;
            choices.edges.push([target, outer]);
        }
        for edge in least_tree(targets, |a, b| self.weights[a * targets + b]) {
            choices.bound += edge.weight;
            choices.edges.push(edge.ends);
        }
        choices
    }

    /// Keeps the best shares, shortens the step when they no longer get better, and notes which
    /// triples it would help to know.
    fn judge(&mut self, choices: &Choices) {
        self.stale += 1;
        if choices.bound > self.best_s {
            self.best_s = choices.bound;
            self.best.copy_from_slice(&self.charges.shares);
            self.stale = 0;
        } else if self.stale >= PATIENCE {
            self.step *= STEP_DECAY;
            self.stale = 0;
        }
        for (via, ends) in choices.neighbours.iter().enumerate() {
            let triple = Triple::new(via, ends[0], ends[1]);
            if self.charges.triples.is_open(triple) {
                *self.wanted.entry(triple).or_default() += 1;
            }
        }
    }

    /// Asks for the triples that were chosen most often; says for how many.
    fn ask(
        &mut self,
        limit: usize,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> usize {
        let mut wanted: Vec<(Triple, usize)> =
            std::mem::take(&mut self.wanted).into_iter().collect();
        // Stable: equals stay in the order of the triples.
        wanted.sort_by_key(|&(_, times)| Reverse(times));
        wanted.truncate(limit.min(TRIPLES_PER_TARGET * self.all.len()));
        let triples: Vec<Triple> = wanted.into_iter().map(|(triple, _)| triple).collect();
        let Charges {
            triples: known,
            legs,
            ..
        } = &mut *self.charges;
        known.ask(&triples, legs.table(), model, pool, stop);
        triples.len()
    }

    /// Takes a step: a share is raised where a target chooses a neighbour that the tree does not,
    /// and lowered where it is the other way round; this is a subgradient of the bound. So is, in
    /// the prices, the number of edges that the tree has too many at a target.
    fn advance(&mut self, choices: &Choices) {
        let targets = self.all.len();
        let places = targets + 2;
        for heading in self.heading.iter_mut().chain(&mut self.price_heading) {
            *heading *= MOMENTUM;
        }
        for (via, ends) in choices.neighbours.iter().enumerate() {
            for place in ends {
                self.heading[via * places + place] += 1.0;
            }
            self.price_heading[via] += 2.0;
        }
        for &[a, b] in &choices.edges {
            for (via, place) in [(a, b), (b, a)] {
                if via < targets {
                    self.heading[via * places + place] -= 1.0;
                    self.price_heading[via] -= 1.0;
                }
            }
        }
        let shares = self.charges.shares.chunks_exact_mut(places);
        let headings = self.heading.chunks_exact(places).zip(&self.price_heading);
        for (shares, (headings, price)) in shares.zip(headings) {
            for (share, heading) in shares.iter_mut().zip(headings) {
                *share += self.step * (heading + PRICE_WEIGHT * price);
            }
        }
    }
}
