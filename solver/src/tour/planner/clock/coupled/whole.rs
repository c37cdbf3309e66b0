//! Whole schedules: chain by chain from the start to the end.

use super::node::Choice;
use crate::model::scenario::Window;
use crate::tour::order::Place;
use crate::tour::planner::clock::chains::{NoChain, SolvedChain, Visit, may_wait, solve_chain};
use crate::tour::planner::tours::Tours;

/// The solved chains of a whole schedule, and when it ends, s.
#[derive(Debug, Clone)]
pub(super) struct WholeSchedule {
    pub(super) chains: Vec<SolvedChain>,
    pub(super) end: f64,
}

/// Solves the schedule of all these visits, to the end where there is one.
pub(super) fn solve_whole(tours: &Tours<'_>, choices: &[Choice]) -> Result<WholeSchedule, NoChain> {
    let places = tours.places;
    let targets = places.scenario.targets();
    let mut ahead: Vec<Visit> = choices.iter().map(|choice| choice.visit(targets)).collect();
    if places.scenario.end().is_some() {
        ahead.push(Visit {
            place: Place::End,
            window: None,
        });
    }
    let mut chains = Vec::new();
    let (mut from, mut departure) = (Place::Start, 0.0);
    let mut rest = &ahead[..];
    while !rest.is_empty() {
        let stop = rest.iter().position(|visit| may_wait(places, visit.place));
        let (chain, after) = rest.split_at(stop.map_or(rest.len(), |stop| stop + 1));
        let solved = solve_chain(tours, (from, departure), chain)?;
        (from, departure) = (chain[chain.len() - 1].place, departure_of(tours, &solved));
        chains.push(solved);
        rest = after;
    }
    let latest = places.scenario.latest_end().unwrap_or(f64::INFINITY);
    if departure > latest {
        return Err(NoChain::TooLate);
    }
    Ok(WholeSchedule {
        chains,
        end: departure,
    })
}

/// When the last place of a chain is left, s.
pub(super) fn departure_of(tours: &Tours<'_>, chain: &SolvedChain) -> f64 {
    let last = chain
        .route
        .last()
        .map_or(0.0, |place| tours.places.service_time(*place));
    chain.begins.last().map_or(0.0, |begin| begin + last)
}

/// The first windows of targets in an order that are left by the times of single legs; `None` where
/// there are none.
pub(super) fn first_windows(tours: &Tours<'_>, order: &[usize]) -> Option<Vec<Choice>> {
    let (mut at, mut time) = (Place::Start, 0.0);
    let targets = tours.places.scenario.targets();
    let mut choices = Vec::with_capacity(order.len());
    for &target in order {
        let (place, service) = (Place::Target(target), targets[target].service());
        let arrival = time + tours.leg_bound(at, place);
        let fits = |window: &Window| arrival.max(window.from) + service <= window.to;
        let (window, begin) = match &targets[target].windows {
            None => (None, arrival),
            Some(windows) => {
                let number = windows.iter().position(fits)?;
                (Some(number), arrival.max(windows[number].from))
            }
        };
        choices.push(Choice { target, window });
        (at, time) = (place, begin + service);
    }
    Some(choices)
}
