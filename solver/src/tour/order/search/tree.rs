//! The search tree: open nodes, evaluated orders, and the bounds of what was given up.

use super::coupled::CoupledBounds;
use crate::model::order_rules::OrderRules;
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use crate::tour::order::completion::{CompletionBound, SpanningTrees};
use crate::tour::order::frontier::Frontier;
use crate::tour::order::heuristics::{self, OrderCost, SearchEffort};
use crate::tour::order::incumbents::Incumbents;
use crate::tour::order::node::SearchNode;
use crate::tour::order::tightening::tighten;
use crate::tour::order::{
    PairTable, SearchSettings, SearchStatistics, SolvedOrder, TourEvaluation, TourModel,
};
use std::collections::BTreeMap;

/// Relative accuracy of the durations of programs ([`crate::model::spec::Accuracy::Standard`]): a bound on legs and the
/// tour of the same legs, on other intervals, may differ by it. A larger difference contradicts the bound.
const ACCURACY: f64 = 5e-4;

/// All orders, each evaluated, open or given up.
pub(super) struct SearchTree {
    table: PairTable,
    /// Whether every order takes as long as its reverse.
    symmetric: bool,
    /// The orders that are searched: with symmetry, half of the admitted ones.
    rules: OrderRules,
    completion: CompletionBound,
    /// Bounds that take couplings into account, once they have been computed.
    couplings: Option<CoupledBounds>,
    /// Lower bound on all orders, s, known before the root is opened.
    root_s: f64,
    /// Whether the root has been opened.
    root_is_open: bool,
    frontier: Frontier,
    incumbents: Incumbents,
    /// Where the search for short orders begins while none has been evaluated.
    first: Option<Vec<usize>>,
    /// Evaluated orders with their duration, s; `None` for those that did not resolve.
    tried: BTreeMap<Vec<usize>, Option<f64>>,
    /// Smallest bound of the nodes that were ruled out, s: they cannot be among the best, up to the
    /// gap.
    ruled_out_s: f64,
    /// Smallest bound of the unresolved leaves and dropped nodes, s.
    lost_s: f64,
    /// Whether the incumbents have changed since the frontier was last pruned.
    improved: bool,
    statistics: SearchStatistics,
}

impl SearchTree {
    /// A tree whose root is not open yet.
    pub(super) fn new(
        model: &dyn TourModel,
        first: Option<&[usize]>,
        settings: &SearchSettings,
        stop: &StopSignal,
    ) -> Self {
        let mut table = PairTable::new(model);
        let trees = tighten(&mut table, model, stop);
        let symmetric = model.is_symmetric();
        let mut rules = table.rules().clone();
        if let (true, Some(nearest)) = (symmetric, nearest_to_start(&table)) {
            rules = rules.in_first_half(nearest);
        }
        Self {
            symmetric,
            first: first.map(<[usize]>::to_vec),
            completion: CompletionBound::new(&table, &rules, trees, stop),
            rules,
            couplings: None,
            root_s: 0.0,
            root_is_open: false,
            frontier: Frontier::new(table.targets(), settings.frontier_bytes),
            incumbents: Incumbents::new(settings.alternatives, settings.relative_gap),
            tried: BTreeMap::new(),
            ruled_out_s: f64::INFINITY,
            lost_s: f64::INFINITY,
            improved: false,
            statistics: SearchStatistics::default(),
            table,
        }
    }

    /// Orders to evaluate first.
    pub(super) fn candidates(&self, stop: &StopSignal) -> Vec<Vec<usize>> {
        heuristics::candidates(&self.table, &self.completion, stop)
    }

    /// Records an order that was evaluated before the search reached it.
    pub(super) fn record_candidate(&mut self, order: &[usize], answer: TourEvaluation) {
        let least = match answer {
            TourEvaluation::Stopped => return,
            TourEvaluation::Unresolved | TourEvaluation::Flyable(_) => None,
            TourEvaluation::Solved(duration_s) => Some(duration_s),
        };
        self.statistics.tours += 1;
        if let Some(duration_s) = answer.duration_s() {
            self.offer(order, duration_s);
        }
        if least.is_none() {
            self.statistics.tours_unresolved += 1;
        }
        let order = self.either_way(order);
        self.tried.insert(order, least);
    }

