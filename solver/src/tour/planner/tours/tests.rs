//! The result for a tour does not depend on earlier evaluations.

use super::*;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::run::progress::Silent;
use crate::tour::legs::NoStore;
use crate::tour::planner::tests::with_leg_solver;

/// The answers of fresh tours to questions asked in this order.
fn answers(scenario: &Scenario, questions: &[&dyn Fn(&Tours<'_>) -> String]) -> Vec<String> {
    let stop = StopSignal::new();
    with_leg_solver(scenario, &Silent, &NoStore, &stop, |legs, _| {
        let tours = Tours::new(legs.places(), legs, &stop);
        questions.iter().map(|ask| ask(&tours)).collect()
    })
}

#[test]
fn evaluations_in_any_order_give_the_same_results() {
    let mut spec = experiment_a();
    // Without an end, a whole tour has the same places as a beginning.
    spec.end = None;
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let order = [0, 5, 1, 3, 2];
    let places: Vec<_> = order.map(Place::Target).into();
    let beginning = |tours: &Tours<'_>| format!("{:?}", tours.prefix_bound(&order));
    let piece = |tours: &Tours<'_>| {
        let route = [&[Place::Start], &places[..]].concat();
        format!("{:?}", tours.path_bound(&route))
    };
    let tour = |tours: &Tours<'_>| format!("{:?}", tours.tour(&order));
    let questions: [&dyn Fn(&Tours<'_>) -> String; 3] = [&beginning, &piece, &tour];
    let alone = questions.map(|question| answers(&scenario, &[question]).remove(0));
    assert_ne!(
        alone[0], alone[1],
        "the kinds of segment must differ, or this tests nothing"
    );
    let forth = answers(&scenario, &questions);
    assert_eq!(forth, alone);
    let back = questions.iter().rev().copied().collect::<Vec<_>>();
    let mut back = answers(&scenario, &back);
    back.reverse();
    assert_eq!(back, alone);
}
