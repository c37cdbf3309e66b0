//! The loop: best-first in rounds.

mod account;
mod tree;

use super::node::Node;
use super::{
    Evaluation, FlownOrder, SearchEnd, SearchResult, SearchSettings, TourEvaluation, TourModel,
};
use crate::pool::SolverPool;
use crate::progress::Observer;
use crate::stop::{StopReason, StopSignal};
use account::Account;
use tree::Tree;

/// Nodes evaluated per round. A property of the search, not of the machine: were it the number of
/// threads, the nodes explored would depend on that. Small, because the later nodes of a round are
/// evaluated without the knowledge that the earlier ones bring.
const ROUND_NODES: u64 = 8;

/// Answer to the evaluation of a node.
#[derive(Clone, Copy)]
enum Answer {
    Prefix(Evaluation),
    Leaf(TourEvaluation),
}

/// A search under way.
struct Search<'a> {
    model: &'a dyn TourModel,
    pool: &'a SolverPool,
    stop: &'a StopSignal,
    node_limit: u64,
    tree: Tree,
    account: Account<'a>,
}

/// Searches the best orders.
#[must_use]
pub fn search(
    model: &dyn TourModel,
    settings: &SearchSettings,
    pool: &SolverPool,
    stop: &StopSignal,
    observer: &dyn Observer,
) -> SearchResult {
    let mut search = Search {
        model,
        pool,
        stop,
        node_limit: settings.node_limit.unwrap_or(u64::MAX),
        tree: Tree::new(model, settings),
        account: Account::new(observer),
    };
    let mut end = search.fly_candidates();
    while end.is_none() {
        search.account.report(&search.tree);
        end = search.explore_round();
    }
    search.account.report(&search.tree);
    search
        .account
        .finish(search.tree, end.unwrap_or(SearchEnd::Exhausted))
}

impl Search<'_> {
    /// Flies the orders that the pair table recommends, for a first incumbent.
    fn fly_candidates(&mut self) -> Option<SearchEnd> {
        let candidates = self.tree.candidates(self.stop);
        let answers = self.pool.map(&candidates, |order| self.fly(order));
        let mut interrupted = false;
        for (order, answer) in candidates.into_iter().zip(answers) {
            interrupted |= answer == TourEvaluation::Stopped;
            self.tree.record_candidate(order, answer);
        }
        self.tree.plant();
        interrupted.then(|| self.stopped())
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
        let budget = ROUND_NODES.min(self.node_limit.saturating_sub(explored));
        if budget == 0 {
            return Some(SearchEnd::NodeLimit);
        }
        let round = self.tree.take_round(budget, self.stop);
        let answers = self.pool.map(&round, |node| self.evaluate(node));
        let mut interrupted = false;
        for (node, answer) in round.into_iter().zip(answers) {
            interrupted |= !self.merge(node, answer);
        }
        self.tree.tidy();
        interrupted.then(|| self.stopped())
    }

    /// Asks the model about a node.
    fn evaluate(&self, node: &Node) -> Answer {
        if self.tree.is_leaf(node) {
            Answer::Leaf(self.fly(&node.prefix))
        } else if self.stop.is_set() {
            Answer::Prefix(Evaluation::Stopped)
        } else {
            Answer::Prefix(self.model.prefix_bound(&node.prefix))
        }
    }

    fn fly(&self, order: &[usize]) -> TourEvaluation {
        if self.stop.is_set() {
            return TourEvaluation::Stopped;
        }
        match self.model.tour(order) {
            // A duration that is no number is no result.
            TourEvaluation::Flown(duration_s) if !duration_s.is_finite() => {
                TourEvaluation::Unresolved
            }
            answer => answer,
        }
    }

    /// Puts an answer into the tree; false when the evaluation was interrupted.
    fn merge(&mut self, node: Node, answer: Answer) -> bool {
        match answer {
            Answer::Prefix(Evaluation::Stopped) | Answer::Leaf(TourEvaluation::Stopped) => {
                self.tree.put_back(node);
                return false;
            }
            Answer::Prefix(Evaluation::Value(bound_s)) => self.tree.bounded(node, Some(bound_s)),
            Answer::Prefix(Evaluation::Unresolved) => self.tree.bounded(node, None),
            Answer::Leaf(TourEvaluation::Flown(duration_s)) => {
                let order = node.prefix.clone();
                self.tree.flown(&node, FlownOrder { order, duration_s });
            }
            Answer::Leaf(TourEvaluation::Unresolved) => self.tree.unresolved(&node),
        }
        true
    }

    /// The signal's reason; a model that stops of its own accord counts as a request.
    fn stopped(&self) -> SearchEnd {
        SearchEnd::Stopped(self.stop.reason().unwrap_or(StopReason::Requested))
    }
}
