//! Orders worth flying at once, found in the pair table alone.

mod local_search;

use super::PairTable;
use super::remainder::Remainder;
use crate::stop::StopSignal;
use local_search::improve;

/// When the shortest order of the table is out of reach: so many different first targets, the ones
/// nearest to the start, give so many candidates.
const CONSTRUCTIONS: usize = 4;

/// A few different orders that are short in the pair table, best guess first.
pub(super) fn candidates(
    table: &PairTable,
    remainder: &Remainder,
    stop: &StopSignal,
) -> Vec<Vec<usize>> {
    let mut orders = match remainder {
        _ if table.targets() == 0 => return Vec::new(),
        Remainder::Exact(subsets) => vec![subsets.shortest_order(table)],
        Remainder::Relaxed(_) => improved_constructions(table, stop),
    };
    // Slews are nearly symmetric in time, and legs that are free at the targets are not: the
    // shortest order of the table is often best flown backwards.
    let reverse: Vec<usize> = orders[0].iter().rev().copied().collect();
    orders.insert(1, reverse);
    let mut distinct: Vec<Vec<usize>> = Vec::with_capacity(orders.len());
    for order in orders {
        if !distinct.contains(&order) {
            distinct.push(order);
        }
    }
    distinct
}

/// Nearest-neighbour orders after local search, shortest first.
fn improved_constructions(table: &PairTable, stop: &StopSignal) -> Vec<Vec<usize>> {
    let mut firsts: Vec<usize> = (0..table.targets()).collect();
    firsts.sort_by(|&a, &b| {
        let far = |target| table.bound(table.start(), target);
        far(a).total_cmp(&far(b)).then(a.cmp(&b))
    });
    firsts.truncate(CONSTRUCTIONS);
    let mut orders: Vec<Vec<usize>> = firsts
        .into_iter()
        .map(|first| improve(table, nearest_neighbours(table, first), stop))
        .collect();
    orders.sort_by(|a, b| {
        length(table, a)
            .total_cmp(&length(table, b))
            .then_with(|| a.cmp(b))
    });
    orders
}

/// Always on to the nearest target, the smallest index among equals.
fn nearest_neighbours(table: &PairTable, first: usize) -> Vec<usize> {
    let mut order = vec![first];
    let mut left: Vec<usize> = (0..table.targets())
        .filter(|&target| target != first)
        .collect();
    let mut from = first;
    while let Some((place, &to)) = left
        .iter()
        .enumerate()
        .min_by(|a, b| table.bound(from, *a.1).total_cmp(&table.bound(from, *b.1)))
    {
        left.remove(place);
        order.push(to);
        from = to;
    }
    order
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
            let built = nearest_neighbours(&table, 0);
            let improved = improve(&table, built.clone(), &StopSignal::new());
            assert!(length(&table, &improved) < length(&table, &built));
            let mut targets = improved;
            targets.sort_unstable();
            assert!(targets.into_iter().eq(0..30));
        }
    }

    #[test]
    fn few_targets_start_from_the_shortest_order_of_the_table() {
        let table = PairTable::new(&RandomModel::new(5, true, 3));
        let remainder = Remainder::new(&table);
        let orders = candidates(&table, &remainder, &StopSignal::new());
        let least = remainder.bound(&table, table.start(), &[0, 1, 2, 3, 4]);
        assert!((length(&table, &orders[0]) - least).abs() < 1e-9);
        assert!(orders[1].iter().rev().eq(&orders[0]));
    }
}
