//! The order of the targets: branch and bound over partial orders.
//!
//! # Problem
//!
//! A tour leaves the start, visits each of n targets once and, where an end is prescribed, goes on
//! to it. The duration `T(order)` of a whole order comes from an expensive evaluation: rates left
//! free at a target couple the legs before and after it, so `T` is not a sum over pairs. Wanted are
//! the order of least duration among those that [`OrderRules`] admit, the next best `k` orders, and
//! a lower bound on all orders that were not evaluated.
//!
//! # Bounds
//!
//! A node fixes a prefix `p` of the order; `l` is its last place and `R` the set of targets not in
//! it. Cut any tour that begins with `p` at the moment it leaves `l`:
//!
//! - What comes before lasts at least `head(p)`, the greater of [`TourModel::prefix_bound`] and
//!   `head(parent) + d(parent's last, l)`, with `d` the pair bounds; `head` of the root is 0.
//! - What comes after is a path from `l` through all of `R` (and to the end). Each of its legs
//!   lasts at least its pair bound, so all of it lasts at least `rest(l, R)`, the shortest such
//!   path in the pair table ([`completion`]: dynamic programming over subsets, or the spanning tree
//!   relaxation of it when there are many targets).
//!
//! Hence `head(p) + rest(l, R)` is a lower bound on every completion of `p`. So is the parent's
//! bound, because the parent's completions include those of `p`; a node takes the greater of the
//! two, and bounds never fall on the way down the tree. Where [`OrderRules`] restrict the orders,
//! only prefixes of admitted orders are opened. Which targets may come next depends on the set of
//! visited targets and not on their order, so the dynamic program takes the rules into account and
//! remains exact. The spanning tree ignores the rules; the minimum over more paths is still a lower
//! bound. A node enters the frontier with the bound that needs no evaluation (the parent's head
//! plus one pair bound); its own evaluation is made only when it is taken out.
//!
//! Where legs couple, a longer search computes tighter bounds on what comes after a prefix
//! ([`triple_bounds`]) and then bounds on all orders with a prefix ([`lagrangian`]).
//!
//! # Symmetry
//!
//! Where every order takes as long as its reverse, it is enough to search the orders that visit one
//! chosen target in the first half: they contain one of every order and its reverse. The dynamic
//! program is restricted in the same way, and both orders of each pair are listed. The chosen
//! target is the one nearest to the start: good orders visit it early or late, and the late ones
//! are excluded at the root.
//!
//! # Validity of the bound
//!
//! At every moment each order belongs to exactly one of these sets: evaluated, below a node of the
//! frontier, under evaluation, or given up (pruned, unresolved, or dropped for memory). The
//! reported bound is the minimum over the durations of the evaluated orders and the bounds of all
//! others.
//!
//! # Determinism
//!
//! A round takes the first nodes in the order (bound, prefix), as many as follow from the number of
//! nodes explored before, evaluates them in parallel and merges the answers in that order. Unless
//! the search is stopped from outside, nothing in the result depends on the number of threads.

pub mod completion;
mod exhaustive;
mod frontier;
mod heuristics;
mod incumbents;
pub mod lagrangian;
mod node;
mod search;
mod table;
#[cfg(test)]
mod tests;
mod tightening;
pub mod triple_bounds;

pub use exhaustive::exhaustive;
pub(crate) use heuristics::short_coupled_order;
pub use heuristics::short_order;
pub use search::search;
pub use table::PairTable;
pub(crate) use tightening::least_bound;

use crate::model::order_rules::OrderRules;
use crate::run::progress::Progress;
use crate::run::stop::StopReason;

/// Where a leg begins or ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// The state at time zero.
    Start,
    /// A target by its index.
    Target(usize),
    /// The prescribed end.
    End,
}

impl Place {
    /// The number in tables of so many places: the start comes first and the end last.
    #[must_use]
    pub const fn number(self, places: usize) -> usize {
        match self {
            Self::Start => 0,
            Self::Target(index) => 1 + index,
            Self::End => places - 1,
        }
    }
}

/// Answer of [`TourModel::prefix_bound`] and [`TourModel::path_bound`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Evaluation {
    /// The lower bound, s.
    Value(f64),
    /// The evaluation did not converge; nothing is known beyond what was known before.
    Unresolved,
    /// The evaluation was interrupted by the stop signal.
    Stopped,
}

