//! The search: local search for good schedules, labels in both directions for the proof.

use super::instance::{Instance, ROUNDING};
use super::labels::{Aim, Completions, Goal, LabelRun, Path, Root, run};
use super::local_search::{Filled, LocalSearch};
use super::route_memory::RouteMemory;
use super::worth::Worth;
use super::{MAX_LABELLED, TimedOrder, TimedProblem, TimedResult, TravelTimes};

/// Runs of labels that learn from what their best path has forgotten; then everything is kept in mind.
const LEARNING_RUNS: usize = 60;
/// Kicks of a local search for each target; of more than so many targets as many as take no longer.
const KICKS: usize = 20;
const KICKED_TARGETS: usize = 50;

/// Labels of one run at most: memory for [`LABEL_BYTES`] each.
pub const MAX_LABELS: u64 = 1_000_000;
/// Memory of a label with its entries in queues and bounds, bytes.
pub const LABEL_BYTES: u64 = 320;

/// Number of targets up to which the times of labels count as equal.
const QUICK_TARGETS: u64 = 80;

/// The number of labels among so many targets that take no longer than some among few: a label is extended
/// to, and compared with, about as many others as there are targets.
#[must_use]
pub fn labels_in_time(labels: u64, targets: usize) -> u64 {
    let targets = QUICK_TARGETS.max(targets as u64);
    labels * QUICK_TARGETS.pow(2) / targets.saturating_pow(2)
}

/// Where a search ends at the latest.
#[derive(Debug, Clone, Copy)]
pub struct SearchLimits {
    /// Labels of one run.
    pub labels_of_a_run: u64,
    /// Labels in all; `None` is unlimited.
    pub labels: Option<u64>,
    /// Local searches one after the other where labels prove nothing, each as long as the first.
    pub more_rounds: usize,
    /// Seed of the local search.
    pub seed: u64,
}

impl Default for SearchLimits {
    fn default() -> Self {
        Self {
            labels_of_a_run: MAX_LABELS,
            labels: None,
            more_rounds: 0,
            seed: 0,
        }
    }
}

/// Searches for the best schedule. `improved` is told of the best schedule and of the bounds whenever
/// one of them becomes better.
///
/// What is found does not depend on the clock unless `stop` does.
pub fn search(
    problem: &TimedProblem,
    times: &(impl TravelTimes + ?Sized),
    limits: SearchLimits,
    stop: &dyn Fn() -> bool,
    improved: &mut dyn FnMut(&TimedResult),
) -> TimedResult {
    search_from((problem, times), &[], limits, stop, improved)
}

/// The same, from an order to begin with if that keeps windows and rules.
pub fn search_from(
    (problem, times): (&TimedProblem, &(impl TravelTimes + ?Sized)),
    first: &[usize],
    limits: SearchLimits,
    stop: &dyn Fn() -> bool,
    improved: &mut dyn FnMut(&TimedResult),
) -> TimedResult {
    let worth = Worth::of(&problem.targets);
    let instance = Instance::new(problem, times, &worth);
    let first = Filled::of(&instance, first.to_vec()).or_else(|| Filled::of(&instance, Vec::new()));
    let local = first.map(|first| LocalSearch::new(&instance, first, limits.seed));
    let slower = instance.count.max(KICKED_TARGETS).div_ceil(KICKED_TARGETS);
    let kicks = KICKS * instance.count / (slower * slower);
    let all = worth.units.iter().sum();
    let mut search = Search {
        problem,
        worth,
        limits,
        stop,
        improved,
        best: None,
        units_bound: all,
        end_bound: 0.0,
        proved: false,
        labels: 0,
    };
    let mut local = local.map(|mut local| {
        local.run(kicks, stop);
        search.best = Some(local.best.clone());
        local
    });
    search.tell();
    if instance.count <= MAX_LABELLED {
        search.prove_worth(&instance);
        // Without all required targets no schedule counts, whenever it ends.
        if search.proved && search.worth.is_whole(search.units_bound) {
            search.proved = false;
            search.prove_end(&instance);
        }
    }
    if let Some(local) = &mut local {
        search.go_on(local, kicks);
    }
    search.result()
}

struct Search<'a> {
    problem: &'a TimedProblem,
    worth: Worth,
    limits: SearchLimits,
    stop: &'a dyn Fn() -> bool,
    improved: &'a mut dyn FnMut(&TimedResult),
    best: Option<Filled>,
    units_bound: u64,
    end_bound: f64,
    proved: bool,
    labels: u64,
}

