//! Subgradient ascent over the multipliers; between its steps the model is asked for the coupling
//! gaps of the paths that are chosen most often.

use super::TripleBounds;
use super::choice::{NeighbourChoice, Part};
use super::coupling_gaps::ShortPath;
use super::multipliers::{Heading, Multipliers};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::TourModel;
use crate::tour::order::completion::LegCosts;
use crate::tour::order::completion::least_tree::cheapest;
use std::cmp::Reverse;
use std::collections::BTreeMap;

// With these constants the bound is within 0.2 % of its limit after 400 steps, or four steps per
// target if that is more, on 50 to 200 points on a sphere, uniform and clustered.

/// First step, relative to the mean leg.
const FIRST_STEP: f64 = 0.03;
/// The same in an ascent after a first one of many targets, which begins near the best multipliers.
const LATER_STEP: f64 = 0.008;
/// Step at which the ascent ends, relative to the mean leg.
const LAST_STEP: f64 = 1e-5;
/// Factor by which the step shrinks when the bound has not risen for [`MAX_STALE_STEPS`] steps.
const STEP_DECAY: f64 = 0.7;
/// Steps without a rise of the bound after which the step shrinks.
const MAX_STALE_STEPS: usize = 6;
/// Weight of the previous direction in a step; it damps the oscillation of the choices.
const MOMENTUM: f64 = 0.85;
/// Weight of the node potentials, which move all multipliers of a target together.
const POTENTIAL_WEIGHT: f64 = 0.5;
/// Steps between two batches of questions to the model.
const STEPS_PER_BATCH: usize = 30;
/// Questions of a batch per target.
const BATCH_PER_TARGET: usize = 4;

/// Relative rise of the bound by triples below which paths of five places are asked for.
const MIN_RELATIVE_GAIN: f64 = 1e-3;

/// Number of targets from which the steps of an ascent are divided among workers.
const SHARED_FROM: usize = 30;
/// Number of targets from which an ascent after a first one begins near the best multipliers.
const MANY_TARGETS: usize = 60;

/// Limits of the work of an ascent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AscentEffort {
    /// Largest number of triples to ask for, each in both directions.
    pub triples: usize,
    /// Largest number of paths of five places, and of triples in them, to ask for in the second
    /// ascent. With 0 there is no second ascent, and the outer and joint multipliers stay as they are.
    pub fives: usize,
    /// Whether there is a second ascent even if the first one reached its limit of triples and gained by
    /// them.
    pub fives_before_triples_end: bool,
    /// Largest number of steps of each of the two ascents: some 400, or four per target. With far
    /// fewer the second ascent gains nothing, because the bound falls before it rises.
    pub steps: usize,
}

/// The work of an ascent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AscentWork {
    /// Triples asked for.
    pub triples: usize,
    /// Paths of five places asked for, and triples in them.
    pub fives: usize,
    /// Steps taken.
    pub steps: usize,
    /// Whether the ascent has converged and the gaps of all chosen paths are known.
    pub settled: bool,
}

/// Length of the paths that an ascent asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Width {
    Triples,
    Fives,
}

/// Limits of one ascent.
#[derive(Debug, Clone, Copy)]
struct Limits {
    width: Width,
    /// Largest number of paths to ask for.
    limit: usize,
    /// Largest number of steps.
    steps: usize,
}

impl AscentEffort {
    fn first(&self) -> Limits {
        Limits {
            width: Width::Triples,
            limit: self.triples,
            steps: self.steps,
        }
    }

    fn second(&self) -> Limits {
        Limits {
            width: Width::Fives,
            limit: self.fives,
            steps: self.steps,
        }
    }
}

/// Result of one ascent.
#[derive(Debug, Clone, Copy, Default)]
struct AscentOutcome {
    asked: usize,
    steps: usize,
    settled: bool,
}

