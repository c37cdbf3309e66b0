//! Moves: their change of the cost and their effect on the order.

use super::models::{Couplings, Legs, RandomCost};
use crate::math::random::SplitMix;
use crate::tour::order::heuristics::cost::{ReducedLegs, length};
use crate::tour::order::heuristics::path::{Move, OrderPath};

/// A random move of an order of so many targets, of which there are at least two.
fn random_move(random: &mut SplitMix, targets: usize) -> Move {
    let mut ends = [(); 2].map(|()| 1 + random.below(targets));
    ends.sort_unstable();
    let [first, last] = ends;
    if first == last || random.below(3) == 0 {
        return Move::Reverse(first, last);
    }
    Move::Exchange {
        first,
        middle: first + random.below(last - first),
        last,
        reverse_first: random.below(2) == 0,
        reverse_second: random.below(2) == 0,
    }
}

#[test]
fn the_change_of_a_move_is_the_difference_of_the_lengths() {
    for legs in [Legs::Points, Legs::Dwells, Legs::Directed] {
        for couplings in [Couplings::None, Couplings::BothWays, Couplings::Directed] {
            for targets in [2, 3, 5, 12] {
                let cost = RandomCost::new(targets, legs, couplings, targets as u64);
                let order: Vec<usize> = (0..targets).collect();
                let mut path = OrderPath::new(&cost, targets, &order);
                let mut random = SplitMix::new(1);
                let mut before = path.length();
                for _ in 0..1000 {
                    let step = random_move(&mut random, targets);
                    let change = path.change(step);
                    let below = |limit| path.change_below(limit, step).is_some();
                    assert!(below(change + 1e-9) && !below(change - 1e-9));
                    path.apply(step);
                    let after = length(&cost, targets, path.order());
                    let expected = after - before;
                    assert!(
                        (change - expected).abs() < 1e-9,
                        "{legs:?} {couplings:?} {targets} {step:?}: {change} for {expected}"
                    );
                    before = after;
                }
            }
        }
    }
}

#[test]
fn a_preview_leaves_the_order_unchanged() {
    let cost = RandomCost::new(9, Legs::Directed, Couplings::Directed, 4);
    let order: Vec<usize> = (0..9).collect();
    let mut path = OrderPath::new(&cost, 9, &order);
    let mut random = SplitMix::new(2);
    for _ in 0..200 {
        let (shown, probe) = (random_move(&mut random, 9), random_move(&mut random, 9));
        let change = path.change(probe);
        let mut seen = Vec::new();
        assert!(path.preview(shown, |order| {
            seen = order.to_vec();
            true
        }));
        assert!(path.order().iter().eq(&order));
        assert!((path.change(probe) - change).abs() < 1e-9);
        let mut moved = OrderPath::new(&cost, 9, &order);
        moved.apply(shown);
        assert_eq!(seen, moved.order());
    }
}

#[test]
fn reduced_legs_are_symmetric_with_dwells_but_not_with_directed_costs() {
    let order: Vec<usize> = (0..12).collect();
    let symmetric = |kind| {
        let cost = RandomCost::new(12, kind, Couplings::None, 6);
        ReducedLegs::new(&cost, 12, &order).are_symmetric()
    };
    assert!(symmetric(Legs::Points));
    assert!(symmetric(Legs::Dwells));
    assert!(!symmetric(Legs::Directed));
}
