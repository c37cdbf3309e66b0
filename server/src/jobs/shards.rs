//! Large tables of legs are offered in parts to workers that have nothing else to do.
//!
//! The parts are jobs behind all others. Who offers them goes on with the table from its begin; others take
//! the parts from its end. What they solve is stored as every leg is, and found when its turn comes; what
//! nobody has solved until then is solved here. So nothing is lost or waited for, whoever is killed, and at
//! worst the legs of a part are solved twice.

use super::Jobs;
use super::leg_table;
use super::solve::JobContext;
use crate::base::clock::now_us;
use crate::documents;
use crate::store::{JobRow, NewShard, Notice, ShardedJob};
use serde::{Deserialize, Serialize};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::order::Place;
use slewplan_solver::tour::planner::LegTimeTable;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use uuid::Uuid;

/// Number of legs of a part: some ten times what it takes to queue and claim it where legs are quick, and
/// seconds where they are not.
const PART: usize = 64;
/// Fewer missing legs are solved before somebody has taken a part of them.
const LEAST: usize = 4 * PART;
/// Maximum number of parts of a table; what is before them is left to the job itself.
const MAX_PARTS: usize = 1024;

/// A part of a table, as it is stored.
#[derive(Debug, Serialize, Deserialize)]
struct ShardDocument {
    kind: String,
    pairs: Vec<(ShardPlace, ShardPlace)>,
}

/// A place of the scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ShardPlace {
    Start,
    Target(usize),
    End,
}

impl From<Place> for ShardPlace {
    fn from(place: Place) -> Self {
        match place {
            Place::Start => Self::Start,
            Place::Target(target) => Self::Target(target),
            Place::End => Self::End,
        }
    }
}

impl ShardPlace {
    /// The place, if the scenario has it.
    fn of(self, scenario: &Scenario) -> Option<Place> {
        match self {
            Self::Start => Some(Place::Start),
            Self::Target(target) => {
                (target < scenario.targets().len()).then_some(Place::Target(target))
            }
            Self::End => scenario.end().map(|_| Place::End),
        }
    }
}

/// Offers parts of the tables of a leased job.
#[derive(Debug, Clone)]
pub(super) struct ShardOffer(Arc<SharedOffer>);

#[derive(Debug)]
struct SharedOffer {
    jobs: Jobs,
    lease: JobRow,
    has_offered: AtomicBool,
}

impl ShardOffer {
    /// Offers parts for a lease.
    pub(super) fn new(jobs: Jobs, lease: JobRow) -> Self {
        Self(Arc::new(SharedOffer {
            jobs,
            lease,
            has_offered: AtomicBool::new(false),
        }))
    }

    /// Whether parts may be left in the queue.
    pub(super) fn has_offered(&self) -> bool {
        self.0.has_offered.load(Ordering::Relaxed)
    }

    /// Offers legs that are missing in a table, the last ones first, in place of all that was offered before.
    pub(super) async fn offer(&self, kind: LegKind, pairs: &[(Place, Place)]) {
        let shards: Vec<NewShard> = parts(pairs).map(|part| new_shard(kind, part)).collect();
        if shards.is_empty() && !self.has_offered() {
            return;
        }
        self.0.has_offered.store(true, Ordering::Relaxed);
        let store = self.0.jobs.store();
        match store.put_shards(&self.0.lease, &shards, now_us()).await {
            Ok(()) if shards.is_empty() => {}
            Ok(()) => store.tell(Notice::Queued),
            // Not an error of the job, which goes on alone.
            Err(error) => tracing::warn!(%error, "parts of a table of legs cannot be offered"),
        }
    }
}

/// The parts of a table in the order in which they are offered.
fn parts<P>(pairs: &[P]) -> impl Iterator<Item = &[P]> {
    let offered = if pairs.len() < LEAST { 0 } else { MAX_PARTS };
    pairs.rchunks(PART).take(offered)
}

fn new_shard(kind: LegKind, pairs: &[(Place, Place)]) -> NewShard {
    let places = pairs
        .iter()
        .map(|(from, to)| ((*from).into(), (*to).into()));
    let document = ShardDocument {
        kind: <&str>::from(kind).to_owned(),
        pairs: places.collect(),
    };
    NewShard {
        id: Uuid::now_v7().to_string(),
        document: serde_json::to_vec(&document).expect("places are plain data"),
        legs: i64::try_from(pairs.len()).unwrap_or(i64::MAX),
    }
}

/// A part of a table, as it is solved.
struct Shard {
    scenario: Scenario,
    kind: LegKind,
    pairs: Vec<(Place, Place)>,
}

/// The part of the table of a job that a stored document describes; `None` where this version cannot read
/// them.
fn read(document: &[u8], job: &ShardedJob) -> Option<Shard> {
    let shard: ShardDocument = serde_json::from_slice(document).ok()?;
    let scenario = if job.is_table() {
        leg_table::read(&job.scenario).ok()?.scenario
    } else {
        documents::scenario::read(&job.scenario, None)
            .ok()?
            .scenario
    };
    let pairs = shard.pairs.iter();
    let pairs = pairs.map(|(from, to)| Some((from.of(&scenario)?, to.of(&scenario)?)));
    Some(Shard {
        kind: shard.kind.parse().ok()?,
        pairs: pairs.collect::<Option<_>>()?,
        scenario,
    })
}

/// Solves the legs of a part, which the leg cache stores.
pub(super) fn solve(document: &[u8], job: &ShardedJob, context: &JobContext<'_>) {
    let Some(shard) = read(document, job) else {
        tracing::warn!("a part of a table of another version is left to its job");
        return;
    };
    // The legs are in the cache: nobody asks for their times here.
    let _ =
        LegTimeTable::of(&shard.scenario, shard.kind, context.run_of_legs()).solved(&shard.pairs);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_legs_of_a_large_table_are_offered_first() {
        let few = [0; LEAST - 1];
        assert_eq!(parts(&few).count(), 0);
        let many: Vec<usize> = (0..=LEAST).collect();
        let parts: Vec<_> = parts(&many).collect();
        assert_eq!(parts[0], &many[LEAST + 1 - PART..]);
        assert_eq!(parts[LEAST / PART], [0]);
    }

    #[test]
    fn places_are_those_of_the_scenario() {
        let text = include_bytes!("../../../tests/fixtures/two-targets.json");
        let scenario = documents::scenario::read(text, None).expect("valid");
        let scenario = scenario.scenario;
        for place in [Place::Start, Place::Target(0), Place::Target(1)] {
            let written = serde_json::to_string(&ShardPlace::from(place)).expect("JSON");
            let read: ShardPlace = serde_json::from_str(&written).expect("a place");
            assert_eq!(read.of(&scenario), Some(place));
        }
        assert_eq!(ShardPlace::Target(2).of(&scenario), None);
        assert_eq!(
            ShardPlace::End.of(&scenario).is_some(),
            scenario.end().is_some()
        );
    }
}
