//! Raising the bound: subgradient ascent over the multipliers, and asking for the paths that matter.

use super::TripleBounds;
use super::choice::{NeighbourChoice, Part};
use super::coupling_gaps::ShortPath;
use super::multipliers::Multipliers;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::TourModel;
use crate::tour::order::completion::LegCosts;
use crate::tour::order::completion::least_tree::{cheapest, least_tree};
use std::cmp::Reverse;
use std::collections::BTreeMap;

// Found by trial on points on a sphere and in clusters, 50 to 200 of them: within 400 steps, with
// fives within four per target where that is more, the bound is within 0.2 % of where it ends.

/// First step, as a share of the mean leg.
const FIRST_STEP: f64 = 0.03;
/// The ascent ends at steps of this share of the mean leg.
const LAST_STEP: f64 = 1e-5;
/// A step is this much shorter than the one before when the bound has not risen for so many steps.
const STEP_DECAY: f64 = 0.7;
const PATIENCE: usize = 6;
/// Share of its direction that a step keeps for the next: the choices jump to and fro.
const MOMENTUM: f64 = 0.85;
/// Weight of prices, which raise all multipliers of a target, beside that of single multipliers.
const POTENTIAL_WEIGHT: f64 = 0.5;
/// So many steps go by between asking the model, and so many questions per target are asked at
/// once: those that were chosen most often.
const STEPS_PER_BATCH: usize = 30;
const BATCH_PER_TARGET: usize = 4;

/// How much work to spend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AscentEffort {
    /// Triples to ask for at most, each in both directions.
    pub triples: usize,
    /// Five places in a row, and triples in them, to ask for at most once triples alone no longer
    /// help; with 0 the outer multipliers stay as they are.
    pub fives: usize,
    /// Steps of the ascent at most, with triples and again with fives: some 400, and four per
    /// target. With far fewer, fives gain nothing: the bound falls before it rises.
    pub steps: usize,
}

/// How much work was spent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AscentWork {
    /// Triples asked for.
    pub triples: usize,
    /// Fives asked for, and triples in them.
    pub fives: usize,
    /// Steps taken.
    pub steps: usize,
    /// Whether all paths that matter are known and the ascent has settled.
    pub settled: bool,
}

/// What the ascent asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Width {
    Triples,
    Fives,
}

/// How an ascent went.
#[derive(Debug, Clone, Copy, Default)]
struct AscentOutcome {
    asked: usize,
    steps: usize,
    settled: bool,
}

/// An ascent under way.
struct Ascent<'a> {
    triple_bounds: &'a mut TripleBounds,
    width: Width,
    part: Part<'a>,
    /// Edges between targets, by rows, less the multipliers taken over, s.
    weights: Vec<f64>,
    /// Direction of the next step in the multipliers and in the prices.
    heading: Multipliers,
    potential_heading: Vec<f64>,
    step: f64,
    /// Steps since the bound last rose.
    stale: usize,
    best_s: f64,
    best: Multipliers,
    /// The best bound since the model was last asked, s.
    level_s: f64,
    /// How often open paths were chosen since the model was last asked.
    wanted: BTreeMap<ShortPath, usize>,
}

/// The two relaxed choices for some multipliers.
struct RelaxedChoices {
    bound: f64,
    /// What each target chooses.
    targets: Vec<NeighbourChoice>,
    /// The tree with its outer edges.
    edges: Vec<[usize; 2]>,
}

impl TripleBounds {
    /// Raises the bound as far as it rises within the effort or until the solve is stopped. It
    /// never falls. May be called again, to go on from the best multipliers.
    pub fn raise(
        &mut self,
        model: &dyn TourModel,
        effort: &AscentEffort,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> AscentWork {
        let ask = |triple_bounds: &mut Self, paths: &[ShortPath]| {
            let table = triple_bounds.legs.table();
            triple_bounds
                .coupling_gaps
                .ask(paths, table, model, pool, stop);
        };
        let triples = self.climb(Width::Triples, effort.triples, effort.steps, ask, stop);
        if effort.fives == 0 || stop.is_set() {
            return AscentWork {
                triples: triples.asked,
                fives: 0,
                steps: triples.steps,
                settled: triples.settled,
            };
        }
        let fives = self.climb(Width::Fives, effort.fives, effort.steps, ask, stop);
        AscentWork {
            triples: triples.asked,
            fives: fives.asked,
            steps: triples.steps + fives.steps,
            settled: fives.settled,
        }
    }

    /// One ascent, that asks for paths of this width.
    fn climb(
        &mut self,
        width: Width,
        limit: usize,
        steps: usize,
        ask: impl Fn(&mut Self, &[ShortPath]),
        stop: &StopSignal,
    ) -> AscentOutcome {
        let all: Vec<usize> = (0..self.targets()).collect();
        let mean_leg = self.root_s / (all.len() + 1) as f64;
        let mut climb = AscentOutcome::default();
        let mut ascent = Ascent::new(self, width, &all, FIRST_STEP * mean_leg);
        while climb.steps < steps && !stop.is_set() {
            climb.steps += 1;
            let choices = ascent.choose();
            ascent.judge(&choices);
            climb.settled = ascent.step <= LAST_STEP * mean_leg;
            if climb.settled || climb.steps.is_multiple_of(STEPS_PER_BATCH) {
                let wanted = ascent.most_wanted(limit - climb.asked);
                if !wanted.is_empty() {
                    ask(ascent.triple_bounds, &wanted);
                    climb.asked += wanted.len();
                    climb.settled = false;
                    // What is known now is another function to climb: it may first go down.
                    ascent.level_s = f64::NEG_INFINITY;
                }
            }
            if climb.settled {
                break;
            }
            ascent.advance(&choices);
        }
        self.multipliers = ascent.best;
        self.settle();
        climb
    }
}

impl<'a> Ascent<'a> {
    fn new(triple_bounds: &'a mut TripleBounds, width: Width, all: &'a [usize], step: f64) -> Self {
        let targets = all.len();
        Self {
            part: Part::new(triple_bounds.legs.table().start(), triple_bounds.end(), all),
            weights: vec![0.0; targets * targets],
            heading: Multipliers::zero(targets),
            potential_heading: vec![0.0; targets],
            step,
            stale: 0,
            level_s: f64::NEG_INFINITY,
            best_s: triple_bounds.root_s,
            best: triple_bounds.multipliers.clone(),
            wanted: BTreeMap::new(),
            width,
            triple_bounds,
        }
    }

