//! Tables of legs between places.

use super::places::Places;
use crate::leg::multiphase::LegSolution;
use crate::leg::profile::Profile;
use crate::model::attitude::Attitude;
use crate::model::dynamics::Dynamics;
use crate::tour::order::Place;
use nalgebra::Vector3;
use std::sync::Arc;

/// A solved leg in its canonical form.
#[derive(Debug, Clone)]
pub(super) struct SolvedLeg {
    /// The motion, from the identity attitude, and how it ended.
    pub(super) solution: LegSolution,
    /// Certified lower bound on any slew with its conditions, s.
    pub(super) certified: Option<f64>,
    /// Number of NLPs solved for it.
    pub(super) solves: u64,
    /// Wall-clock time of all starts, s.
    pub(super) solve_time: f64,
    /// Whether it was taken from the store.
    pub(super) from_store: bool,
    /// Whether only the ends of the motion are kept.
    pub(super) is_condensed: bool,
    /// The attitudes that describe its ends; `None` where the roll is given and the motion itself begins
    /// or ends there.
    pub(super) described_from: [Option<Attitude>; 2],
}

impl SolvedLeg {
    /// The same with a motion of one interval from the first node to the last: its duration and the
    /// states at its ends in a quarter of the memory.
    pub(super) fn condensed(&self) -> Self {
        let solution = &self.solution;
        let motion = &solution.profile;
        let ends = [0, motion.intervals()];
        let profile = if motion.intervals() > 1 {
            Profile {
                attitudes: ends.map(|node| motion.attitudes[node]).to_vec(),
                wheels: ends.map(|node| motion.wheels[node].clone()).to_vec(),
                lengths: vec![motion.duration()],
            }
        } else {
            motion.clone()
        };
        Self {
            solution: LegSolution {
                profile,
                ..solution.clone()
            },
            is_condensed: true,
            ..*self
        }
    }
}

/// The certified bound of a leg.
#[derive(Debug, Clone, Copy)]
pub(super) struct CertifiedLeg {
    /// Lower bound on any slew with its conditions, s; `None` where nothing is proved.
    pub(super) lower_bound: Option<f64>,
    /// Wall-clock time of its computation, s.
    pub(super) solve_time: f64,
}

/// A solved leg between two places.
#[derive(Debug, Clone)]
pub(super) struct TabulatedLeg {
    /// The solution that all legs of the same canonical form share.
    pub(super) leg: Arc<SolvedLeg>,
    /// Whether this leg is that solution backwards in time.
    pub(super) mirrored: bool,
}

impl TabulatedLeg {
    /// The solution with a motion that begins at the given attitude or, where its roll is free, at an
    /// admissible one beside it.
    pub(super) fn beginning_at(&self, begin: &Attitude) -> LegSolution {
        let here = self.leg.described_from[usize::from(self.mirrored)].as_ref();
        LegSolution {
            costates: Vec::new(),
            ..self.leg.solution.placed(self.mirrored, here, begin)
        }
    }

    /// The same; `None` where only the ends of the motion are kept.
    pub(super) fn whole_beginning_at(&self, begin: &Attitude) -> Option<LegSolution> {
        (!self.leg.is_condensed).then(|| self.beginning_at(begin))
    }

    /// Body rates at begin and end, rad/s, of the motion from the given attitude; `None` where there is
    /// no motion.
    pub(super) fn rates_at_ends(
        &self,
        dynamics: &Dynamics,
        begin: &Attitude,
    ) -> Option<[Vector3<f64>; 2]> {
        let solution = self.beginning_at(begin);
        solution.duration()?;
        let motion = solution.profile;
        let rate = |node| dynamics.rate(&motion.attitudes[node], &motion.wheels[node]);
        Some([0, motion.intervals()].map(rate))
    }
}

/// Entries for ordered pairs of places, for legs of one kind.
///
/// Only what is known takes memory: of many targets, a few legs out of each.
pub(super) struct Table<T> {
    places: usize,
    /// For every place the entries of the legs out of it, sorted by the place they lead to.
    rows: Vec<Vec<(u32, T)>>,
}

/// Solved legs.
pub(super) type SolvedTable = Table<TabulatedLeg>;
/// Certified legs.
pub(super) type CertifiedTable = Table<CertifiedLeg>;

impl SolvedTable {
    /// Minimum time of the leg between two places, s, where it is solved.
    pub(super) fn duration(&self, from: Place, to: Place) -> Option<f64> {
        self.get(from, to)
            .and_then(|leg| leg.leg.solution.least_duration())
    }
}

impl CertifiedTable {
    /// Lower bound on any slew between two places, s; `None` where nothing is proved.
    pub(super) fn bound(&self, from: Place, to: Place) -> Option<f64> {
        self.get(from, to).and_then(|leg| leg.lower_bound)
    }

    /// Whether any leg has a proved bound.
    pub(super) fn has_bounds(&self) -> bool {
        let mut known = self.rows.iter().flatten();
        known.any(|(_, leg)| leg.lower_bound.is_some())
    }
}

impl<T> Table<T> {
    /// A table with the given entries; all others are empty.
    pub(super) fn new(
        places: &Places<'_>,
        entries: impl Iterator<Item = ((Place, Place), Option<T>)>,
    ) -> Self {
        let count = 2 + places.scenario.targets().len();
        let mut table = Self {
            places: count,
            rows: std::iter::repeat_with(Vec::new).take(count).collect(),
        };
        for (leg, entry) in entries {
            table.set(leg, entry);
        }
        table
    }

    /// Sets the entry of the leg between two places.
    pub(super) fn set(&mut self, (from, to): (Place, Place), entry: Option<T>) {
        let to = number(to, self.places);
        let row = &mut self.rows[from.number(self.places)];
        match (row.binary_search_by_key(&to, |entry| entry.0), entry) {
            (Ok(at), Some(entry)) => row[at].1 = entry,
            (Ok(at), None) => _ = row.remove(at),
            (Err(at), Some(entry)) => row.insert(at, (to, entry)),
            (Err(_), None) => {}
        }
    }

    /// The entry of the leg between two places, when there is one.
    pub(super) fn get(&self, from: Place, to: Place) -> Option<&T> {
        let row = &self.rows[from.number(self.places)];
        let to = number(to, self.places);
        let at = row.binary_search_by_key(&to, |entry| entry.0).ok()?;
        Some(&row[at].1)
    }
}

/// The number of a place in the width of an entry.
fn number(place: Place, places: usize) -> u32 {
    u32::try_from(place.number(places)).expect("fewer places than 2^32")
}
