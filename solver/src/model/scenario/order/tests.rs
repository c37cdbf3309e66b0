//! Positions and precedences that are invalid, alone or together.

use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::ScenarioSpec;

fn demand(spec: &mut ScenarioSpec, target: usize, position: Option<usize>, after: &[&str]) {
    spec.targets[target].position = position;
    spec.targets[target].after = after.iter().map(ToString::to_string).collect();
}

/// The problems of experiment A with rules, given as index, position and predecessors.
fn faults(demands: &[(usize, Option<usize>, &[&str])]) -> Vec<(String, String)> {
    let mut spec = experiment_a();
    for (target, position, after) in demands {
        demand(&mut spec, *target, *position, after);
    }
    let problems = Scenario::try_new(&spec).err().unwrap_or_default();
    assert!(problems.iter().all(|p| !p.hint.is_empty()));
    problems
        .into_iter()
        .map(|p| (p.pointer, format!("{}: {}", p.code, p.message)))
        .collect()
}

#[track_caller]
fn expect_fault(demands: &[(usize, Option<usize>, &[&str])], pointer: &str, words: &str) {
    let found = faults(demands);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, pointer);
    assert!(found[0].1.contains(words), "{found:?}");
}

#[test]
fn positions_and_precedences_become_rules_on_indices() {
    let mut spec = experiment_a();
    demand(&mut spec, 0, Some(3), &[]);
    demand(&mut spec, 4, None, &["a", "f"]);
    let scenario = Scenario::try_new(&spec).unwrap().scenario;
    let rules = scenario.order_rules();
    assert_eq!((rules.position(0), rules.position(1)), (Some(2), None));
    assert_eq!(rules.predecessors(4), [0, 5]);
    assert!(rules.admits(&[5, 1, 0, 2, 3, 4]) && !rules.admits(&[1, 2, 0, 4, 3, 5]));
    assert!(!rules.is_free());
    let free = Scenario::try_new(&experiment_a()).unwrap().scenario;
    assert!(free.order_rules().is_free());
    // The due date of the last place holds for all targets.
    for place in 1..=6 {
        let mut spec = experiment_a();
        demand(&mut spec, 2, Some(place), &[]);
        let scenario = Scenario::try_new(&spec).unwrap().scenario;
        assert!(!scenario.order_rules().is_free(), "place {place}");
    }
}

#[test]
fn each_position_is_within_the_targets_and_given_once() {
    for place in [0, 7, usize::MAX] {
        expect_fault(
            &[(2, Some(place), &[])],
            "/targets/2/position",
            "from 1 to 6",
        );
    }
    let twice = [(1, Some(6), &[][..]), (3, Some(6), &[])];
    expect_fault(&twice, "/targets/3/position", "position_taken: position 6");
}

#[test]
fn predecessors_are_other_targets_named_once() {
    let cases = [
        (["z"], "unknown_reference"),
        (["start"], "unknown_reference"),
        (["b"], "order_cycle"),
    ];
    for (names, code) in cases {
        expect_fault(&[(1, None, &names)], "/targets/1/after/0", code);
    }
    let twice = [(1, None, &["a", "c", "a"][..])];
    expect_fault(&twice, "/targets/1/after/2", "duplicate_id");
}

#[test]
fn every_circle_is_named_once() {
    let found = faults(&[
        (0, None, &["c"]),
        (1, None, &["a"]),
        (2, None, &["b", "d"]),
        (3, None, &["e"]),
        (4, None, &["d"]),
        (5, None, &["a", "d"]),
    ]);
    let pointers: Vec<&str> = found.iter().map(|(pointer, _)| &**pointer).collect();
    assert_eq!(pointers, ["/targets/0/after", "/targets/3/after"]);
    assert!(
        found[0].1.ends_with("\"a\", \"c\", \"b\", \"a\""),
        "{found:?}"
    );
    assert!(found[1].1.ends_with("\"d\", \"e\", \"d\""), "{found:?}");
}

#[test]
fn valid_rules_that_together_admit_no_order_are_refused() {
    // Two targets between two adjacent places.
    let between = [
        (0, Some(2), &[][..]),
        (1, None, &["a"]),
        (2, None, &["a"]),
        (3, Some(4), &["b", "c"]),
    ];
    expect_fault(
        &between,
        "/targets/2/after",
        "\"c\" has to be among the first 3",
    );
    // A place before that of a predecessor.
    let late = [(0, Some(1), &["b"][..])];
    expect_fault(&late, "/targets/1", "no place is left for \"b\" ahead");
    let late = [(0, Some(3), &["b"][..]), (1, Some(4), &[])];
    expect_fault(&late, "/targets/1/position", "among the first 2");
    // No target may be the first.
    let all: Vec<_> = (1..6).map(|target| (target, None, &["a"][..])).collect();
    let begun = [&[(0, Some(2), &[][..])], &*all].concat();
    expect_fault(&begun, "/targets", "at position 1");
}

#[test]
fn all_faults_are_found_at_once() {
    let found = faults(&[
        (0, Some(9), &["z", "a"]),
        (1, Some(2), &["b"]),
        (2, Some(2), &[]),
    ]);
    assert_eq!(found.len(), 5, "{found:?}");
}
