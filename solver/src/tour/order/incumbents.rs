//! The best orders evaluated so far.

use super::SolvedOrder;
use std::cmp::Ordering;

/// Relative difference below which two durations are a tie: far below the accuracy of an
/// evaluation, far above rounding.
const TIE_RELATIVE: f64 = 1e-9;

/// Maps durations to classes of relative width [`TIE_RELATIVE`]. Unlike a comparison with a
/// tolerance, equality of classes is transitive, which sorting requires.
pub(super) fn tie_class(duration_s: f64) -> f64 {
    (duration_s.max(0.0).ln() / TIE_RELATIVE).round()
}

/// Shorter first, ties in lexicographic order of the indices.
fn rank(a: &SolvedOrder, b: &SolvedOrder) -> Ordering {
    tie_class(a.duration_s)
        .total_cmp(&tie_class(b.duration_s))
        .then_with(|| a.order.cmp(&b.order))
}

/// The best orders, best first, at most a fixed number of them.
#[derive(Debug)]
pub(super) struct Incumbents {
    orders: Vec<SolvedOrder>,
    capacity: usize,
    relative_gap: f64,
}

impl Incumbents {
    /// An empty list with room for the best order and so many alternatives.
    pub(super) fn new(alternatives: usize, relative_gap: f64) -> Self {
        Self {
            orders: Vec::new(),
            capacity: alternatives.saturating_add(1),
            relative_gap,
        }
    }

    /// Adds an order if it is among the best and not listed yet; returns whether it was added.
    pub(super) fn offer(&mut self, order: SolvedOrder) -> bool {
        let place = self
            .orders
            .partition_point(|known| rank(known, &order) == Ordering::Less);
        if place == self.capacity || self.orders.iter().any(|known| known.order == order.order) {
            return false;
        }
        self.orders.insert(place, order);
        self.orders.truncate(self.capacity);
        true
    }

    /// Duration of the best order, s.
    pub(super) fn best_s(&self) -> Option<f64> {
        // Within a tie class the first is the lexicographically smallest, not the shortest.
        self.orders.first().map(|order| order.duration_s)
    }

    /// Whether no completion of a prefix with this bound can enter the list, up to the gap.
    pub(super) fn rule_out(&self, bound: f64, prefix: &[usize]) -> bool {
        match self.compare_with_worst(bound) {
            Ordering::Less => false,
            Ordering::Greater => true,
            // A tie enters the list if it may come first lexicographically.
            Ordering::Equal => {
                let worst = &self.orders[self.capacity - 1].order;
                self.relative_gap > 0.0 || prefix > &worst[..prefix.len()]
            }
        }
    }

    /// Whether no order with this bound can enter the list, up to the gap, whatever its targets.
    pub(super) fn rule_out_bound(&self, bound: f64) -> bool {
        self.compare_with_worst(bound) == Ordering::Greater
    }

    /// Compares a bound with the duration below which an order enters the list; any order enters a
    /// list that is not full.
    fn compare_with_worst(&self, bound: f64) -> Ordering {
        if self.orders.len() < self.capacity {
            return Ordering::Less;
        }
        let worst = self.orders[self.capacity - 1].duration_s;
        tie_class(bound).total_cmp(&tie_class(worst * (1.0 - self.relative_gap)))
    }

    /// The orders so far, best first.
    pub(super) fn orders(&self) -> &[SolvedOrder] {
        &self.orders
    }

    /// The orders, best first.
    pub(super) fn into_orders(self) -> Vec<SolvedOrder> {
        self.orders
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flown(order: &[usize], duration_s: f64) -> SolvedOrder {
        SolvedOrder {
            order: order.to_vec(),
            duration_s,
        }
    }

    #[test]
    fn the_best_are_kept_and_ties_are_ordered_lexicographically() {
        let mut pool = Incumbents::new(1, 0.0);
        assert!(pool.offer(flown(&[2, 1, 0], 5.0)));
        assert!(!pool.offer(flown(&[2, 1, 0], 5.0)));
        assert!(pool.offer(flown(&[0, 1, 2], 5.0 * (1.0 + 1e-14))));
        assert!(!pool.offer(flown(&[1, 0, 2], 6.0)));
        let orders: Vec<_> = pool.into_orders().into_iter().map(|o| o.order).collect();
        assert_eq!(orders, [[0, 1, 2], [2, 1, 0]]);
    }

    #[test]
    fn a_tie_is_ruled_out_only_when_it_comes_later() {
        let mut pool = Incumbents::new(0, 0.0);
        assert!(!pool.rule_out(f64::MAX, &[0]));
        pool.offer(flown(&[1, 0, 2], 5.0));
        assert!(!pool.rule_out(5.0, &[0]));
        assert!(!pool.rule_out(5.0, &[1]));
        assert!(pool.rule_out(5.0, &[2]));
        assert!(pool.rule_out(5.1, &[0]));
        assert!(!pool.rule_out(4.9, &[2]));
    }

    #[test]
    fn the_gap_lowers_the_bound_at_which_nodes_are_ruled_out() {
        let mut pool = Incumbents::new(0, 0.1);
        pool.offer(flown(&[0], 10.0));
        assert!(pool.rule_out(9.1, &[]));
        assert!(!pool.rule_out(8.9, &[]));
    }

    #[test]
    fn zero_durations_are_ordered_too() {
        let mut pool = Incumbents::new(1, 0.0);
        pool.offer(flown(&[1, 0], 0.0));
        pool.offer(flown(&[0, 1], 0.0));
        assert_eq!(pool.best_s().map(f64::to_bits), Some(0));
        assert_eq!(pool.into_orders()[0].order, [0, 1]);
    }
}
