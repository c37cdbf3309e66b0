//! Branch and bound over the beginnings of schedules whose legs couple.
//!
//! A node is a beginning: targets, each with the window in which it is visited. The program of its last
//! chain, since the last place at which the body may wait, gives a lower bound on the time at which the
//! last target is left, and the times of single legs bound what may follow ([`Continuations`]). The best
//! nodes are the next: more worth first, then an earlier end. What may follow them best is also solved
//! as a whole schedule.

mod node;
mod whole;

use super::chains::{NoChain, SolvedChain, may_wait, solve_chain};
use super::enough_s;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::Place;
use crate::tour::planner::tours::Tours;
use crate::tour::schedule::{Beginning, Continuations, Rank, TimedResult};
use node::{Choice, Node};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use whole::{WholeSchedule, departure_of, first_windows, solve_whole};

/// Nodes whose programs are solved at the same time. Not a number of threads, on which the answer would
/// depend.
const BATCH: usize = 4;

/// A solved schedule.
#[derive(Debug, Clone)]
pub(super) struct CoupledSchedule {
    pub(super) order: Vec<usize>,
    pub(super) chains: Vec<SolvedChain>,
    pub(super) rank: Rank,
}

impl CoupledSchedule {
    /// When the visits of its targets begin, s.
    pub(super) fn begins(&self) -> Vec<f64> {
        let begins = self.chains.iter().flat_map(|chain| &chain.begins);
        begins.take(self.order.len()).copied().collect()
    }
}

/// The state of a search.
pub(super) struct CoupledSearch<'a> {
    tours: &'a Tours<'a>,
    pool: &'a SolverPool,
    stop: &'a StopSignal,
    continuations: Continuations,
    pub(super) best: Option<CoupledSchedule>,
    frontier: BinaryHeap<Node>,
    /// The best bound of the nodes in work.
    working: Option<Rank>,
    /// Whether later ends than that of the best schedule are of no interest any more.
    is_about_time: bool,
    /// Orders with windows that have been solved as a whole, and whether a solve was undecided.
    solved: HashMap<Vec<(usize, Option<usize>)>, bool>,
    /// Earliest departures by the set of targets and the last of them, where the body may wait.
    departures: HashMap<(Vec<usize>, usize), f64>,
    /// The best bound of what was given up without a proof.
    given_up: Option<Rank>,
    pub(super) nodes: u64,
}

impl<'a> CoupledSearch<'a> {
    /// A search with only the beginning without visits, and bounds from lower bounds on the times of legs:
    /// what may follow beginnings, and the best schedule.
    pub(super) fn new(
        tours: &'a Tours<'a>,
        (pool, stop): (&'a SolverPool, &'a StopSignal),
        (continuations, relaxed): (Continuations, &TimedResult),
    ) -> Self {
        let bound = match &relaxed.best {
            Some(best) if relaxed.complete => Rank {
                units: continuations.units_of_all(&best.order),
                end_s: relaxed.end_bound_s,
            },
            _ => Rank::BEST,
        };
        let mut search = Self {
            tours,
            pool,
            stop,
            continuations,
            best: None,
            frontier: BinaryHeap::new(),
            working: Some(bound),
            is_about_time: false,
            solved: HashMap::new(),
            departures: HashMap::new(),
            given_up: None,
            nodes: 0,
        };
        if let Some((root, _)) = search.bounded(Node::root(bound)) {
            search.frontier.push(root);
        }
        search.working = None;
        search
    }

    /// A search with other bounds that knows the schedules of this one, of which no node has been opened.
    pub(super) fn tightened(self, bounds: (Continuations, &TimedResult)) -> Self {
        let mut search = Self::new(self.tours, (self.pool, self.stop), bounds);
        search.best = self.best;
        search.solved = self.solved;
        search.narrow();
        search
    }

    /// Bound on all schedules; `None` where there is none.
    pub(super) fn bound(&self) -> Option<Rank> {
        let known = self.best.as_ref().map(|best| best.rank);
        let all = [self.open_bound(), known, self.given_up];
        all.into_iter().flatten().max_by(Rank::compare)
    }

