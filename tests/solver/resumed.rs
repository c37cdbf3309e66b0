//! A search that begins again with what another one had solved: the same plan for less work.

use slewplan_solver::model::plan::Outcome;
use slewplan_solver::model::problem::Code;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::legs::{SegmentStore, StoredSegment};
use slewplan_solver::tour::planner::{self, Run};
use slewplan_tests::schedules::{Rates, Region, schedule};
use slewplan_tests::solving::{on_threads, planned, scenario_of};
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

/// Keeps the first segments, as a process does that is killed.
#[derive(Default)]
struct Memory {
    segments: Mutex<HashMap<String, StoredSegment>>,
    most: usize,
    /// How often a segment was found.
    found: AtomicUsize,
}

impl Memory {
    fn segments(&self) -> MutexGuard<'_, HashMap<String, StoredSegment>> {
        self.segments.lock().expect("nobody panics")
    }
}

impl SegmentStore for Memory {
    fn get(&self, name: &str) -> Option<StoredSegment> {
        let found = self.segments().get(name).cloned()?;
        self.found.fetch_add(1, Ordering::Relaxed);
        Some(found)
    }

    fn put(&self, name: &str, segment: StoredSegment) {
        let mut segments = self.segments();
        if segments.len() < self.most {
            segments.insert(name.to_owned(), segment);
        }
    }
}

fn eight_targets() -> Scenario {
    scenario_of(&schedule(Region::Strip, Rates::ZeroAboutZ, 8, 1))
}

/// The plan with all of its numbers, and how many programs of several legs it took.
fn solved(memory: &Memory) -> (String, u64) {
    let scenario = eight_targets();
    let mut plan = on_threads(2, |run| {
        let segments = memory;
        planned(planner::solve(&scenario, Run { segments, ..run }))
    });
    let statistics = std::mem::take(&mut plan.statistics);
    (format!("{plan:?}"), statistics.nlp_solves_by_kind.segments)
}

#[test]
fn what_was_solved_is_not_solved_again_and_the_plan_is_the_same() {
    let all = Memory {
        most: usize::MAX,
        ..Memory::default()
    };
    let (cold, solves) = solved(&all);
    let count = all.segments().len();
    assert!(count > 20, "{count} segments in {solves} programs");
    assert_eq!(all.found.load(Ordering::Relaxed), 0);
    // Everything, and then what there was in the middle of the search.
    let (again, few) = solved(&all);
    assert_eq!((again, few), (cold.clone(), 0));
    let half = Memory {
        most: count / 2,
        ..Memory::default()
    };
    assert_eq!(solved(&half).0, cold);
    let (resumed, fewer) = solved(&half);
    assert_eq!(resumed, cold);
    assert!(half.found.load(Ordering::Relaxed) >= count / 2);
    assert!(4 * fewer < 3 * solves, "{fewer} programs after {solves}");
}

/// Whatever a store gives back, no plan leaves that does not fly.
#[test]
fn what_comes_back_changed_ends_in_a_failure_with_a_name() {
    let memory = Memory {
        most: usize::MAX,
        ..Memory::default()
    };
    solved(&memory);
    for segment in memory.segments().values_mut() {
        for length in &mut segment.motion.lengths_s {
            *length *= 0.9;
        }
    }
    let scenario = eight_targets();
    let outcome = on_threads(2, |run| {
        let segments = &memory;
        planner::solve(&scenario, Run { segments, ..run })
    });
    let Outcome::Failed(problems) = outcome else {
        panic!("{outcome:?}");
    };
    assert_eq!(problems[0].code, Code::VerificationFailed, "{problems:?}");
    assert!(problems[0].message.contains("is missed by"), "{problems:?}");
}
