//! Certified bounds of the legs between places, proved where somebody asks for them.

use super::additive_tours::LegTimes;
use super::places::Places;
use super::tables::{CertifiedLeg, CertifiedTable, Table};
use crate::tour::order::Place;
use std::sync::{PoisonError, RwLock, RwLockReadGuard};

/// Computes the bounds of legs; `None` for those not reached before the stop signal.
pub(super) type Prove<'a> = Box<dyn Fn(&[(Place, Place)]) -> Vec<Option<CertifiedLeg>> + Sync + 'a>;

/// Certified bounds of legs, each end with its own conditions only.
///
/// A leg whose bound has not been asked for counts with the time of its turn at the largest rate.
pub(super) struct ProvedLegs<'a> {
    places: &'a Places<'a>,
    prove: Prove<'a>,
    table: RwLock<CertifiedTable>,
}

impl<'a> ProvedLegs<'a> {
    /// No leg is proved yet.
    pub(super) fn new(places: &'a Places<'a>, prove: Prove<'a>) -> Self {
        Self {
            places,
            prove,
            table: RwLock::new(Table::new(places, std::iter::empty())),
        }
    }

    /// Sets the bounds of legs of which more is known now.
    pub(super) fn replace(&self, legs: &[(Place, Place)], bounds: Vec<Option<CertifiedLeg>>) {
        let mut table = self.table.write().unwrap_or_else(PoisonError::into_inner);
        for (leg, bound) in legs.iter().zip(bounds) {
            if bound.is_some() {
                table.set(*leg, bound);
            }
        }
    }

    /// Lower bound on any leg between two places, s; `None` where nothing is proved so far.
    pub(super) fn bound(&self, from: Place, to: Place) -> Option<f64> {
        self.table().bound(from, to)
    }

    /// Whether any leg has a proved bound.
    pub(super) fn has_bounds(&self) -> bool {
        self.table().has_bounds()
    }

    fn table(&self) -> RwLockReadGuard<'_, CertifiedTable> {
        // A panic under the lock leaves the table consistent.
        self.table.read().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LegTimes for ProvedLegs<'_> {
    fn leg_s(&self, from: Place, to: Place) -> f64 {
        let known = self.table().get(from, to).copied();
        known.map_or_else(
            || {
                let angle = self.places.least_angle([from, to]);
                self.places.certified.at_largest_rate(angle)
            },
            |leg| leg.lower_bound.unwrap_or(0.0),
        )
    }

    fn is_open(&self, from: Place, to: Place) -> bool {
        self.table().get(from, to).is_none()
    }

    fn raise(&self, legs: &[(Place, Place)]) {
        let open = legs.iter().filter(|(from, to)| self.is_open(*from, *to));
        let open: Vec<_> = open.copied().collect();
        let proved = (self.prove)(&open);
        let mut table = self.table.write().unwrap_or_else(PoisonError::into_inner);
        for (leg, bound) in open.into_iter().zip(proved) {
            table.set(leg, bound);
        }
    }
}

#[cfg(test)]
mod tests;