    /// The pair bounds.
    pub(super) fn table(&self) -> &PairTable {
        &self.table
    }

    /// The same, to raise them.
    pub(super) fn table_mut(&mut self) -> &mut PairTable {
        &mut self.table
    }

    /// The spanning trees that bound paths through many targets.
    pub(super) fn spanning_trees(&self) -> Option<&SpanningTrees> {
        match &self.completion {
            CompletionBound::Relaxed(trees) => Some(trees),
            CompletionBound::Exact(_) => None,
        }
    }

    /// Which orders are searched.
    pub(super) fn rules(&self) -> &OrderRules {
        &self.rules
    }

    /// Raises the lower bound on all orders, s, before the root is opened.
    pub(super) fn bound_root(&mut self, bound_s: f64) {
        self.root_s = self.root_s.max(bound_s);
    }

    /// Takes out the bounds with couplings, to extend them.
    pub(super) fn take_coupled_bounds(&mut self) -> Option<CoupledBounds> {
        self.couplings.take()
    }

    /// Sets the bounds with couplings, and raises the bounds of all open nodes.
    pub(super) fn set_coupled_bounds(&mut self, couplings: CoupledBounds) {
        self.couplings = Some(couplings);
        for mut node in self.frontier.take_if(|_| true) {
            let remaining = node.remaining(self.table.targets());
            let head = node.head;
            self.raise(&mut node, head, &remaining);
            self.admit(node);
        }
    }

    /// Whether there is an order at which a search for short ones can begin.
    pub(super) fn has_first_order(&self) -> bool {
        self.first.is_some() || self.best_s().is_some()
    }

    /// The order at which a search for short ones begins while none is known.
    pub(super) fn first_order(&self) -> Option<&Vec<usize>> {
        self.first.as_ref()
    }

    /// Orders that are short by some costs, best first. The search begins at a given order, else at
    /// the best evaluated one.
    pub(super) fn short_orders<C: OrderCost>(
        &self,
        costs: &C,
        from: Option<&[usize]>,
        effort: &SearchEffort,
        stop: &StopSignal,
    ) -> Vec<Vec<usize>> {
        let best = self.incumbents.orders().first();
        let best = best.map(|best| best.order.as_slice());
        let Some(order) = from.or(best).or(self.first.as_deref()) else {
            return Vec::new();
        };
        heuristics::shorter_orders(costs, self.table.rules(), (&[], order), effort, stop)
    }

    /// Whether an order has not been evaluated.
    pub(super) fn is_new(&self, order: &[usize]) -> bool {
        !self.tried.contains_key(&self.either_way(order))
    }

    /// Lower bound, s, of the path from a place through the remaining targets and to the end.
    fn rest(&self, from: usize, remaining: &[usize]) -> f64 {
        let pairs = self.completion.bound(&self.table, from, remaining);
        let couplings = self.couplings.as_ref();
        couplings.map_or(pairs, |known| pairs.max(known.bound(from, remaining)))
    }

    /// Raises the bounds of a node by a bound of the time until the last fixed target is left, s,
    /// and by the current bounds on the rest and on all orders with the node's prefix.
    fn raise(&self, node: &mut SearchNode, head: f64, remaining: &[usize]) {
        node.raise_head(
            head,
            self.rest(self.table.last_place(&node.prefix), remaining),
        );
        if let Some(known) = &self.couplings {
            node.bound = node.bound.max(known.whole(&node.prefix, remaining));
        }
    }

    /// Lower bound of all orders, s.
    fn root_bound(&self) -> f64 {
        let all: Vec<usize> = (0..self.table.targets()).collect();
        self.rest(self.table.start(), &all).max(self.root_s)
    }

    /// Whether no order can enter the list of the best ones, up to the gap.
    pub(super) fn is_proved(&self) -> bool {
        self.incumbents.rule_out(self.root_bound(), &[])
    }

    /// Opens the root.
    pub(super) fn open_root(&mut self) {
        self.root_is_open = true;
        self.admit(SearchNode::root(self.root_bound()));
        self.tidy();
    }

    /// Whether all targets are fixed.
    pub(super) fn is_leaf(&self, node: &SearchNode) -> bool {
        node.prefix.len() == self.table.targets()
    }

