//! Whether the targets are visited in an order that the scenario admits.

use crate::model::plan::Flight;
use crate::model::scenario::Scenario;

/// Sentences about visits at the wrong place in the order. Of several visits of a target the first
/// counts; missing and repeated visits are reported in [`super::visits`].
pub(super) fn misplaced(scenario: &Scenario, flight: &Flight) -> Vec<String> {
    let rules = scenario.order_rules();
    let targets = scenario.targets();
    let place = |target: usize| {
        let id = &targets[target].id;
        flight.passages.iter().position(|p| p.target == *id)
    };
    let places: Vec<Option<usize>> = (0..targets.len()).map(place).collect();
    let mut failures = Vec::new();
    for (index, target) in targets.iter().enumerate() {
        let Some(place) = places[index] else { continue };
        if let Some(wanted) = rules.position(index).filter(|wanted| *wanted != place) {
            failures.push(format!(
                "target '{}' is visited at position {} instead of {}",
                target.id,
                place + 1,
                wanted + 1
            ));
        }
        for &before in rules.predecessors(index) {
            if places[before].is_some_and(|before| before > place) {
                failures.push(format!(
                    "target '{}' is visited before '{}', after which it has to come",
                    target.id, targets[before].id
                ));
            }
        }
    }
    failures
}
