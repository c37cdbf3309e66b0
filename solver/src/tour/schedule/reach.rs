//! Which targets and legs a schedule can have at all.

use super::instance::Instance;
use super::worth::Worth;
use super::{TimedProblem, TravelTimes};
use crate::tour::order::Place;

/// Whether some schedule may visit a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// It can be reached in a window, and the schedule can end in time after it.
    InTime,
    /// It can be reached in none of its windows.
    OutsideWindows,
    /// It can be reached in a window, but then the schedule ends too late.
    TooLate,
}

/// Which targets can be reached by the shortest ways, whatever else is visited.
#[must_use]
pub fn reaches(problem: &TimedProblem, times: &impl TravelTimes) -> Vec<Reach> {
    let worth = Worth::of(&problem.targets);
    let endless = TimedProblem {
        latest_end_s: None,
        ..problem.clone()
    };
    let [limited, endless] =
        [problem, &endless].map(|problem| Instance::new(problem, times, &worth));
    let reach = |target| {
        if limited.is_reached(target) {
            Reach::InTime
        } else if endless.is_reached(target) {
            Reach::TooLate
        } else {
            Reach::OutsideWindows
        }
    };
    (0..problem.targets.len()).map(reach).collect()
}

/// The legs that some schedule may have.
#[must_use]
pub fn possible_legs(problem: &TimedProblem, times: &impl TravelTimes) -> Vec<(Place, Place)> {
    let worth = Worth::of(&problem.targets);
    let instance = Instance::new(problem, times, &worth);
    let targets = 0..instance.count;
    let mut legs = Vec::new();
    for target in targets
        .clone()
        .filter(|target| instance.is_reached(*target))
    {
        let place = Place::Target(target);
        legs.push((Place::Start, place));
        if problem.has_end {
            legs.push((place, Place::End));
        }
        let Some(first) = instance.begin_after(target, 0.0) else {
            continue;
        };
        let departure = first + instance.service[target];
        let too_late = instance.out_of_reach(target + 1, departure);
        let next = targets
            .clone()
            .filter(|next| *next != target && !too_late.contains(*next));
        legs.extend(next.map(|next| (place, Place::Target(next))));
    }
    if problem.has_end {
        legs.push((Place::Start, Place::End));
    }
    legs
}