impl Search<'_> {
    /// Looks for schedules of more worth until there are none.
    fn prove_worth(&mut self, instance: &Instance) {
        self.learn(instance, Aim::Worth);
        if self.proved {
            self.units_bound = self.best.as_ref().map_or(0, |best| best.units);
            self.tell();
        }
    }

    /// Local searches where nothing is proved.
    fn go_on(&mut self, local: &mut LocalSearch<'_>, kicks: usize) {
        for _ in 0..self.limits.more_rounds {
            if self.proved || (self.stop)() {
                return;
            }
            local.run(kicks, self.stop);
            if self.best.as_ref().is_none_or(|best| local.best.beats(best)) {
                self.best = Some(local.best.clone());
                self.tell();
            }
        }
    }

    /// Looks for schedules of the same worth that end earlier until there are none.
    fn prove_end(&mut self, instance: &Instance) {
        if self.best.is_none() {
            self.proved = true;
            return;
        }
        self.learn(instance, Aim::Time);
        if self.proved {
            self.end_bound = self.best.as_ref().map_or(0.0, |best| best.end);
            self.tell();
        }
    }

    fn learn(&mut self, instance: &Instance, aim: Aim) {
        let ruled = instance.positions.iter().any(Option::is_some);
        // The first run is the cheapest: it gives bounds to the second.
        let mut memory = RouteMemory::none(instance.count);
        let mut bounds: Option<Completions> = None;
        for round in 0.. {
            match round {
                1 => memory = RouteMemory::nearest(instance),
                LEARNING_RUNS => memory = RouteMemory::whole(instance.count),
                _ => {}
            }
            let forward = round % 2 == 1;
            let found = self.run(instance, forward, &memory, (bounds.as_ref(), aim));
            if !found.complete {
                return;
            }
            let Some(path) = found.best else {
                self.proved = true;
                return;
            };
            bounds = Some(found.completions);
            let forgotten = memory.learn(&path.order, &instance.barred);
            // Backward in time every path ends at the horizon, and fixed places are not known.
            let exact = forward || aim == Aim::Worth;
            if exact {
                self.tighten(&path, aim);
            }
            if !forgotten && exact && (forward || !ruled) {
                // The path is a schedule, and the best one: it has been offered.
                self.proved = true;
                return;
            }
        }
    }

    fn run(
        &mut self,
        instance: &Instance,
        forward: bool,
        memory: &RouteMemory,
        (bounds, aim): (Option<&Completions>, Aim),
    ) -> LabelRun {
        let known = self.best.as_ref().map(|best| (best.units, best.end));
        let (units, horizon) = match (aim, known) {
            (_, None) => (0, instance.horizon),
            (Aim::Worth, Some((units, _))) => (units + 1, instance.horizon),
            // Earlier by more than what rounding makes of sums.
            (Aim::Time, Some((units, end))) => (units, end * (1.0 - 8.0 * ROUNDING)),
        };
        let goal = Goal { units, aim };
        let limited = instance.until(horizon);
        let directed = if forward { limited } else { limited.mirrored() };
        let left = self
            .limits
            .labels
            .map_or(u64::MAX, |most| most.saturating_sub(self.labels));
        let most = self.limits.labels_of_a_run.min(left);
        let best = &mut self.best;
        let mut offer = |path: &Path| {
            let mut order = path.order.clone();
            if !forward {
                order.reverse();
            }
            let found = Filled::of(instance, order);
            if let Some(found) = found
                && best.as_ref().is_none_or(|best| found.beats(best))
            {
                *best = Some(found);
            }
        };
        let mut found = run(
            (&directed, Root::default()),
            memory,
            bounds,
            goal,
            (most, self.stop),
            &mut offer,
        );
        if let Some(path) = &mut found.best
            && !forward
        {
            path.order.reverse();
        }
        self.labels += found.labels;
        found
    }

    /// The best path of a complete run bounds all schedules.
    fn tighten(&mut self, path: &Path, aim: Aim) {
        match aim {
            Aim::Worth => self.units_bound = self.units_bound.min(path.units),
            Aim::Time => self.end_bound = self.end_bound.max(path.end),
        }
        self.tell();
    }

    fn tell(&mut self) {
        let now = self.result();
        (self.improved)(&now);
    }

    fn result(&self) -> TimedResult {
        let whole = |best: &&Filled| self.worth.is_whole(best.units);
        let best = self.best.as_ref().filter(whole);
        let best = best.map(|best| TimedOrder {
            begins_s: best.begins().to_vec(),
            end_s: best.end,
            value: self.problem.value_of(&best.order),
            order: best.order.clone(),
        });
        let value = best.as_ref().map_or(0.0, |best| best.value);
        TimedResult {
            value_bound: self.worth.value_of(self.units_bound).max(value),
            end_bound_s: self.end_bound,
            complete: self.proved,
            labels: self.labels,
            best,
        }
    }
}
