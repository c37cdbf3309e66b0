//! Estimates of the coupling gaps of triples that the model has not been asked for.
//!
//! Two legs would each like to pass the target between them in a state of their own, and lose time
//! because they have to pass it in the same one. The gap of a triple is nearly proportional to the
//! time that the change from one of the two states to the other takes; the factor is that of a least
//! squares fit to the gaps that are known. An order that is short in the known gaps alone is drawn
//! to triples that nobody has asked for. The estimates are no bounds.

use crate::tour::order::{PairTable, Place};
use nalgebra::Vector3;

/// Factor while no gap is known, that of slews in a strip; weighs no more than a change of 30 ms.
const FIRST_FACTOR: f64 = 0.35;
const WEIGHT_OF_FIRST: f64 = 1e-3;

/// States of legs at their ends, see [`TourModel::free_ends`](crate::tour::order::TourModel::free_ends).
pub(crate) type FreeEnds<'a> = &'a dyn Fn(Place, Place) -> [[f64; 3]; 2];

/// Estimated gaps, for places numbered as in [`PairTable`].
#[derive(Debug)]
pub(in crate::tour::order) struct GapEstimates {
    places: usize,
    /// Scaled states at begin and end of every leg, by rows; no numbers where a tour has no such leg, so that it
    /// changes nothing.
    ends: Vec<[[f32; 3]; 2]>,
    /// Sums over the known gaps of gap times change and of squared changes, s².
    sums: [f64; 2],
}

impl GapEstimates {
    /// The estimates where no gap is known.
    pub(in crate::tour::order) fn new(table: &PairTable, free_ends: FreeEnds<'_>) -> Self {
        let places = table.targets() + 2;
        let mut estimates = Self {
            places,
            ends: vec![[[f32::NAN; 3]; 2]; places * places],
            sums: [FIRST_FACTOR * WEIGHT_OF_FIRST, WEIGHT_OF_FIRST],
        };
        for from in 0..places {
            for to in 0..places {
                estimates.update(table, [from, to], free_ends);
            }
        }
        estimates
    }

    /// Takes the ends of a leg, if a tour can have this leg.
    pub(super) fn update(&mut self, table: &PairTable, leg: [usize; 2], free_ends: FreeEnds<'_>) {
        if table.is_leg(leg) {
            let [from, to] = leg.map(|number| table.place(number));
            // Estimates need no more digits.
            let single = |state: [f64; 3]| Vector3::from(state).cast::<f32>().into();
            self.ends[leg[0] * self.places + leg[1]] = free_ends(from, to).map(single);
        }
    }

    /// Learns from a gap, s.
    pub(super) fn learn(&mut self, [from, via, to]: [usize; 3], gap: f64) {
        let change = self.change(from, via, to);
        self.sums[0] += gap * change;
        self.sums[1] += change * change;
    }

    /// The estimated gap of a triple, s.
    pub(in crate::tour::order) fn gap(&self, from: usize, via: usize, to: usize) -> f64 {
        (self.sums[0] / self.sums[1]).max(0.0) * self.change(from, via, to)
    }

    /// Time, s, of the change from the end of one leg to the begin of the next.
    fn change(&self, from: usize, via: usize, to: usize) -> f64 {
        let [_, arriving] = self.ends[from * self.places + via];
        let [leaving, _] = self.ends[via * self.places + to];
        let differences = arriving.iter().zip(leaving).map(|(a, b)| (a - b).abs());
        f64::from(differences.fold(0.0, f32::max))
    }
}