/// A running ascent.
struct Ascent<'a> {
    triple_bounds: &'a mut TripleBounds,
    width: Width,
    part: Part<'a>,
    /// Direction of the next step in the multipliers.
    heading: Heading,
    /// Direction of the next step in the node potentials.
    potential_heading: Vec<f64>,
    step: f64,
    /// Steps since the bound last rose.
    stale: usize,
    best_s: f64,
    best: Multipliers,
    /// The best bound since the model was last asked, s.
    level_s: f64,
    /// How often paths with unknown gaps were chosen since the model was last asked.
    wanted: BTreeMap<ShortPath, usize>,
}

/// The two relaxed choices for given multipliers, and their bound.
struct RelaxedChoices {
    bound: f64,
    /// The neighbours that each target chooses.
    targets: Vec<NeighbourChoice>,
    /// The edges of the tree and the two outer edges.
    edges: Vec<[usize; 2]>,
}

impl TripleBounds {
    /// Raises the bound within the limits of an effort or until the solve is stopped. The bound
    /// never falls. A further call continues from the best multipliers. The bound so far, s, is told
    /// whenever the model has been asked.
    pub fn raise(
        &mut self,
        model: &dyn TourModel,
        effort: &AscentEffort,
        pool: &SolverPool,
        stop: &StopSignal,
        tell: &mut dyn FnMut(f64),
    ) -> AscentWork {
        let before_s = self.root_s;
        let triples = self.climb(effort.first(), model, pool, stop, tell);
        self.raised = self.targets() >= MANY_TARGETS;
        // While more triples are wanted, and raise the bound, those of a later call gain more.
        let wanted = triples.asked >= effort.triples && !effort.fives_before_triples_end;
        let early = wanted && self.root_s > before_s * (1.0 + MIN_RELATIVE_GAIN);
        if effort.fives == 0 || early || stop.is_set() {
            return AscentWork {
                triples: triples.asked,
                fives: 0,
                steps: triples.steps,
                settled: triples.settled,
            };
        }
        let fives = self.climb(effort.second(), model, pool, stop, tell);
        AscentWork {
            triples: triples.asked,
            fives: fives.asked,
            steps: triples.steps + fives.steps,
            settled: fives.settled,
        }
    }

    /// One ascent, which asks for paths of this width.
    fn climb(
        &mut self,
        Limits {
            width,
            limit,
            steps,
        }: Limits,
        model: &dyn TourModel,
        pool: &SolverPool,
        stop: &StopSignal,
        tell: &mut dyn FnMut(f64),
    ) -> AscentOutcome {
        let all: Vec<usize> = (0..self.targets()).collect();
        let mean_leg = self.root_s / (all.len() + 1) as f64;
        let mut climb = AscentOutcome::default();
        let first_step = if self.raised { LATER_STEP } else { FIRST_STEP };
        let mut ascent = Ascent::new(self, width, &all, first_step * mean_leg);
        while climb.steps < steps && !stop.is_set() {
            climb.steps += 1;
            let choices = ascent.choose(pool);
            ascent.judge(&choices);
            climb.settled = ascent.step <= LAST_STEP * mean_leg;
            if climb.settled || climb.steps.is_multiple_of(STEPS_PER_BATCH) {
                let wanted = ascent.most_wanted(limit - climb.asked);
                if !wanted.is_empty() {
                    ascent.triple_bounds.ask(&wanted, model, pool, stop);
                    climb.asked += wanted.len();
                    climb.settled = false;
                    // The new gaps change the function; the bound may fall at first.
                    ascent.level_s = f64::NEG_INFINITY;
                    tell(ascent.best_s);
                }
            }
            if climb.settled {
                break;
            }
            ascent.advance(&choices);
        }
        self.multipliers = ascent.best;
        self.update_root_bound();
        climb
    }
}