    /// Both choices for the multipliers as they are.
    fn choose(&mut self) -> RelaxedChoices {
        self.triple_bounds.rank();
        let triple_bounds = &*self.triple_bounds;
        let targets = self.part.targets.len();
        for a in 0..targets {
            for b in 0..a {
                let weight = triple_bounds.cost(a, b);
                self.weights[a * targets + b] = weight;
                self.weights[b * targets + a] = weight;
            }
        }
        let mut choices = RelaxedChoices {
            bound: 0.0,
            targets: Vec::with_capacity(targets),
            edges: Vec::with_capacity(targets + 1),
        };
        for &via in self.part.targets {
            let choice = triple_bounds.choice(&self.part, via);
            choices.bound += triple_bounds.legs.entry_offset(via) + choice.cost;
            choices.targets.push(choice);
        }
        for outer in [self.part.entry, triple_bounds.end()] {
            let cost = |target| triple_bounds.cost(target, outer);
            let (target, weight) = cheapest(self.part.targets, cost);
            choices.bound += weight;
            choices.edges.push([target, outer]);
        }
        for edge in least_tree(targets, |a, b| self.weights[a * targets + b]) {
            choices.bound += edge.weight;
            choices.edges.push(edge.ends);
        }
        choices
    }

    /// Keeps the best multipliers, shortens the step when they no longer get better, and notes what it
    /// would help to know.
    fn judge(&mut self, choices: &RelaxedChoices) {
        self.stale += 1;
        if choices.bound > self.best_s {
            self.best_s = choices.bound;
            self.best.clone_from(&self.triple_bounds.multipliers);
        }
        if choices.bound > self.level_s {
            self.level_s = choices.bound;
            self.stale = 0;
        } else if self.stale >= PATIENCE {
            self.step *= STEP_DECAY;
            self.stale = 0;
        }
        for (via, choice) in choices.targets.iter().enumerate() {
            if let Some(path) = self.open_path(via, choice) {
                *self.wanted.entry(path).or_default() += 1;
            }
        }
    }

    /// What would tell more about what a target chose.
    fn open_path(&self, via: usize, choice: &NeighbourChoice) -> Option<ShortPath> {
        let coupling_gaps = &self.triple_bounds.coupling_gaps;
        let [a, b] = choice.ends;
        let triple = ShortPath::new(&[a, via, b]);
        if coupling_gaps.is_open(&triple) {
            return Some(triple);
        }
        if self.width == Width::Triples {
            return None;
        }
        let [first, last] = choice.path_beyond()?;
        let five = ShortPath::new(&[first, a, via, b, last]);
        coupling_gaps.is_open(&five).then_some(five)
    }

    /// Takes the paths that were chosen most often.
    fn most_wanted(&mut self, limit: usize) -> Vec<ShortPath> {
        let mut wanted: Vec<(ShortPath, usize)> =
            std::mem::take(&mut self.wanted).into_iter().collect();
        // Stable: equals stay in the order of the paths.
        wanted.sort_by_key(|&(_, times)| Reverse(times));
        wanted.truncate(limit.min(BATCH_PER_TARGET * self.part.targets.len()));
        wanted.into_iter().map(|(path, _)| path).collect()
    }

    /// Takes a step: a share is raised where a target chooses a neighbour that the tree does not,
    /// and lowered where it is the other way round; this is a subgradient of the bound. So is, in
    /// the prices, the number of edges that the tree has too many at a target.
    fn advance(&mut self, choices: &RelaxedChoices) {
        let targets = self.part.targets.len();
        self.heading.fade(MOMENTUM);
        for (via, choice) in choices.targets.iter().enumerate() {
            for place in choice.ends {
                self.heading.add_near(via, place, 1.0);
            }
            for [of, place] in choice.beyond {
                self.heading.add_outer(of, place, 1.0);
            }
            self.potential_heading[via] = MOMENTUM * self.potential_heading[via] + 2.0;
        }
        for &[a, b] in &choices.edges {
            for (of, place) in [(a, b), (b, a)] {
                if of < targets {
                    self.heading.add_near(of, place, -1.0);
                    self.heading.add_outer(of, place, -1.0);
                    self.potential_heading[of] -= 1.0;
                }
            }
        }
        let multipliers = &mut self.triple_bounds.multipliers;
        let near = multipliers.near.chunks_exact_mut(targets + 2);
        let headings = self.heading.near.chunks_exact(targets + 2);
        for ((near, headings), price) in near.zip(headings).zip(&self.potential_heading) {
            for (share, heading) in near.iter_mut().zip(headings) {
                *share += self.step * (heading + POTENTIAL_WEIGHT * price);
            }
        }
        if self.width == Width::Fives {
            for (share, heading) in multipliers.outer.iter_mut().zip(&self.heading.outer) {
                *share += self.step * heading;
            }
        }
    }
}