    /// Takes the next nodes to evaluate; nodes that are evaluated already are expanded.
    pub(super) fn take_round(
        &mut self,
        size: u64,
        pool: &SolverPool,
        stop: &StopSignal,
    ) -> Vec<SearchNode> {
        let mut round = Vec::new();
        // With many targets expanding takes long; the stop signal is polled here too.
        while (round.len() as u64) < size && !stop.is_set() {
            let Some(node) = self.frontier.pop() else {
                break;
            };
            if self.is_leaf(&node) || !node.evaluated {
                round.push(node);
            } else {
                self.expand(&node, pool);
            }
        }
        round
    }

    /// The completion of an open node that is shortest in the table, unless it was evaluated
    /// already.
    pub(super) fn probe(&self, node: &SearchNode, stop: &StopSignal) -> Option<Vec<usize>> {
        if self.is_leaf(node) {
            return None;
        }
        let remaining = node.remaining(self.table.targets());
        let order = heuristics::complete(
            &self.table,
            &self.completion,
            &node.prefix,
            &remaining,
            stop,
        );
        self.is_new(&order).then_some(order)
    }

    /// Opens the children of a node.
    fn expand(&mut self, parent: &SearchNode, pool: &SolverPool) {
        let remaining = parent.remaining(self.table.targets());
        let children = pool.map(&remaining, |&next| {
            let prefix = [&*parent.prefix, &[next]].concat();
            let admitted = self.rules.admits(&prefix) && self.rules.completable(&prefix);
            admitted.then(|| self.child(parent, next, &remaining))
        });
        for child in children.into_iter().flatten() {
            self.admit(child);
        }
        self.drop_excess();
    }

    /// The node with one more target, bounded by the pair table.
    fn child(&self, parent: &SearchNode, next: usize, remaining: &[usize]) -> SearchNode {
        let mut left: Vec<usize> = remaining.iter().copied().filter(|&t| t != next).collect();
        let mut child = parent.clone();
        self.append(&mut child, next);
        // With one target left there is one order left, which is evaluated and not bounded.
        if left.len() == 1 {
            self.append(&mut child, left.remove(0));
        }
        // For a single leg from the start the pair bound is all that is known.
        child.evaluated = child.prefix.len() == 1;
        let head = child.head;
        self.raise(&mut child, head, &left);
        child
    }

    /// Fixes one more target by the pair table.
    fn append(&self, node: &mut SearchNode, target: usize) {
        let last = self.table.last_place(&node.prefix);
        node.head += self.table.bound(last, target);
        node.prefix.push(target);
    }

    /// Opens a node unless it is evaluated already or ruled out.
    fn admit(&mut self, node: SearchNode) {
        if self.is_leaf(&node) {
            match self.tried.get(&self.either_way(&node.prefix)) {
                Some(Some(duration_s)) => return self.check(&node, *duration_s),
                Some(None) => return self.lose(node.bound),
                None => {}
            }
        }
        if self.incumbents.rule_out(node.bound, &node.prefix) {
            self.statistics.pruned_by_table += 1;
            self.rule_out(node.bound);
        } else {
            self.frontier.insert(node);
        }
    }

    /// Records the evaluation of a prefix, `None` when it did not resolve.
    pub(super) fn prefix_evaluated(&mut self, mut node: SearchNode, head: Option<f64>) {
        self.statistics.nodes_explored += 1;
        self.statistics.prefixes += 1;
        node.evaluated = true;
        if let Some(head) = head.filter(|head| head.is_finite()) {
            let remaining = node.remaining(self.table.targets());
            self.raise(&mut node, head, &remaining);
        } else {
            self.statistics.prefixes_unresolved += 1;
        }
        if self.incumbents.rule_out(node.bound, &node.prefix) {
            self.statistics.pruned_by_prefix += 1;
            self.rule_out(node.bound);
        } else {
            self.frontier.insert(node);
        }
    }

    /// Records the duration of a leaf.
    pub(super) fn leaf_solved(&mut self, node: &SearchNode, duration_s: f64) {
        self.statistics.nodes_explored += 1;
        self.statistics.tours += 1;
        self.check(node, duration_s);
        self.offer(&node.prefix, duration_s);
        let order = self.either_way(&node.prefix);
        self.tried.insert(order, Some(duration_s));
    }

