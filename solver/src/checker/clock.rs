//! Whether the visits of a flight lie inside windows and the flight ends in time, and what its visits are
//! worth.

use super::TIME_TOLERANCE;
use super::number_format::figure;
use crate::model::plan::{Flight, Passage};
use crate::model::scenario::{Scenario, Target, Window};

/// Sentences about visits outside all windows of their targets, and about an end that is too late.
/// Unknown targets and times that are not finite are reported in [`super::visits`].
pub(super) fn untimely(scenario: &Scenario, flight: &Flight) -> Vec<String> {
    let slack = TIME_TOLERANCE * flight.total_time_s;
    let visited = |passage: &Passage| {
        let target = scenario.targets().iter().find(|t| t.id == passage.target)?;
        outside(target, passage, slack)
    };
    let mut failures: Vec<String> = flight.passages.iter().filter_map(visited).collect();
    failures.extend(scenario.latest_end().and_then(|latest| {
        let late = flight.total_time_s > latest + slack;
        late.then(|| {
            format!(
                "the flight ends at {} s, after the latest end at {} s",
                figure(flight.total_time_s),
                figure(latest)
            )
        })
    }));
    failures
}

/// A sentence about a visit that lies in no window of its target, as a whole.
fn outside(target: &Target, passage: &Passage, slack: f64) -> Option<String> {
    let windows = target.windows.as_ref()?;
    let (arrival, departure) = (passage.time_s, passage.departure_s);
    let holds = |window: &Window| arrival >= window.from - slack && departure <= window.to + slack;
    if windows.iter().any(holds) {
        return None;
    }
    // By how much the visit would have to be moved into a window.
    let distance = |window: &Window| (window.from - arrival).max(departure - window.to);
    let nearest = windows
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let nearest = nearest.map_or_else(
        || "it has none".to_owned(),
        |window| {
            format!(
                "the nearest is from {} s to {} s",
                figure(window.from),
                figure(window.to)
            )
        },
    );
    Some(format!(
        "target '{}' is visited from {} s to {} s, outside its windows: {nearest}",
        target.id,
        figure(arrival),
        figure(departure)
    ))
}

/// Sum of the values of the targets that a flight visits, in the order of the scenario; a target that is
/// visited again counts once. `None` where no target has a value.
pub(super) fn value(scenario: &Scenario, flight: &Flight) -> Option<f64> {
    let mut targets = scenario.targets().iter();
    targets.clone().any(|t| t.value.is_some()).then(|| {
        targets.by_ref().fold(0.0, |sum, target| {
            let visited = flight.passages.iter().any(|p| p.target == target.id);
            sum + target.value.filter(|_| visited).unwrap_or(0.0)
        })
    })
}