impl<'a> Ascent<'a> {
    fn new(triple_bounds: &'a mut TripleBounds, width: Width, all: &'a [usize], step: f64) -> Self {
        let targets = all.len();
        Self {
            part: Part::new(triple_bounds.legs.table().start(), triple_bounds.end(), all),
            heading: Heading::default(),
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

    /// Both relaxed choices for the current multipliers.
    fn choose(&mut self, pool: &SolverPool) -> RelaxedChoices {
        let pool = (self.part.targets.len() >= SHARED_FROM).then_some(pool);
        self.triple_bounds.apply_multipliers(pool);
        let triple_bounds = &*self.triple_bounds;
        let targets = self.part.targets.len();
        let mut choices = RelaxedChoices {
            bound: 0.0,
            targets: Vec::with_capacity(targets),
            edges: Vec::with_capacity(targets + 1),
        };
        let choice = |&via: &usize| triple_bounds.choice(&self.part, via);
        let chosen = match pool {
            None => self.part.targets.iter().map(choice).collect(),
            Some(pool) => pool.map_short(self.part.targets.iter().collect(), choice),
        };
        for (&via, choice) in self.part.targets.iter().zip(chosen) {
            choices.bound += triple_bounds.legs.entry_offset(via) + choice.cost;
            choices.targets.push(choice);
        }
        for outer in [self.part.entry, triple_bounds.end()] {
            let cost = |target| triple_bounds.cost(target, outer);
            let (target, weight) = cheapest(self.part.targets, cost);
            choices.bound += weight;
            choices.edges.push([target, outer]);
        }
        for edge in triple_bounds.tree(self.part.targets) {
            choices.bound += edge.weight;
            choices.edges.push(edge.ends);
        }
        choices
    }

    /// Keeps the best multipliers, shortens the step when the bound no longer rises, and counts the
    /// chosen paths whose gaps are unknown.
    fn judge(&mut self, choices: &RelaxedChoices) {
        self.stale += 1;
        if choices.bound > self.best_s {
            self.best_s = choices.bound;
            self.best.clone_from(&self.triple_bounds.multipliers);
        }
        if choices.bound > self.level_s {
            self.level_s = choices.bound;
            self.stale = 0;
        } else if self.stale >= MAX_STALE_STEPS {
            self.step *= STEP_DECAY;
            self.stale = 0;
        }
        for (via, choice) in choices.targets.iter().enumerate() {
            if let Some(path) = self.open_path(via, choice) {
                *self.wanted.entry(path).or_default() += 1;
            }
        }
    }

    /// The path of a target's choice whose gap the model can be asked for, if any.
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

    /// Takes out the paths that were chosen most often.
    fn most_wanted(&mut self, limit: usize) -> Vec<ShortPath> {
        let mut wanted: Vec<(ShortPath, usize)> =
            std::mem::take(&mut self.wanted).into_iter().collect();
        // Stable: equals stay in the order of the paths.
        wanted.sort_by_key(|&(_, times)| Reverse(times));
        wanted.truncate(limit.min(BATCH_PER_TARGET * self.part.targets.len()));
        wanted.into_iter().map(|(path, _)| path).collect()
    }

    /// Takes a step along a subgradient of the bound: a multiplier rises where a target chooses a
    /// neighbour that the tree does not, or a place beyond its neighbour that this neighbour does not, and
    /// falls in the opposite case. The subgradient in a
    /// potential is two minus the degree of the target in the tree.
    fn advance(&mut self, choices: &RelaxedChoices) {
        let targets = self.part.targets.len();
        self.heading.scale(MOMENTUM);
        for (via, choice) in choices.targets.iter().enumerate() {
            for place in choice.ends {
                self.heading.add_near(via, place, 1.0);
            }
            for [of, place] in choice.beyond {
                self.heading.add_outer(of, place, 1.0);
                if of != via {
                    self.heading.add_joint([of, via, place], 1.0);
                }
            }
            let [a, b] = choice.ends;
            for [neighbour, beyond] in [[a, b], [b, a]] {
                if neighbour < targets {
                    self.heading.add_joint([via, neighbour, beyond], -1.0);
                }
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
        // In the first ascent the outer and joint multipliers stay as they are.
        if self.width == Width::Triples {
            self.heading.stay_outside();
        }
        let multipliers = &mut self.triple_bounds.multipliers;
        let potentials = self.potential_heading.iter();
        multipliers.shift(potentials.map(|potential| self.step * POTENTIAL_WEIGHT * potential));
        multipliers.add(&self.heading, self.step);
    }
}
