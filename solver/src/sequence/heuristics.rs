//! Orders worth flying at once, found in the pair table alone.

mod local_search;

use super::remainder::Remainder;
use super::{PairTable, TourModel};
use crate::stop::StopSignal;
use local_search::improve;

/// When the shortest order of the table is out of reach: so many different first targets, the ones
/// nearest to the start, give so many candidates.
const CONSTRUCTIONS: usize = 4;

/// An order that is short in the table of a model's pair bounds, without flying any; `None` where
/// there are no targets.
#[must_use]
pub fn short_order(model: &dyn TourModel, stop: &StopSignal) -> Option<Vec<usize>> {
    let table = PairTable::new(model);
    let all: Vec<usize> = (0..table.targets()).collect();
    improved_constructions(&table, &all, stop)
        .into_iter()
        .next()
}

/// A few different orders that are short in the pair table, best guess first.
pub(super) fn candidates(
    table: &PairTable,
    remainder: &Remainder,
    stop: &StopSignal,
) -> Vec<Vec<usize>> {
    let all: Vec<usize> = (0..table.targets()).collect();
    let mut orders = match remainder {
        _ if all.is_empty() => return Vec::new(),
        Remainder::Exact(subsets) => vec![subsets.shortest_order(table, table.start(), &all)],
        Remainder::Relaxed(_) => improved_constructions(table, &all, stop),
    };
    // Slews are nearly symmetric in time, and legs that are free at the targets are not: the
    // shortest order of the table is often best flown backwards.
    let reverse: Vec<usize> = orders[0].iter().rev().copied().collect();
    if table.rules().admits(&reverse) {
        orders.insert(1, reverse);
    }
    let mut distinct: Vec<Vec<usize>> = Vec::with_capacity(orders.len());
    for order in orders {
        if !distinct.contains(&order) {
            distinct.push(order);
        }
    }
    distinct
}

/// A short completion of a prefix that an admitted order begins with.
pub(super) fn complete(
    table: &PairTable,
    remainder: &Remainder,
    prefix: &[usize],
    remaining: &[usize],
    stop: &StopSignal,
) -> Vec<usize> {
    let completion = match remainder {
        Remainder::Exact(subsets) => {
            subsets.shortest_order(table, table.last_place(prefix), remaining)
        }
        Remainder::Relaxed(_) => improve(
            table,
            prefix,
            nearest_neighbours(table, prefix, remaining),
            stop,
        ),
    };
    [prefix, &completion].concat()
}

/// Nearest-neighbour orders after local search, shortest first.
fn improved_constructions(table: &PairTable, all: &[usize], stop: &StopSignal) -> Vec<Vec<usize>> {
    let start = table.start();
    let admitted = |target: &usize| table.rules().completable(&[*target]);
    let mut firsts: Vec<usize> = all.iter().copied().filter(admitted).collect();
    firsts.sort_by(|&a, &b| {
        let far = |target| table.bound(start, target);
        far(a).total_cmp(&far(b)).then(a.cmp(&b))
    });
    firsts.truncate(CONSTRUCTIONS);
    let mut orders: Vec<Vec<usize>> = firsts
        .into_iter()
        .map(|first| {
            let others: Vec<usize> = all.iter().copied().filter(|&t| t != first).collect();
            let mut order = nearest_neighbours(table, &[first], &others);
            order.insert(0, first);
            improve(table, &[], order, stop)
        })
        .collect();
    orders.sort_by(|a, b| {
        length(table, a)
            .total_cmp(&length(table, b))
            .then_with(|| a.cmp(b))
    });
    orders
}

/// From the end of a prefix always on to the nearest of the targets, the smallest index among
/// equals, of those that leave an admitted order.
fn nearest_neighbours(table: &PairTable, prefix: &[usize], targets: &[usize]) -> Vec<usize> {
    let mut path = prefix.to_vec();
    let mut left = targets.to_vec();
    while !left.is_empty() {
        let from = table.last_place(&path);
        // Sorted, since whether an order is left is the dearer question.
        left.sort_by(|&a, &b| {
            let far = |target| table.bound(from, target);
            far(a).total_cmp(&far(b)).then(a.cmp(&b))
        });
        let admitted = |target: &usize| {
            path.push(*target);
            let admitted = table.rules().completable(&path);
            path.pop();
            admitted
        };
        let Some(nearest) = left.iter().position(admitted) else {
            break;
        };
        path.push(left.remove(nearest));
    }
    path.split_off(prefix.len())
}

/// Length of an order in the table, from the start to the end, s.
fn length(table: &PairTable, order: &[usize]) -> f64 {
    let mut from = table.start();
    let mut sum = 0.0;
    for &to in order.iter().chain([&table.end()]) {
        sum += table.bound(from, to);
        from = to;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::tests::RandomModel;
    use super::*;

    #[test]
    fn local_search_keeps_the_targets_and_shortens_the_order() {
        for seed in 0..5 {
            let table = PairTable::new(&RandomModel::new(30, seed % 2 == 0, seed));
            let all: Vec<usize> = (0..30).collect();
            let built = nearest_neighbours(&table, &[], &all);
            let improved = improve(&table, &[], built.clone(), &StopSignal::new());
            assert!(length(&table, &improved) < length(&table, &built));
            let mut targets = improved;
            targets.sort_unstable();
            assert!(targets.into_iter().eq(0..30));
        }
    }

    #[test]
    fn a_completion_keeps_the_prefix_and_visits_the_rest() {
        for targets in [6, 20] {
            let table = PairTable::new(&RandomModel::new(targets, true, 9));
            let remainder = Remainder::new(&table, table.rules());
            let prefix = [3, 1];
            let remaining: Vec<usize> = (0..targets).filter(|t| !prefix.contains(t)).collect();
            let mut order = complete(&table, &remainder, &prefix, &remaining, &StopSignal::new());
            assert_eq!(order[..2], prefix);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..targets));
        }
    }

    #[test]
    fn few_targets_start_from_the_shortest_order_of_the_table() {
        let table = PairTable::new(&RandomModel::new(5, true, 3));
        let remainder = Remainder::new(&table, table.rules());
        let orders = candidates(&table, &remainder, &StopSignal::new());
        let least = remainder.bound(&table, table.start(), &[0, 1, 2, 3, 4]);
        assert!((length(&table, &orders[0]) - least).abs() < 1e-9);
        assert!(orders[1].iter().rev().eq(&orders[0]));
    }
}
