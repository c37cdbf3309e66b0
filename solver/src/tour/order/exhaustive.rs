//! Evaluation of every order: the reference for tests of the search.

use super::incumbents::Incumbents;
use super::{SolvedOrder, TourEvaluation, TourModel};
use crate::run::pool::SolverPool;

/// Evaluates all orders that the rules admit, up to n!, and lists the best one and so many
/// alternatives, best first. Orders that do not resolve are left out. For a handful of targets
/// only.
#[must_use]
pub fn exhaustive(
    model: &dyn TourModel,
    alternatives: usize,
    pool: &SolverPool,
) -> Vec<SolvedOrder> {
    let mut orders = permutations(model.target_count());
    orders.retain(|order| model.rules().admits(order));
    let answers = pool.map(&orders, |order| model.tour(order));
    let mut best = Incumbents::new(alternatives, 0.0);
    for (order, answer) in orders.into_iter().zip(answers) {
        if let TourEvaluation::Solved(duration_s) = answer {
            best.offer(SolvedOrder { order, duration_s });
        }
    }
    best.into_orders()
}

/// All permutations of `0..count`.
pub(super) fn permutations(count: usize) -> Vec<Vec<usize>> {
    let mut orders = vec![Vec::new()];
    for target in 0..count {
        orders = orders
            .iter()
            .flat_map(|order: &Vec<usize>| {
                (0..=order.len()).map(move |place| {
                    let mut longer = order.clone();
                    longer.insert(place, target);
                    longer
                })
            })
            .collect();
    }
    orders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_permutation_is_listed_once() {
        let mut orders = permutations(5);
        assert_eq!(orders.len(), 120);
        orders.sort();
        orders.dedup();
        assert_eq!(orders.len(), 120);
        assert_eq!(permutations(0), [Vec::<usize>::new()]);
    }
}