    /// Records that a leaf did not resolve, with the duration of a flight where there is one.
    pub(super) fn leaf_unresolved(&mut self, node: &SearchNode, flyable_s: Option<f64>) {
        self.statistics.nodes_explored += 1;
        self.statistics.tours += 1;
        self.statistics.tours_unresolved += 1;
        if let Some(duration_s) = flyable_s {
            self.offer(&node.prefix, duration_s);
        }
        self.lose(node.bound);
        let order = self.either_way(&node.prefix);
        self.tried.insert(order, None);
    }

    /// Opens a node again after its evaluation was interrupted.
    pub(super) fn put_back(&mut self, node: SearchNode) {
        self.frontier.insert(node);
    }

    /// Rules out nodes that the incumbents exclude, and drops nodes that do not fit into memory.
    pub(super) fn tidy(&mut self) {
        if self.improved {
            let incumbents = &self.incumbents;
            for node in self
                .frontier
                .take_if(|node| incumbents.rule_out(node.bound, &node.prefix))
            {
                self.statistics.pruned_by_incumbent += 1;
                self.rule_out(node.bound);
            }
            self.improved = false;
        }
        self.drop_excess();
    }

    fn drop_excess(&mut self) {
        while let Some(node) = self.frontier.pop_excess() {
            self.statistics.dropped += 1;
            self.lose(node.bound);
        }
    }

    fn offer(&mut self, order: &[usize], duration_s: f64) {
        let mut list = |order| {
            self.improved |= self.incumbents.offer(SolvedOrder { order, duration_s });
        };
        list(order.to_vec());
        if self.symmetric {
            list(order.iter().rev().copied().collect());
        }
    }

    /// The key of an order: in a symmetric model the lexicographically first of it and its reverse.
    fn either_way(&self, order: &[usize]) -> Vec<usize> {
        let reverse = order.iter().rev().copied().collect();
        if self.symmetric {
            order.to_vec().min(reverse)
        } else {
            order.to_vec()
        }
    }

    /// Counts a leaf whose duration is below its bound by more than the accuracy of programs.
    fn check(&mut self, node: &SearchNode, duration_s: f64) {
        if duration_s < node.bound * (1.0 - ACCURACY) {
            self.statistics.bounds_contradicted += 1;
        }
    }

    fn rule_out(&mut self, bound: f64) {
        self.ruled_out_s = self.ruled_out_s.min(bound);
    }

    fn lose(&mut self, bound: f64) {
        self.lost_s = self.lost_s.min(bound);
    }

    /// Whether nothing is open.
    pub(super) fn is_exhausted(&self) -> bool {
        self.root_is_open && self.frontier.is_empty()
    }

    /// Whether the list of the best is proven up to the gap: nothing is open, and no unresolved or
    /// dropped order could enter it.
    pub(super) fn is_complete(&self) -> bool {
        let nothing_lost = self.lost_s.is_infinite() || self.incumbents.rule_out_bound(self.lost_s);
        self.is_exhausted() && nothing_lost
    }

    /// Lower bound of every order that has not been evaluated, s.
    pub(super) fn open_bound(&self) -> f64 {
        if self.root_is_open {
            self.frontier.bound().min(self.ruled_out_s).min(self.lost_s)
        } else {
            self.root_bound()
        }
    }

    /// Duration of the best evaluated order, s.
    pub(super) fn best_s(&self) -> Option<f64> {
        self.incumbents.best_s()
    }

    /// The work so far.
    pub(super) fn statistics(&self) -> &SearchStatistics {
        &self.statistics
    }

    /// The best orders evaluated so far, best first.
    pub(super) fn orders(&self) -> &[SolvedOrder] {
        self.incumbents.orders()
    }

    /// The best orders, best first.
    pub(super) fn into_orders(self) -> Vec<SolvedOrder> {
        self.incumbents.into_orders()
    }
}

/// The target with the smallest bound from the start; the first among equals.
fn nearest_to_start(table: &PairTable) -> Option<usize> {
    let bound = |target: usize| table.bound(table.start(), target);
    (0..table.targets()).min_by(|&a, &b| bound(a).total_cmp(&bound(b)))
}
