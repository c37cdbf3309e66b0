//! A resumed search with the segments of an interrupted one: the same plan for less work.

use slewplan_solver::model::plan::Outcome;
use slewplan_solver::model::problem::Code;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::legs::{SegmentStore, StoredSegment};
use slewplan_solver::tour::planner::{self, Run};
use slewplan_tests::schedules::{RateConditions, Region, schedule};
use slewplan_tests::solving::{on_threads, planned, scenario_of};
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

/// A store that keeps only the first segments, as after an interruption.
#[derive(Default)]
struct SegmentMemory {
    segments: Mutex<HashMap<String, StoredSegment>>,
    most: usize,
    /// How often a segment was found.
    found: AtomicUsize,
}

impl SegmentMemory {
    fn segments(&self) -> MutexGuard<'_, HashMap<String, StoredSegment>> {
        self.segments.lock().expect("not poisoned")
    }
}

impl SegmentStore for SegmentMemory {
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
    scenario_of(&schedule(Region::Strip, RateConditions::ZeroAboutZ, 8, 1))
}

/// The plan with all of its numbers, and how many programs of several legs it took.
fn solved(memory: &SegmentMemory) -> (String, u64) {
    let scenario = eight_targets();
    let mut plan = on_threads(2, |run| {
        let segments = memory;
        planned(planner::solve(&scenario, Run { segments, ..run }))
    });
    let statistics = std::mem::take(&mut plan.statistics);
    (format!("{plan:?}"), statistics.nlp_solves_by_kind.segments)
}

#[test]
fn stored_segments_are_not_solved_again_and_give_the_same_plan() {
    let all = SegmentMemory {
        most: usize::MAX,
        ..SegmentMemory::default()
    };
    let (cold, solves) = solved(&all);
    let count = all.segments().len();
    assert!(count > 20, "{count} segments in {solves} programs");
    assert_eq!(all.found.load(Ordering::Relaxed), 0);
    // With all segments, and then with the first half of them.
    let (again, few) = solved(&all);
    assert_eq!((again, few), (cold.clone(), 0));
    let half = SegmentMemory {
        most: count / 2,
        ..SegmentMemory::default()
    };
    assert_eq!(solved(&half).0, cold);
    let (resumed, fewer) = solved(&half);
    assert_eq!(resumed, cold);
    assert!(half.found.load(Ordering::Relaxed) >= count / 2);
    assert!(4 * fewer < 3 * solves, "{fewer} programs after {solves}");
}

/// A plan from changed segments fails its verification.
#[test]
fn changed_segments_end_in_a_reported_failure() {
    let memory = SegmentMemory {
        most: usize::MAX,
        ..SegmentMemory::default()
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
