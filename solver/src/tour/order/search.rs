//! The loop: best-first in rounds.

mod coupled;
mod lagrangian;
mod reporter;
mod tree;

use super::node::SearchNode;
use super::{
    Evaluation, SearchEnd, SearchObserver, SearchResult, SearchSettings, SolvedOrder,
    TourEvaluation, TourModel,
};
use crate::run::pool::SolverPool;
use crate::run::stop::{StopReason, StopSignal};
use reporter::SearchReporter;
use tree::SearchTree;

/// Fewest and most nodes evaluated per round, and their share of the nodes explored before. The later
/// nodes of a round are evaluated without the knowledge that the earlier ones bring, so a part of
/// them is wasted: the share bounds that part, the fewest occupy a small machine from the beginning,
/// the most a large one later on. All are properties of the search, not of the machine: were they
/// the number of threads, the nodes explored would depend on that.
const MIN_NODES: u64 = 4;
const MAX_NODES: u64 = 32;
const EXPLORED_PER_NODE: u64 = 8;

/// After so many nodes the most promising one is completed by the pair table and flown at once.
/// Best-first search alone reaches whole orders late, and a stopped search should have a good one;
/// an order costs as much as a few prefixes, so this may not happen often.
const PROBE_NODES: u64 = 24;

/// After so many nodes a search over few targets that goes on asks for the bounds of longer paths.
const TIGHTEN_NODES: u64 = 160;

/// After so many nodes it prices the legs.
const LAGRANGIAN_NODES: u64 = 960;

/// What is evaluated in a round.
enum RoundTask {
    Node(SearchNode),
    Probe(Vec<usize>),
}

/// TaskResult to a task.
#[derive(Clone, Copy)]
enum TaskResult {
    Prefix(Evaluation),
    Tour(TourEvaluation),
}

impl TaskResult {
    fn is_stopped(self) -> bool {
        matches!(
            self,
            Self::Prefix(Evaluation::Stopped) | Self::Tour(TourEvaluation::Stopped)
        )
    }
}

/// A search under way.
struct OrderSearch<'a> {
    model: &'a dyn TourModel,
    pool: &'a SolverPool,
    stop: &'a StopSignal,
    node_limit: u64,
    /// Number of explored nodes at which an order is probed next.
    next_probe: u64,
    /// Whether the bounds of longer paths have been asked for.
    tightened: bool,
    /// Whether legs have been lagrangian.
    lagrangian: bool,
    tree: SearchTree,
    reporter: SearchReporter<'a>,
}

/// Searches the best orders; some may have been flown before.
#[must_use]
pub fn search(
    model: &dyn TourModel,
    known: &[SolvedOrder],
    settings: &SearchSettings,
    pool: &SolverPool,
    stop: &StopSignal,
    observer: &dyn SearchObserver,
) -> SearchResult {
    let mut search = OrderSearch {
        model,
        pool,
        stop,
        node_limit: settings.node_limit.unwrap_or(u64::MAX),
        next_probe: PROBE_NODES,
        tightened: false,
        lagrangian: false,
        tree: SearchTree::new(model, settings, stop),
        reporter: SearchReporter::new(observer),
    };
    for flown in known {
        let answer = TourEvaluation::Solved(flown.duration_s);
        search.tree.record_candidate(&flown.order, answer);
        search.reporter.is_told(flown.duration_s);
    }
    let mut end = search
        .evaluate_candidates()
        .or_else(|| search.bound_and_improve_orders());
    search.tree.open_root();
    while end.is_none() {
        search.reporter.announce(&search.tree);
        search.reporter.report(&search.tree);
        end = search.explore_round();
    }
    search.reporter.report(&search.tree);
    search
        .reporter
        .finish(search.tree, end.unwrap_or(SearchEnd::Exhausted))
}

