//! Solved legs as plain data, and the store that remembers them between solves.
//!
//! A leg is a problem of its own when nothing outside it matters: spacecraft, the turn, the total
//! momentum in body axes at its beginning, and the conditions at both ends. Its *identity* is a
//! canonical text of exactly these, so that scenarios which share a spacecraft and relative
//! attitudes share legs, and a leg flown backwards is the same leg where that is valid. Legs are
//! always solved in the frame in which they begin at the identity attitude; a stored leg therefore
//! gives bit for bit what solving it again would give.
//!
//! Beside them, the segments of one scenario's tours, which mean nothing to others.

use crate::model::input::input_choice;
use crate::model::motion::Motion;
use crate::tour::order::Place;

input_choice! {
    /// Which boundary conditions a tabulated leg has.
    pub enum LegKind as "Kind" {
        /// All rates zero at both ends; with more than three wheels the null-space momentum of the
        /// scenario's start is held at both ends.
        RestToRest = "rest_to_rest",
        /// Each end with only its own conditions, everything else free: a lower bound of the leg.
        LowerBound = "lower_bound",
        /// All rates zero at both ends: no slew is solved, and the answer is a proved bound on its time.
        Certified = "certified",
    }
}

/// A solved leg.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredLeg {
    /// Canonical text of the spacecraft with the limits that a plan may use.
    pub spacecraft: String,
    /// The kind of table for which it was solved first.
    pub kind: LegKind,
    /// The turn from begin to end, scalar-last quaternion.
    pub turn_xyzw: [f64; 4],
    /// Total momentum in body axes at the beginning, N m s.
    pub body_momentum_nms: [f64; 3],
    /// Whether it can be flown backwards, and so is the leg from its end to its begin too.
    pub reversible: bool,
    /// Minimum time, s.
    pub duration_s: f64,
    /// No slew with the conditions at the two ends takes less, s, proved; `None` where nothing is.
    pub certified_lower_bound_s: Option<f64>,
    /// How the solve ended; only `converged` legs are stored.
    pub status: String,
    /// Wall-clock time of the solve with all its starts, s.
    pub solve_time_s: f64,
    /// The motion, with attitudes relative to the begin.
    pub motion: Motion,
}

/// The time of a stored leg.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredTime {
    /// What the store calls the leg: its identity, or a digest of it.
    pub key: String,
    /// Minimum time, s.
    pub duration_s: f64,
    /// No slew with the conditions at the two ends takes less, s, proved; `None` where nothing is.
    pub certified_lower_bound_s: Option<f64>,
    /// Whether this version of the bounds has tried to prove it.
    pub is_bound_current: bool,
    /// Wall-clock time of the solve with all its starts, s.
    pub solve_time_s: f64,
}

/// Remembers legs by their identity.
///
/// Called from the solver's workers; must not fail a solve: a store in trouble forgets.
pub trait LegStore: Sync {
    /// The leg of an identity, when it is known.
    fn get(&self, identity: &str) -> Option<StoredLeg>;

    /// The legs of a few identities, in their order.
    fn get_all(&self, identities: &[&str]) -> Vec<Option<StoredLeg>> {
        identities
            .iter()
            .map(|identity| self.get(identity))
            .collect()
    }

    /// Number of legs that are best looked up at once: more than one where each look-up has a price, such
    /// as the way to a server.
    fn batch(&self) -> usize {
        1
    }

    /// The times of the legs of many identities, in their order; `None` for legs that are not known.
    /// Their motions are not read.
    fn times(&self, identities: &[&str]) -> Vec<Option<StoredTime>> {
        let time = |identity: &&str| {
            let leg = self.get(identity)?;
            Some(StoredTime {
                key: (*identity).to_owned(),
                duration_s: leg.duration_s,
                certified_lower_bound_s: leg.certified_lower_bound_s,
                is_bound_current: leg.certified_lower_bound_s.is_some(),
                solve_time_s: leg.solve_time_s,
            })
        };
        identities.iter().map(time).collect()
    }

    /// Remembers a leg.
    fn put(&self, identity: &str, leg: &StoredLeg);

    /// Whether others may solve some of the legs of a large table, and store them here.
    fn is_shared(&self) -> bool {
        false
    }

    /// Offers legs of a kind to others, which are going to be solved here in this order. What others have
    /// solved is found when its turn comes, and what they have not is solved here.
    fn offer(&self, _kind: LegKind, _pairs: &[(Place, Place)]) {}
}

/// The flight through several places in a row, solved as one program.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredSegment {
    /// The motion.
    pub motion: Motion,
    /// Costates of the momenta at every place between two of its legs, s per N m s.
    pub costates_s_per_nms: Vec<Vec<f64>>,
}

/// Remembers the segments of the tours of one scenario, so that a search that begins again, because
/// its process was killed, does not solve again what it has solved already.
///
/// A segment is named by a text that has a meaning within its scenario only. Given back, it is bit
/// for bit what solving it again would give. Called from the solver's workers; must not fail a
/// solve: a store in trouble forgets.
pub trait SegmentStore: Sync {
    /// The segment of a name, when it is known.
    fn get(&self, name: &str) -> Option<StoredSegment>;

    /// Remembers a segment.
    fn put(&self, name: &str, segment: StoredSegment);
}

/// A store that remembers nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoStore;

impl SegmentStore for NoStore {
    fn get(&self, _: &str) -> Option<StoredSegment> {
        None
    }

    fn put(&self, _: &str, _: StoredSegment) {}
}

impl LegStore for NoStore {
    fn get(&self, _: &str) -> Option<StoredLeg> {
        None
    }

    fn put(&self, _: &str, _: &StoredLeg) {}
}
