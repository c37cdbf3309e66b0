//! Import of legs from a file into the cache, after a check of every leg.
//!
//! A table with trajectories contains its scenario, which determines the problems of its legs and
//! the keys under which they are cached. The checker integrates every motion, and lower bounds are
//! proved again. Only the optimality of the motions is taken on trust.

use crate::base::clock::now_us;
use crate::documents;
use crate::documents::document::Node;
use crate::documents::legs::{KeyedLeg, LegTable};
use crate::store::{NewLeg, Store, StoreError, leg_key};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, LegCheck};
use std::collections::{HashMap, HashSet};

/// Legs per transaction; small enough that other writers do not wait long.
const BATCH: usize = 256;
const WITH_TRAJECTORIES: &str = "make the file with slewplan legs --trajectories";

/// A file of legs that was read without problems.
#[derive(Debug)]
pub(crate) struct Import {
    /// The scenario of the legs.
    pub(crate) scenario: Scenario,
    kind: LegKind,
    motions: Vec<KeyedLeg>,
}

/// The result of checking the legs of a file.
#[derive(Debug)]
pub(crate) struct CheckedLegs {
    legs: Vec<NewLeg>,
    /// Why some of them are refused.
    pub(crate) refused: Vec<Problem>,
}

/// Reads a file of legs.
///
/// # Errors
///
/// All reasons why it cannot be imported.
pub(crate) fn read(node: &Node) -> Result<Import, Vec<Problem>> {
    let table = documents::legs::read::read(node)?;
    let mut problems = unsuitable(&table);
    let scenario = table.scenario.and_then(|scenario| {
        let read = documents::scenario::read_node(&scenario, None).and_then(|valid| {
            let obstacles = planner::feasibility_problems(&valid.scenario);
            if obstacles.is_empty() {
                Ok(valid.scenario)
            } else {
                Err(obstacles)
            }
        });
        read.map_err(|found| problems.extend(Problem::all_under("/scenario", found)))
            .ok()
    });
    match (scenario, table.motions) {
        (Some(scenario), Some(motions)) if problems.is_empty() => Ok(Import {
            scenario,
            kind: table.kind,
            motions,
        }),
        _ => Err(problems),
    }
}

/// The reasons why a table cannot be imported.
fn unsuitable(table: &LegTable) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut refuse = |pointer: &str, code, message: String, hint: &str| {
        problems.push(Problem::new(pointer, code, message, hint));
    };
    let version = env!("CARGO_PKG_VERSION");
    if table.version != version {
        let message = format!("version {:?} solved it, this is {version:?}", table.version);
        let hint = "solve the legs with this version; legs of other versions are not used";
        refuse("/version", Code::VersionMismatch, message, hint);
    }
    if table.kind == LegKind::Certified {
        let message = "a table of bounds has no legs to import".to_owned();
        let hint = "take a table of the kind rest_to_rest or lower_bound";
        refuse("/kind", Code::UnknownChoice, message, hint);
    }
    for (pointer, there) in [
        ("/scenario", table.scenario.is_some()),
        ("/trajectories", table.motions.is_some()),
    ] {
        if !there {
            let message = format!("the table has no {}", &pointer[1..]);
            refuse(pointer, Code::MissingField, message, WITH_TRAJECTORIES);
        }
    }
    let mut seen = HashSet::new();
    for (index, motion) in table.motions.iter().flatten().enumerate() {
        if !seen.insert(&motion.key) {
            let pointer = format!("/trajectories/{index}/key");
            let message = "a leg before this one has the same key".to_owned();
            refuse(
                &pointer,
                Code::DuplicateId,
                message,
                "keep the one that is meant",
            );
        }
    }
    problems
}

impl Import {
    /// Checks every leg; `None` when stopped.
    pub(crate) fn check(self, pool: &SolverPool, stop: &StopSignal) -> Option<CheckedLegs> {
        let keys: HashSet<&str> = self.motions.iter().map(|motion| &*motion.key).collect();
        let wanted = |identity: &str| keys.contains(&*leg_key(identity));
        let check = LegCheck::new(&self.scenario, self.kind, &wanted, (pool, stop))?;
        let identities: HashMap<String, &str> = check
            .identities()
            .map(|identity| (leg_key(identity), identity))
            .collect();
        let numbered: Vec<_> = self.motions.iter().enumerate().collect();
        let found = pool.map(&numbered, |(index, motion)| {
            (!stop.is_set()).then(|| check_leg(&check, &identities, *index, motion))
        });
        let (mut legs, mut refused) = (Vec::new(), Vec::new());
        for leg in found {
            match leg? {
                Ok(leg) => legs.push(leg),
                Err(problem) => refused.push(problem),
            }
        }
        Some(CheckedLegs { legs, refused })
    }
}

fn check_leg(
    check: &LegCheck<'_>,
    identities: &HashMap<String, &str>,
    index: usize,
    given: &KeyedLeg,
) -> Result<NewLeg, Problem> {
    let place = format!("/trajectories/{index}");
    let Some(identity) = identities.get(&given.key) else {
        return Err(Problem::new(
            format!("{place}/key"),
            Code::UnknownReference,
            "the scenario of the file has no leg with this key under the kind of the table",
            "take the file as slewplan legs wrote it",
        ));
    };
    match check.check(identity, given.motion.clone(), given.solve_time_s) {
        Ok(leg) => Ok(NewLeg {
            identity: (*identity).to_owned(),
            leg,
        }),
        Err(faults) => Err(Problem::new(
            place,
            Code::LegRefused,
            faults.join("; "),
            "solve the legs again with slewplan legs",
        )),
    }
}

impl CheckedLegs {
    /// Stores the legs that passed. Returns how many of them are new, and how many were there
    /// before and stay unchanged.
    ///
    /// # Errors
    ///
    /// When the database fails; some of the legs may be stored then.
    pub(crate) async fn store(&self, store: &Store) -> Result<[u64; 2], StoreError> {
        let mut imported = 0;
        for batch in self.legs.chunks(BATCH) {
            imported += store.put_legs(batch, now_us()).await?;
        }
        Ok([imported, self.legs.len() as u64 - imported])
    }
}
