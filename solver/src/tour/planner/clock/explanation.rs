//! Why the required targets of a scenario cannot all be visited in time.

use crate::model::problem::{Code, Problem, quoted};
use crate::tour::order::Place;
use crate::tour::planner::places::Places;
use crate::tour::schedule::{Reach, SearchLimits, TimedProblem, TravelTimes, reaches, search};

/// Labels of a search for a schedule of a group of targets.
const LABELS: u64 = 100_000;
/// Greatest number of required targets among which conflicting groups are looked for.
const MAX_SEARCHED: usize = 40;
const HINT: &str = "give one of these targets a value, so that it may be left out, or widen its windows or \
                    latest_end_s";

/// Targets that cannot be reached in their windows at all; or else a smallest group of targets that
/// cannot be visited together, as far as it is found by leaving out one after the other.
pub(super) fn conflict(
    places: &Places<'_>,
    problem: &TimedProblem,
    times: &impl TravelTimes,
) -> Vec<Problem> {
    let required: Vec<usize> = (0..problem.targets.len())
        .filter(|i| problem.targets[*i].value.is_none())
        .collect();
    let reach = reaches(problem, times);
    let lonely: Vec<Problem> = required
        .iter()
        .filter(|i| reach[**i] != Reach::InTime)
        .map(|i| unreachable(places, *i, reach[*i]))
        .collect();
    if !lonely.is_empty() {
        return lonely;
    }
    let mut group = required;
    if group.len() <= MAX_SEARCHED {
        for target in group.clone() {
            let without: Vec<usize> = group.iter().copied().filter(|i| *i != target).collect();
            if excludes(problem, &without, times) {
                group = without;
            }
        }
    }
    vec![conflicting(places, &group)]
}

/// Whether it is proved that no schedule visits a group of targets.
fn excludes(problem: &TimedProblem, group: &[usize], times: &impl TravelTimes) -> bool {
    let mut relaxed = problem.clone();
    for (i, target) in relaxed.targets.iter_mut().enumerate() {
        target.value = (!group.contains(&i)).then_some(1.0);
    }
    let limits = SearchLimits {
        labels: Some(LABELS),
        ..SearchLimits::default()
    };
    let found = search(&relaxed, times, limits, &|| false, &mut |_| ());
    found.complete && found.best.is_none()
}

fn unreachable(places: &Places<'_>, target: usize, reach: Reach) -> Problem {
    let name = places.name(Place::Target(target));
    let (pointer, message) = match reach {
        Reach::TooLate => (
            "/latest_end_s".to_owned(),
            format!("no schedule that visits \"{name}\" ends before the latest end"),
        ),
        _ => (
            format!("/targets/{target}/windows"),
            format!(
                "\"{name}\" can be reached in none of its windows, not even as the first target"
            ),
        ),
    };
    Problem::new(pointer, Code::WindowUnreachable, message, HINT)
}

fn conflicting(places: &Places<'_>, group: &[usize]) -> Problem {
    let names: Vec<String> = group
        .iter()
        .map(|i| places.name(Place::Target(*i)))
        .collect();
    let listed = quoted(names.iter().map(String::as_str));
    let message = match group {
        [] => "not even a schedule without targets ends before the latest end".to_owned(),
        [_] => format!("no schedule visits {listed} in time together with the end and the rules"),
        _ => format!(
            "each of these targets has to be visited, and no order visits all in time: {listed}"
        ),
    };
    let pointer = group
        .first()
        .map_or("/latest_end_s".to_owned(), |i| format!("/targets/{i}"));
    Problem::new(pointer, Code::WindowsConflict, message, HINT)
}
