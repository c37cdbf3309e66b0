//! Coupling gaps: by how much two legs in a row take longer than both on their own.
//!
//! A bound on the time of two legs together holds from the departure before the first to the arrival
//! after the second, whatever the windows: a visit between them that waits has the gap for free, as far
//! as it waits.

/// Known gaps, for places by their numbers; others count as none.
#[derive(Debug)]
pub(super) struct CouplingGaps {
    places: usize,
    /// Of every leg the gaps by the place after it, s; empty where none is known.
    after: Vec<Vec<f64>>,
    /// Of every leg the largest of these, s; empty where no gap is known at all.
    largest: Vec<f64>,
}

impl CouplingGaps {
    /// Gaps of triples of places.
    pub(super) fn new(places: usize, known: &[([usize; 3], f64)]) -> Self {
        let mut gaps = Self {
            places,
            after: Vec::new(),
            largest: Vec::new(),
        };
        if !known.is_empty() {
            gaps.after.resize(places * places, Vec::new());
            gaps.largest.resize(places * places, 0.0);
        }
        for &([from, via, to], gap) in known {
            let leg = from * places + via;
            gaps.after[leg].resize(places, 0.0);
            gaps.after[leg][to] = gap;
            gaps.largest[leg] = gaps.largest[leg].max(gap);
        }
        gaps
    }

    /// Time that two legs lose together, s.
    pub(super) fn of(&self, [from, via, to]: [usize; 3]) -> f64 {
        let leg = self.after.get(from * self.places + via);
        let gap = leg.and_then(|after| after.get(to));
        gap.copied().unwrap_or(0.0)
    }

    /// The most that a leg and any after it lose together, s.
    pub(super) fn largest(&self, from: usize, via: usize) -> f64 {
        let largest = self.largest.get(from * self.places + via);
        largest.copied().unwrap_or(0.0)
    }

    /// The gaps in reversed time, with other numbers of the places.
    pub(super) fn mirrored(&self, other: impl Fn(usize) -> usize) -> Self {
        let mut known = Vec::new();
        for (leg, after) in self.after.iter().enumerate() {
            let (from, via) = (leg / self.places, leg % self.places);
            let gaps = after.iter().enumerate().filter(|(_, gap)| **gap > 0.0);
            known.extend(gaps.map(|(to, gap)| ([other(to), other(via), other(from)], *gap)));
        }
        Self::new(self.places, &known)
    }
}