    fn open_bound(&self) -> Option<Rank> {
        let open = self.frontier.peek().map(|node| node.bound);
        [open, self.working]
            .into_iter()
            .flatten()
            .max_by(Rank::compare)
    }

    /// Whether nothing that is open or given up can be better than the best schedule by more than the
    /// gap.
    pub(super) fn is_complete(&self) -> bool {
        let open = [self.open_bound(), self.given_up];
        open.into_iter()
            .flatten()
            .all(|rank| !self.is_of_interest(rank))
    }

    /// How good the best schedule is.
    pub(super) fn rank(&self) -> Option<Rank> {
        self.best.as_ref().map(|best| best.rank)
    }

    /// The motion of the best schedule.
    pub(super) fn chains(&self) -> Option<&[SolvedChain]> {
        self.best.as_ref().map(|best| &best.chains[..])
    }

    /// The values that go with a rank.
    pub(super) fn value_of(&self, rank: Rank) -> f64 {
        self.continuations.value_of(rank.units)
    }

    fn is_of_interest(&self, bound: Rank) -> bool {
        let Some(best) = &self.best else { return true };
        let enough = enough_s(self.tours.places, best.rank.end_s);
        bound.units > best.rank.units || bound.units == best.rank.units && bound.end_s < enough
    }

    /// Works on the best nodes; false where there are none, or the search is to end.
    pub(super) fn step(&mut self) -> bool {
        let limit = self.tours.places.scenario.options().node_limit;
        if limit.is_some_and(|limit| self.nodes >= limit) || self.stop.is_set() {
            return false;
        }
        let mut batch = Vec::new();
        while batch.len() < BATCH
            && let Some(node) = self.frontier.pop()
        {
            if self.is_of_interest(node.bound) {
                batch.push(node);
            }
        }
        let Some(first) = batch.first() else {
            return false;
        };
        self.working = Some(first.bound);
        self.turn_to_time();
        self.nodes += batch.len() as u64;
        let (ready, open): (Vec<Node>, Vec<Node>) =
            batch.into_iter().partition(|node| node.is_evaluated);
        let evaluated = self.pool.map(&open, |node| self.evaluated(node.clone()));
        for node in ready {
            self.expand(&node);
        }
        for (node, rest) in evaluated.into_iter().flatten() {
            self.open(node, rest);
        }
        self.working = None;
        !self.stop.is_set()
    }

    /// Solves an order as a whole, each target in its first window that is left; whether it is better
    /// than the best schedule.
    pub(super) fn try_order(&mut self, order: &[usize]) -> bool {
        let choices = first_windows(self.tours, order);
        choices.is_some_and(|choices| self.try_whole(&choices, None))
    }

    /// Solves a whole schedule. Where that is not decided, schedules as good as the bound may be missed.
    fn try_whole(&mut self, choices: &[Choice], bound: Option<Rank>) -> bool {
        let order: Vec<usize> = choices.iter().map(|choice| choice.target).collect();
        let units = self.continuations.units_of_all(&order);
        if !self.continuations.is_whole(units) {
            return false;
        }
        let key: Vec<_> = choices
            .iter()
            .map(|choice| (choice.target, choice.window))
            .collect();
        let mut found = None;
        let undecided = *self.solved.entry(key).or_insert_with(|| {
            let whole = solve_whole(self.tours, choices);
            let undecided = matches!(whole, Err(NoChain::Unresolved | NoChain::Stopped));
            found = whole.ok();
            undecided
        });
        if undecided {
            self.give_up(bound);
        }
        let Some(WholeSchedule { chains, end }) = found else {
            return false;
        };
        let rank = Rank { units, end_s: end };
        // A motion that may not be the earliest one leaves its bound open.
        if chains.iter().any(|chain| !chain.is_least) {
            self.give_up(bound);
        }
        let better = self
            .best
            .as_ref()
            .is_none_or(|best| rank.compare(&best.rank) == Ordering::Greater);
        if better {
            self.best = Some(CoupledSchedule {
                order,
                chains,
                rank,
            });
            self.narrow();
        }
        better
    }

    fn give_up(&mut self, bound: Option<Rank>) {
        let all = [self.given_up, bound];
        self.given_up = all.into_iter().flatten().max_by(Rank::compare);
    }