impl OrderSearch<'_> {
    /// Flies the orders that the pair table recommends, for a first incumbent.
    fn evaluate_candidates(&mut self) -> Option<SearchEnd> {
        let candidates = self.tree.candidates(self.stop);
        let interrupted = self.evaluate_new(&candidates);
        interrupted.then(|| self.stopped())
    }

    /// Flies the orders that have not been flown; whether that was interrupted.
    fn evaluate_new(&mut self, orders: &[Vec<usize>]) -> bool {
        let fresh: Vec<&Vec<usize>> = orders
            .iter()
            .filter(|order| self.tree.is_new(order))
            .collect();
        let answers = self.pool.map(&fresh, |order| self.evaluate_order(order));
        let mut interrupted = false;
        for (order, answer) in fresh.into_iter().zip(answers) {
            interrupted |= answer == TourEvaluation::Stopped;
            self.tree.record_candidate(order, answer);
        }
        interrupted
    }

    /// One round; says when it was the last.
    fn explore_round(&mut self) -> Option<SearchEnd> {
        if self.tree.is_exhausted() {
            return Some(SearchEnd::Exhausted);
        }
        if self.stop.is_set() {
            return Some(self.stopped());
        }
        let explored = self.tree.statistics().nodes_explored;
        if explored >= TIGHTEN_NODES && !self.tightened {
            self.tightened = true;
            self.tighten();
        }
        if explored >= LAGRANGIAN_NODES && !self.lagrangian {
            self.lagrangian = true;
            self.raise_lagrangian_bound();
        }
        let budget = self.node_limit.saturating_sub(explored);
        if budget == 0 {
            return Some(SearchEnd::NodeLimit);
        }
        let size = (explored / EXPLORED_PER_NODE).clamp(MIN_NODES, MAX_NODES);
        let tasks = self.take_round(size.min(budget));
        let answers = self.pool.map(&tasks, |task| self.evaluate(task));
        let mut interrupted = false;
        for (task, answer) in tasks.into_iter().zip(answers) {
            interrupted |= answer.is_stopped();
            match task {
                RoundTask::Node(node) => self.merge(node, answer),
                RoundTask::Probe(order) => self.merge_probe(&order, answer),
            }
        }
        self.tree.tidy();
        interrupted.then(|| self.stopped())
    }

    /// The nodes of the next round, and now and then an order to probe.
    fn take_round(&mut self, size: u64) -> Vec<RoundTask> {
        let nodes = self.tree.take_round(size, self.pool, self.stop);
        let explored = self.tree.statistics().nodes_explored;
        let mut probe = None;
        if explored >= self.next_probe {
            self.next_probe = explored + PROBE_NODES;
            probe = nodes
                .first()
                .and_then(|best| self.tree.probe(best, self.stop))
                .filter(|order| nodes.iter().all(|node| node.prefix != *order));
        }
        nodes
            .into_iter()
            .map(RoundTask::Node)
            .chain(probe.map(RoundTask::Probe))
            .collect()
    }

    /// Asks the model.
    fn evaluate(&self, task: &RoundTask) -> TaskResult {
        match task {
            RoundTask::Probe(order) => TaskResult::Tour(self.evaluate_order(order)),
            RoundTask::Node(node) if self.tree.is_leaf(node) => {
                TaskResult::Tour(self.evaluate_order(&node.prefix))
            }
            RoundTask::Node(_) if self.stop.is_set() => TaskResult::Prefix(Evaluation::Stopped),
            RoundTask::Node(node) => TaskResult::Prefix(self.model.prefix_bound(&node.prefix)),
        }
    }

    fn evaluate_order(&self, order: &[usize]) -> TourEvaluation {
        if self.stop.is_set() {
            return TourEvaluation::Stopped;
        }
        match self.model.tour(order) {
            // A duration that is no number is no result.
            TourEvaluation::Solved(duration_s) if !duration_s.is_finite() => {
                TourEvaluation::Unresolved
            }
            answer => answer,
        }
    }

    /// Puts the answer to a node into the tree.
    fn merge(&mut self, node: SearchNode, answer: TaskResult) {
        match answer {
            TaskResult::Prefix(Evaluation::Value(bound_s)) => {
                self.tree.bounded(node, Some(bound_s))
            }
            TaskResult::Prefix(Evaluation::Unresolved) => self.tree.bounded(node, None),
            TaskResult::Tour(TourEvaluation::Solved(duration_s)) => {
                self.tree.leaf_solved(&node, duration_s)
            }
            TaskResult::Tour(TourEvaluation::Unresolved) => self.tree.unresolved(&node),
            TaskResult::Prefix(Evaluation::Stopped) | TaskResult::Tour(TourEvaluation::Stopped) => {
                self.tree.put_back(node);
            }
        }
    }

    /// Puts the answer to a probe into the tree.
    fn merge_probe(&mut self, order: &[usize], answer: TaskResult) {
        if let TaskResult::Tour(answer) = answer {
            self.tree.record_candidate(order, answer);
        }
    }

    /// The signal's reason; a model that stops of its own accord counts as a request.
    fn stopped(&self) -> SearchEnd {
        SearchEnd::Stopped(self.stop.reason().unwrap_or(StopReason::Requested))
    }
}
