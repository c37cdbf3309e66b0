//! The places nearest to each place.

use super::cost::ReducedLegs;

/// Neighbours per place. Fewer suffice for symmetric legs but not for directed ones.
const NEIGHBOURS: usize = 10;

/// For every place the nearest others, nearest first.
#[derive(Debug)]
pub(super) struct Neighbours {
    width: usize,
    nearest: Vec<usize>,
}

impl Neighbours {
    /// The neighbours of the places of a path, of which there are at least two.
    pub(super) fn new(legs: &ReducedLegs, places: &[usize]) -> Self {
        let count = places.iter().max().map_or(0, |greatest| greatest + 1);
        let width = NEIGHBOURS.min(places.len() - 1);
        let mut nearest = vec![0; count * width];
        for &place in places {
            let mut others: Vec<usize> = places.iter().copied().filter(|&p| p != place).collect();
            let distance = |other| legs.edge(place, other);
            let nearer = |a: &usize, b: &usize| {
                let order = distance(*a).total_cmp(&distance(*b));
                order.then(a.cmp(b))
            };
            if width < others.len() {
                others.select_nth_unstable_by(width, nearer);
                others.truncate(width);
            }
            others.sort_by(nearer);
            nearest[place * width..][..width].copy_from_slice(&others);
        }
        Self { width, nearest }
    }

    /// The nearest places.
    pub(super) fn of(&self, place: usize) -> &[usize] {
        &self.nearest[place * self.width..][..self.width]
    }
}