    /// Nothing worse than the best schedule is of interest any more.
    fn narrow(&mut self) {
        let Some(best) = &self.best else { return };
        let open = self.open_bound();
        self.is_about_time |= open.is_none_or(|open| open.units <= best.rank.units);
        let before = if self.is_about_time {
            best.rank.end_s
        } else {
            f64::INFINITY
        };
        self.continuations = self.continuations.narrowed(best.rank.units, before);
    }

    /// Narrows once no more worth can be found.
    fn turn_to_time(&mut self) {
        if !self.is_about_time && self.best.is_some() {
            let known = self.best.as_ref().map(|best| best.rank.units);
            let open = self.open_bound().map(|open| open.units);
            if open <= known {
                self.narrow();
            }
        }
    }

    /// A node with the bound of its program, and what may follow best; `None` where nothing does.
    fn evaluated(&self, mut node: Node) -> Option<(Node, Option<Vec<usize>>)> {
        let (from, visits) = node.chain(self.tours.places.scenario.targets());
        match solve_chain(self.tours, (from, node.anchor.1), &visits) {
            Err(NoChain::TooLate) => return None,
            Err(NoChain::Stopped) => return Some((node, None)),
            Ok(solved) if solved.is_least => {
                node.departure = node.departure.max(departure_of(self.tours, &solved));
            }
            Ok(_) | Err(NoChain::Unresolved) => node.is_flown = false,
        }
        node.is_evaluated = true;
        if may_wait(self.tours.places, node.last()) {
            node.anchor = (node.visits.len(), node.departure);
        }
        self.bounded(node)
    }

    /// Puts an evaluated node on the frontier, and solves what may follow best.
    fn open(&mut self, node: Node, rest: Option<Vec<usize>>) {
        if self.is_dominated(&node) {
            return;
        }
        if let Some(rest) = rest
            && node.is_evaluated
        {
            let order: Vec<usize> = node.order().into_iter().chain(rest).collect();
            self.try_order(&order);
        }
        if self.is_of_interest(node.bound) {
            self.frontier.push(node);
        }
    }

    /// Whether the same targets with the same last one, where the body may wait, were left earlier.
    fn is_dominated(&mut self, node: &Node) -> bool {
        let Place::Target(last) = node.last() else {
            return false;
        };
        if !node.is_evaluated || node.anchor.0 < node.visits.len() {
            return false;
        }
        let mut set = node.order();
        set.sort_unstable();
        let known = self.departures.entry((set, last)).or_insert(f64::INFINITY);
        if node.departure >= *known {
            return true;
        }
        if node.is_flown {
            *known = node.departure;
        }
        false
    }

    /// The node with its bound, and what may follow best.
    fn bounded(&self, mut node: Node) -> Option<(Node, Option<Vec<usize>>)> {
        let order = node.order();
        let beginning = Beginning {
            order: &order,
            departure_s: node.departure,
        };
        let best = self.continuations.of(beginning, node.bound)?;
        if best.bound.compare(&node.bound) == Ordering::Less {
            node.bound = best.bound;
        }
        self.is_of_interest(node.bound)
            .then_some((node, best.order))
    }

    /// Solves the schedule that ends with a beginning, and opens the beginnings with one more target.
    fn expand(&mut self, node: &Node) {
        let order = node.order();
        let to_end = match self.tours.places.scenario.end() {
            Some(_) => self.tours.leg_bound(node.last(), Place::End),
            None => 0.0,
        };
        let ends_here = Rank {
            units: self.continuations.units_of_all(&order),
            end_s: node.departure + to_end,
        };
        self.try_whole(&node.visits, Some(ends_here));
        let beginning = Beginning {
            order: &order,
            departure_s: node.departure,
        };
        let targets = self.tours.places.scenario.targets();
        let mut children = Vec::new();
        for target in self.continuations.followers(beginning) {
            let leg = self.tours.leg_bound(node.last(), Place::Target(target));
            children.extend(node.with(target, node.departure + leg, targets));
        }
        let bounded = self
            .pool
            .map(&children, |child| self.bounded(child.clone()));
        let bounded = bounded.into_iter().flatten();
        self.frontier.extend(bounded.map(|(child, _)| child));
    }
}
