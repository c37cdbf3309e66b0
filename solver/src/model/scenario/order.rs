//! The rules for the order of the targets.

use crate::model::findings::Findings;
use crate::model::order_rules::{DeadEnd, OrderRules};
use crate::model::problem::Code;
use crate::model::spec::{ScenarioSpec, TargetSpec};
use std::collections::{HashMap, HashSet};

/// Reads positions and precedences. Whether an order keeps them all is checked when each of them is
/// valid and every target is visited.
pub(super) fn read(spec: &ScenarioSpec, findings: &mut Findings) -> Option<OrderRules> {
    let positions = read_positions(&spec.targets, findings);
    let after = read_precedences(&spec.targets, findings)
        .filter(|after| cycles_are_absent(&spec.targets, after, findings));
    let rules = OrderRules::new(positions?, after?);
    // Where targets may be left out, a place in the order is one among those that a plan visits.
    let all_are_visited = spec.targets.iter().all(|target| target.value.is_none());
    let dead_end = rules.complete(&[]).err().filter(|_| all_are_visited);
    if let Some(dead_end) = dead_end {
        refuse_all(&spec.targets, dead_end, findings);
    }
    dead_end.is_none().then_some(rules)
}

/// Zero-based places.
fn read_positions(targets: &[TargetSpec], findings: &mut Findings) -> Option<Vec<Option<usize>>> {
    let count = targets.len();
    let mut holders: HashMap<usize, &str> = HashMap::new();
    let mut valid = true;
    let mut positions = Vec::with_capacity(count);
    for (i, target) in targets.iter().enumerate() {
        positions.push(target.position.and_then(|place| place.checked_sub(1)));
        let Some(place) = target.position else {
            continue;
        };
        let (code, message, hint) = if place == 0 || place > count {
            let message = format!("the position is {place}, it must be from 1 to {count}");
            let hint = "count the targets from 1, the start is none of them; or leave position out";
            (Code::OutOfRange, message, hint)
        } else if let Some(holder) = holders.insert(place, &target.id) {
            let message = format!("position {place} is already that of \"{holder}\"");
            let hint = "give every position to one target only";
            (Code::PositionTaken, message, hint)
        } else {
            continue;
        };
        valid = false;
        findings.refuse(format!("/targets/{i}/position"), code, message, hint);
    }
    valid.then_some(positions)
}

/// Indices of the targets that come before each.
fn read_precedences(targets: &[TargetSpec], findings: &mut Findings) -> Option<Vec<Vec<usize>>> {
    let mut indices: HashMap<&str, usize> = HashMap::new();
    for (i, target) in targets.iter().enumerate() {
        indices.entry(&target.id).or_insert(i);
    }
    let mut valid = true;
    let mut after = Vec::with_capacity(targets.len());
    for (i, target) in targets.iter().enumerate() {
        let mut listed = HashSet::new();
        let mut predecessors = Vec::new();
        for (entry, id) in target.after.iter().enumerate() {
            let found = indices.get(id.as_str()).copied();
            let (code, message, hint) = match found {
                None => (
                    Code::UnknownReference,
                    format!("no target is called \"{id}\""),
                    "name targets by their id; every target comes after the start anyway",
                ),
                Some(index) if index == i => (
                    Code::OrderCycle,
                    format!("\"{id}\" would have to come after itself"),
                    "leave a target's own id out of its list",
                ),
                Some(index) if !listed.insert(index) => (
                    Code::DuplicateId,
                    format!("\"{id}\" is in the list already"),
                    "name each target once",
                ),
                Some(index) => {
                    predecessors.push(index);
                    continue;
                }
            };
            valid = false;
            findings.refuse(format!("/targets/{i}/after/{entry}"), code, message, hint);
        }
        after.push(predecessors);
    }
    valid.then_some(after)
}

/// Refuses targets that come after each other in a circle, one circle at a time.
fn cycles_are_absent(
    targets: &[TargetSpec],
    after: &[Vec<usize>],
    findings: &mut Findings,
) -> bool {
    let cycles = cycles(after);
    for cycle in &cycles {
        let names: Vec<String> = cycle
            .iter()
            .chain(cycle.first())
            .map(|&index| format!("\"{}\"", targets[index].id))
            .collect();
        findings.refuse(
            format!("/targets/{}/after", cycle[0]),
            Code::OrderCycle,
            format!("each of these comes after the next: {}", names.join(", ")),
            "drop one of the entries of after in this circle",
        );
    }
    cycles.is_empty()
}

/// Cycles without a common target, at least one in every strongly connected set of targets.
fn cycles(after: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let waits = waiting(after);
    // Every blocked target has a blocked predecessor, so following predecessors ends in a cycle.
    let next = |target: usize| after[target].iter().copied().find(|&before| waits[before]);
    let mut passed = vec![None; after.len()];
    let mut cycles = Vec::new();
    for root in (0..after.len()).filter(|&target| waits[target]) {
        let mut path = Vec::new();
        let mut at = Some(root);
        while let Some(target) = at.filter(|&target| passed[target].is_none()) {
            passed[target] = Some(root);
            path.push(target);
            at = next(target);
        }
        let begin = path.iter().position(|&target| Some(target) == at);
        if let Some(begin) = begin {
            cycles.push(path.split_off(begin));
        }
    }
    cycles
}

/// Whether each target is blocked: on a cycle, or after a target on one.
fn waiting(after: &[Vec<usize>]) -> Vec<bool> {
    let mut successors = vec![Vec::new(); after.len()];
    for (target, predecessors) in after.iter().enumerate() {
        for &before in predecessors {
            successors[before].push(target);
        }
    }
    let mut awaited: Vec<usize> = after.iter().map(Vec::len).collect();
    let mut ready: Vec<usize> = (0..after.len()).filter(|&t| awaited[t] == 0).collect();
    while let Some(target) = ready.pop() {
        for &successor in &successors[target] {
            awaited[successor] -= 1;
            if awaited[successor] == 0 {
                ready.push(successor);
            }
        }
    }
    awaited.into_iter().map(|count| count > 0).collect()
}

/// Refuses rules that are valid one by one and admit no order together.
fn refuse_all(targets: &[TargetSpec], dead_end: DeadEnd, findings: &mut Findings) {
    let (pointer, message) = match dead_end {
        DeadEnd::Overdue { target, due } => {
            let field = match &targets[target] {
                spec if spec.position.is_some() => "/position",
                spec if !spec.after.is_empty() => "/after",
                _ => "",
            };
            let id = &targets[target].id;
            let message = match due {
                0 => format!("no place is left for \"{id}\" ahead of those that come after it"),
                _ => format!(
                    "\"{id}\" has to be among the first {due}, where there is no room for it"
                ),
            };
            (format!("/targets/{target}{field}"), message)
        }
        DeadEnd::Empty(place) => {
            let message = format!("nothing can be visited at position {}", place + 1);
            ("/targets".to_owned(), message)
        }
    };
    findings.refuse(
        pointer,
        Code::OrderInfeasible,
        format!("no order keeps all positions and precedences: {message}"),
        "drop or change a position or an entry of after",
    );
}

#[cfg(test)]
mod tests;
