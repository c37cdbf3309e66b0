//! Why a scenario has no plan: which slews have no solution, and where cones leave no way.
//!
//! Attitudes that cones do not part form connected sets: a place that is proved to be in another set
//! than the start is in no plan.

use super::places::Places;
use super::tours::Tours;
use crate::leg::multiphase::LegSolution;
use crate::leg::no_way::{NoWay, WayProblem, no_way};
use crate::model::plan::Outcome;
use crate::model::problem::{Code, Problem};
use crate::tour::order::Place;
use crate::wheels::envelope::{OutsideEnvelope, outside_envelope};

pub(super) const SLEW_HINT: &str =
    "check that the wheels can hold the stored momentum along the way, or relax the conditions";

/// The outcome where no order could be solved.
pub(super) fn unsolved(tours: &Tours<'_>) -> Outcome {
    let enclosed = enclosed(tours.places);
    if !enclosed.is_empty() {
        return Outcome::Infeasible(enclosed);
    }
    let problems = unsolved_slews(tours);
    Outcome::Failed(problems)
}

/// Places that no way around the cones connects with the start, which is proved.
fn enclosed(places: &Places<'_>) -> Vec<Problem> {
    let parted = |place: &Place| {
        let names = ["the start", &*places.name(*place)];
        let parted = way_between(places, [Place::Start, *place], names)?;
        parted.is_proved.then_some(parted.problem)
    };
    places.all().iter().filter_map(parted).collect()
}

/// What is said where the cones leave no way between two places.
fn way_between(places: &Places<'_>, [from, to]: [Place; 2], names: [&str; 2]) -> Option<NoWay> {
    let pointer = pointer_of(to);
    let [from, to] = [from, to].map(|place| places.waypoint(place));
    let between = WayProblem {
        cones: &places.with_cones.cones,
        ends: [&from, &to],
        arrival: places.arrival,
    };
    no_way(&between, names, pointer)
}

/// How the solve of a leg between two places ended; where it has no solution, whether the cones leave
/// no way.
pub(super) fn leg_status(
    places: &Places<'_>,
    [from, to]: [Place; 2],
    solution: &LegSolution,
) -> &'static str {
    let status = solution.status.into_str();
    if solution.duration().is_some() {
        return status;
    }
    let names = [from, to].map(|place| places.name(place));
    let parted = way_between(places, [from, to], [&names[0], &names[1]]);
    parted.map_or(status, |parted| parted.status())
}

/// What is known of slews without a solution.
fn unsolved_slews(tours: &Tours<'_>) -> Vec<Problem> {
    let all = tours.places.all();
    let pairs = all
        .iter()
        .flat_map(|from| all.iter().map(move |to| (*from, *to)));
    let mut problems: Vec<_> = pairs
        .filter_map(|(from, to)| unsolved_slew(tours, from, to))
        .collect();
    if problems.is_empty() {
        let message = "every leg has a solution, but no whole order converged";
        problems.push(Problem::new(
            "/targets",
            Code::SlewNotSolved,
            message,
            SLEW_HINT,
        ));
    }
    problems
}

fn unsolved_slew(tours: &Tours<'_>, from: Place, to: Place) -> Option<Problem> {
    let places = tours.places;
    let leg = tours.known_free_leg(from, to)?.leg;
    if leg.solution.duration().is_some() {
        return None;
    }
    let names = [from, to].map(|place| places.name(place));
    if let Some(parted) = way_between(places, [from, to], [&names[0], &names[1]]) {
        return Some(parted.problem);
    }
    let reason = outside_on_turn(tours, from, to).map(|place| format!("; {place}"));
    let message = format!(
        "the slew from {} to {} ended with status {} after {} iterations, its conditions violated \
         by {:.1e} (scaled){}",
        names[0],
        names[1],
        leg.solution.status,
        leg.solution.iterations,
        leg.solution.infeasibility,
        reason.unwrap_or_default(),
    );
    Some(Problem::new(
        pointer_of(to),
        Code::SlewNotSolved,
        message,
        SLEW_HINT,
    ))
}

/// The point of the eigenaxis turn between two places at which the momentum lies outside the
/// envelope of the wheels, if there is one.
fn outside_on_turn(tours: &Tours<'_>, from: Place, to: Place) -> Option<OutsideEnvelope> {
    let places = &tours.places;
    let [from, to] = places.nearest_attitudes([from, to]);
    let turn = places.arrival.turn_vector(&from, &to);
    outside_envelope(places.scenario, &from, turn)
}

/// JSON pointer of a place in the scenario.
fn pointer_of(place: Place) -> String {
    match place {
        Place::Start => "/start".to_owned(),
        Place::Target(index) => format!("/targets/{index}"),
        Place::End => "/end".to_owned(),
    }
}