/// Answer of [`TourModel::tour`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TourEvaluation {
    /// Duration of the tour in this order, s.
    Solved(f64),
    /// Duration of a flight in this order, s, that is no minimum: there may be faster ones.
    Flyable(f64),
    /// The evaluation did not converge; the order may or may not be good.
    Unresolved,
    /// The evaluation was interrupted by the stop signal.
    Stopped,
}

impl TourEvaluation {
    /// Duration of the flight that it has found, s.
    #[must_use]
    pub fn duration_s(self) -> Option<f64> {
        match self {
            Self::Solved(duration_s) | Self::Flyable(duration_s) => Some(duration_s),
            Self::Unresolved | Self::Stopped => None,
        }
    }
}

/// Costate at the passage of a target: derivative of the tour's duration with respect to each
/// component of the state in which the target is passed, s per unit of the component.
pub type PassageCostate = Vec<f64>;

/// All that the search knows of legs and tours.
///
/// Durations are in seconds, finite and not negative. Equal questions must get equal answers,
/// whichever thread asks.
pub trait TourModel: Sync {
    /// Number of targets.
    fn target_count(&self) -> usize;

    /// Whether the tour goes on to a prescribed end after the last target.
    fn has_end(&self) -> bool;

    /// Which orders are admitted: at least one. The search evaluates no other.
    fn rules(&self) -> &OrderRules;

    /// Whether every order is admitted and takes as long as its reverse.
    fn is_symmetric(&self) -> bool {
        false
    }

    /// Lower bound, s, of the time from leaving `from` to leaving `to` in any tour; settling and
    /// dwelling at `to` are included. Called once for every pair, and again where it was raised. A
    /// value that is not finite means that no bound is known and is read as 0.
    fn pair_bound(&self, from: Place, to: Place) -> f64;

    /// Whether [`Self::raise_pair_bounds`] may raise the bound of a pair.
    fn is_open(&self, from: Place, to: Place) -> bool {
        let _ = (from, to);
        false
    }

    /// Raises the bounds of some open pairs, as far as the stop signal allows. Expensive.
    fn raise_pair_bounds(&self, pairs: &[(Place, Place)]) {
        let _ = pairs;
    }

    /// Lower bound, s, of the time from the start to leaving the last target of a prefix, in any
    /// tour that begins with it: the last target has its own conditions only. Expensive. The prefix
    /// has at least two targets and lacks at least two: for one target the pair bound is used, and
    /// with one target left the whole order is evaluated.
    fn prefix_bound(&self, prefix: &[usize]) -> Evaluation;

    /// Lower bound, s, of the time from leaving the first place of a path to leaving its last, in
    /// any tour that contains it; settling and dwelling are included but for the first place.
    /// Expensive. The path has three or five places, all different, targets but for its ends: the
    /// start only comes first and a prescribed end only last.
    fn path_bound(&self, path: &[Place]) -> Evaluation;

    /// Whether the legs before and after a target couple. Where they do not, the bound of a path is
    /// the sum of those of its parts and is not asked for.
    fn couples(&self, via: usize) -> bool;

    /// Whether any target couples its legs.
    fn has_couplings(&self) -> bool {
        (0..self.target_count()).any(|via| self.couples(via))
    }

    /// The states in which the leg between two places would begin and end if no other leg coupled
    /// with it, scaled so that the largest component of the difference of two states is the time, s,
    /// that the change from one to the other takes. Estimates the bounds of paths that nobody has
    /// asked for.
    fn free_ends(&self, from: Place, to: Place) -> [[f64; 3]; 2] {
        let _ = (from, to);
        [[0.0; 3]; 2]
    }

    /// Solves the tour of a whole order, to the end where there is one. Expensive.
    fn tour(&self, order: &[usize]) -> TourEvaluation;

    /// Times of the legs of the tour of a whole order, s, each with settling and dwelling at its end;
    /// `None` where the order does not resolve or the model has no motions.
    fn leg_times(&self, order: &[usize]) -> Option<Vec<f64>> {
        let _ = order;
        None
    }

    /// Costates of the tour of a whole order at each of its targets that a leg leaves: by how much
    /// the state there shortens the legs before it, to first order, and lengthens those after it.
    /// `None` where the order does not resolve or the model has no states. In a symmetric model the
    /// reverse order has the same costates.
    fn costates(&self, order: &[usize]) -> Option<Vec<PassageCostate>> {
        let _ = order;
        None
    }

