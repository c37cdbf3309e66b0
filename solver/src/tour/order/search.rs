//! The loop of the branch and bound: best-first, in rounds.

mod coupled;
mod lagrangian;
mod reporter;
mod tree;
mod uncoupled;

use super::node::SearchNode;
use super::{
    Evaluation, KnownOrders, SearchEnd, SearchObserver, SearchResult, SearchSettings,
    TourEvaluation, TourModel,
};
use crate::run::pool::SolverPool;
use crate::run::stop::{StopReason, StopSignal};
use reporter::SearchReporter;
use tree::SearchTree;

/// Smallest number of nodes evaluated per round. A round has as many nodes as this, [`MAX_NODES`]
/// and [`EXPLORED_PER_NODE`] allow. The later nodes of a round are evaluated without the results of
/// the earlier ones, and some of that work is wasted; the share of the nodes explored before limits
/// the waste. None of the three depends on the number of threads, so that the nodes explored do not
/// either.
const MIN_NODES: u64 = 4;
/// Largest number of nodes evaluated per round.
const MAX_NODES: u64 = 32;
/// Nodes explored before a round for each of its nodes.
const EXPLORED_PER_NODE: u64 = 8;

/// Nodes between two probes. A probe completes the most promising prefix by the pair table and
/// evaluates the order at once: best-first search alone reaches whole orders late, and a stopped
/// search should have a good one. An order costs as much as a few prefixes.
const PROBE_NODES: u64 = 24;

/// Number of explored nodes at which a search over few targets computes the triple bounds.
const TIGHTEN_NODES: u64 = 160;

/// Number of explored nodes at which a search over few targets computes the Lagrangian bounds.
const LAGRANGIAN_NODES: u64 = 960;

/// A unit of work of a round.
enum RoundTask {
    Node(SearchNode),
    Probe(Vec<usize>),
}

/// Result of a task.
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

/// A running search.
struct OrderSearch<'a> {
    model: &'a dyn TourModel,
    pool: &'a SolverPool,
    stop: &'a StopSignal,
    node_limit: u64,
    /// Number of explored nodes at which the next probe is made.
    next_probe: u64,
    /// Whether the triple bounds have been computed.
    tightened: bool,
    /// Whether the Lagrangian bounds have been computed.
    lagrangian: bool,
    tree: SearchTree,
    reporter: SearchReporter<'a>,
}

/// Searches the best orders.
#[must_use]
pub fn search(
    model: &dyn TourModel,
    known: KnownOrders<'_>,
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
        tree: SearchTree::new(model, known.first, settings, stop),
        reporter: SearchReporter::new(observer),
    };
    if let Some((order, answer)) = known.evaluated {
        search.tree.record_candidate(order, answer);
        if let Some(duration_s) = answer.duration_s() {
            search.reporter.skip(duration_s);
        }
    }
    let mut end = search.evaluate_candidates();
    // A search for a bound alone begins at no order, and needs none that is shorter.
    if known.evaluated.is_some() {
        end = end.or_else(|| search.improve_uncoupled_orders());
    }
    end = end.or_else(|| search.bound_and_improve_orders());
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
    /// Evaluates the orders that are short in the pair table, for a first incumbent. Where one is
    /// known and couplings count, there are better orders to evaluate.
    fn evaluate_candidates(&mut self) -> Option<SearchEnd> {
        if self.tree.has_first_order() && self.has_many_couplings() {
            return None;
        }
        let candidates = self.tree.candidates(self.stop);
        let interrupted = self.evaluate_new(&candidates);
        interrupted.then(|| self.stopped())
    }

    /// Evaluates those orders that have not been evaluated; returns whether that was interrupted.
    fn evaluate_new(&mut self, orders: &[Vec<usize>]) -> bool {
        let fresh: Vec<&Vec<usize>> = orders
            .iter()
            .filter(|order| self.tree.is_new(order))
            .collect();
        let answers = self
            .pool
            .map(&fresh, |order| evaluate_order(self.model, order, self.stop));
        let mut interrupted = false;
        for (order, answer) in fresh.into_iter().zip(answers) {
            interrupted |= answer == TourEvaluation::Stopped;
            self.tree.record_candidate(order, answer);
        }
        interrupted
    }

    /// Whether the search is to stop, or nothing is left to find.
    fn is_settled(&self) -> bool {
        self.stop.is_set() || self.tree.is_proved()
    }

    /// Explores one round; returns why the search ends, if it does.
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

    /// The tasks of the next round: nodes, and an order if a probe is due.
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

    /// Evaluates a task with the model.
    fn evaluate(&self, task: &RoundTask) -> TaskResult {
        match task {
            RoundTask::Probe(order) => {
                TaskResult::Tour(evaluate_order(self.model, order, self.stop))
            }
            RoundTask::Node(node) if self.tree.is_leaf(node) => {
                TaskResult::Tour(evaluate_order(self.model, &node.prefix, self.stop))
            }
            RoundTask::Node(_) if self.stop.is_set() => TaskResult::Prefix(Evaluation::Stopped),
            RoundTask::Node(node) => TaskResult::Prefix(self.model.prefix_bound(&node.prefix)),
        }
    }

    /// Records the result for a node in the tree.
    fn merge(&mut self, node: SearchNode, answer: TaskResult) {
        match answer {
            TaskResult::Prefix(Evaluation::Value(bound_s)) => {
                self.tree.prefix_evaluated(node, Some(bound_s));
            }
            TaskResult::Prefix(Evaluation::Unresolved) => self.tree.prefix_evaluated(node, None),
            TaskResult::Tour(TourEvaluation::Solved(duration_s)) => {
                self.tree.leaf_solved(&node, duration_s);
            }
            TaskResult::Tour(
                answer @ (TourEvaluation::Flyable(_) | TourEvaluation::Unresolved),
            ) => self.tree.leaf_unresolved(&node, answer.duration_s()),
            TaskResult::Prefix(Evaluation::Stopped) | TaskResult::Tour(TourEvaluation::Stopped) => {
                self.tree.put_back(node);
            }
        }
    }

    /// Records the result of a probe in the tree.
    fn merge_probe(&mut self, order: &[usize], answer: TaskResult) {
        if let TaskResult::Tour(answer) = answer {
            self.tree.record_candidate(order, answer);
        }
    }

    /// The end with the signal's reason. Where a model stops without the signal, the reason is a
    /// request.
    fn stopped(&self) -> SearchEnd {
        SearchEnd::Stopped(self.stop.reason().unwrap_or(StopReason::Requested))
    }
}

/// The tour of an order.
fn evaluate_order(model: &dyn TourModel, order: &[usize], stop: &StopSignal) -> TourEvaluation {
    if stop.is_set() {
        return TourEvaluation::Stopped;
    }
    match model.tour(order) {
        // A duration that is not finite is no result.
        TourEvaluation::Solved(duration_s) | TourEvaluation::Flyable(duration_s)
            if !duration_s.is_finite() =>
        {
            TourEvaluation::Unresolved
        }
        answer => answer,
    }
}
