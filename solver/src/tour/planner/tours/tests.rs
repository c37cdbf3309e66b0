//! What is found of a tour does not depend on what was asked for before.

use super::*;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::run::pool::SolverPool;
use crate::run::progress::Silent;
use crate::tour::legs::NoStore;
use crate::tour::planner::Run;
use std::num::NonZeroUsize;

/// Answers of tours that have been asked nothing else before but what comes before in the list.
fn answers(scenario: &Scenario, questions: &[&dyn Fn(&Tours<'_>) -> String]) -> Vec<String> {
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let stop = StopSignal::new();
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &Silent,
        legs: &NoStore,
        segments: &NoStore,
    };
    let places = Places::of(scenario);
    let legs = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &legs, &stop);
    questions.iter().map(|ask| ask(&tours)).collect()
}

#[test]
fn the_answers_are_the_same_in_any_order_of_the_questions() {
    let mut spec = experiment_a();
    // Without an end a whole tour has the same places as the beginning of longer ones.
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
        "different starts, or this tests nothing"
    );
    let forth = answers(&scenario, &questions);
    assert_eq!(forth, alone);
    let back = questions.iter().rev().copied().collect::<Vec<_>>();
    let mut back = answers(&scenario, &back);
    back.reverse();
    assert_eq!(back, alone);
}