    /// Lower bound, s, over all tours with this leg, of the time from leaving one place to leaving
    /// the other, minus the first costate times the state in which the first place is left, plus
    /// the second costate times the state in which the other is reached. A missing costate is zero.
    /// Expensive.
    fn lagrangian_leg(&self, leg: [Place; 2], costates: [Option<&[f64]>; 2]) -> Evaluation {
        let _ = costates;
        Evaluation::Value(self.pair_bound(leg[0], leg[1]))
    }
}

/// Receives reports of a search between its rounds.
pub trait SearchObserver: Sync {
    /// The state of the search.
    fn progress(&self, progress: Progress);

    /// A better order than all before was found, and the search goes on. Called at most once in a
    /// round, before the progress with its duration.
    fn improved(&self, incumbent: &Incumbent<'_>);
}

/// The best orders of a running search.
#[derive(Debug, Clone, Copy)]
pub struct Incumbent<'a> {
    /// The best order.
    pub best: &'a SolvedOrder,
    /// The next best orders.
    pub alternatives: &'a [SolvedOrder],
    /// No order lasts less, s, provided that the model's bounds are admissible.
    pub lower_bound_s: f64,
    /// The work so far.
    pub statistics: SearchStatistics,
}

/// Orders that are known before a search.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct KnownOrders<'a> {
    /// An order that is evaluated.
    pub evaluated: Option<(&'a [usize], TourEvaluation)>,
    /// Where the search for short orders begins while none is solved.
    pub first: Option<&'a [usize]>,
}

/// What to search for, and when to end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// How many orders to prove and list besides the best.
    pub alternatives: usize,
    /// Branches that cannot beat the worst listed order by more than this share are not searched;
    /// in `[0, 1)`.
    pub relative_gap: f64,
    /// Nodes to explore at most; `None` is unlimited.
    pub node_limit: Option<u64>,
    /// Approximate memory for open nodes, bytes. Beyond it the nodes with the largest bounds are
    /// dropped; their bounds remain part of the result, which is then incomplete.
    pub frontier_bytes: usize,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            alternatives: 0,
            relative_gap: 0.0,
            node_limit: None,
            frontier_bytes: frontier::DEFAULT_BYTES,
        }
    }
}

/// An order with its duration.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedOrder {
    /// Indices of the targets in visiting order.
    pub order: Vec<usize>,
    /// Duration of the tour, s.
    pub duration_s: f64,
}

/// Why the search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchEnd {
    /// Nothing was left to explore.
    Exhausted,
    /// The node limit was reached.
    NodeLimit,
    /// The stop signal was given.
    Stopped(StopReason),
}

/// Counts of the work of a search.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SearchStatistics {
    /// Nodes explored: evaluated prefixes and evaluated leaves of the tree.
    pub nodes_explored: u64,
    /// Prefixes evaluated.
    pub prefixes: u64,
    /// Prefixes whose evaluation did not converge.
    pub prefixes_unresolved: u64,
    /// Whole orders evaluated, the heuristic ones included.
    pub tours: u64,
    /// Whole orders whose evaluation did not converge.
    pub tours_unresolved: u64,
    /// Nodes pruned by the pair table alone, before any evaluation of their own.
    pub pruned_by_table: u64,
    /// Nodes pruned by their own evaluation.
    pub pruned_by_prefix: u64,
    /// Open nodes pruned when a better order was found.
    pub pruned_by_incumbent: u64,
    /// Nodes dropped because memory was full.
    pub dropped: u64,
    /// Orders whose duration is below one of their bounds: the model's bounds are then not
    /// admissible, for instance because a relaxed problem was solved to a local minimum only.
    pub bounds_contradicted: u64,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchResult {
    /// The best order found.
    pub best: Option<SolvedOrder>,
    /// The next best orders found, at most as many as asked for.
    pub alternatives: Vec<SolvedOrder>,
    /// No order lasts less, s, provided that the model's bounds are admissible.
    pub lower_bound_s: f64,
    /// Whether the tree was exhausted within the gap, so that best and alternatives are proven.
    pub complete: bool,
    /// Why the search ended.
    pub end: SearchEnd,
    /// Counts of its work.
    pub statistics: SearchStatistics,
}

impl SearchResult {
    /// Whether the best order is proven within a relative gap. This can hold while the alternatives
    /// are not proven, that is while the search is not complete.
    #[must_use]
    pub fn best_is_proven(&self, relative_gap: f64) -> bool {
        self.best.as_ref().is_some_and(|best| {
            let needed = best.duration_s * (1.0 - relative_gap);
            incumbents::tie_class(self.lower_bound_s) >= incumbents::tie_class(needed)
        })
    }
}
