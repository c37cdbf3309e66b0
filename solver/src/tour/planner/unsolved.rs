//! Why a scenario has no plan: which slews have no solution, and where cones leave no way.
//!
//! Attitudes that cones do not part form connected sets: a place that is proved to be in another set
//! than the start is in no plan.

use super::places::Places;
use super::tours::Tours;
use crate::leg::clear_path::{self, PathOutcome, PathProblem, PathSearch};
use crate::leg::solve::arrival::Arrival;
use crate::model::plan::Outcome;
use crate::model::problem::{Code, Problem};
use crate::tour::order::Place;
use crate::wheels::envelope::{OutsideEnvelope, outside_envelope};

pub(super) const SLEW_HINT: &str =
    "check that the wheels can hold the stored momentum along the way, or relax the conditions";
const PATH_HINT: &str =
    "narrow the cones, move the attitude, or put a target where the way leads around";

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
        let search = way(places, Place::Start, *place)?;
        matches!(search.outcome, PathOutcome::Disconnected).then(|| {
            let message = format!(
                "no way leads from the start to {} around the cones: this is proved",
                places.name(*place)
            );
            Problem::new(pointer_of(*place), Code::NoClearPath, message, PATH_HINT)
        })
    };
    places.all().iter().filter_map(parted).collect()
}

/// The search for a way around the cones between two places; `None` without cones.
fn way(places: &Places<'_>, from: Place, to: Place) -> Option<PathSearch> {
    let cones = &places.with_cones.cones;
    let [from, to] = [from, to].map(|place| places.waypoint(place).attitude);
    let problem = PathProblem {
        cones,
        from,
        to,
        signed: places.arrival == Arrival::Quaternion,
    };
    (!cones.is_empty()).then(|| clear_path::find(&problem))
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
    let leg = &tours.free_legs()?.get(from, to)?.leg;
    if leg.solution.duration().is_some() {
        return None;
    }
    let names = [from, to].map(|place| places.name(place));
    if let Some(PathSearch {
        outcome: PathOutcome::Unknown {
            resolution,
            closest,
        },
        cells,
    }) = way(places, from, to)
    {
        let message = format!(
            "no way from {} to {} around the cones was found; one with a clearance of {:.2} degrees \
             would have been, among {cells} cells. The nearest point that was reached is {:.2} degrees \
             away",
            names[0],
            names[1],
            resolution.to_degrees(),
            closest.to_degrees(),
        );
        return Some(Problem::new(
            pointer_of(to),
            Code::NoClearPath,
            message,
            PATH_HINT,
        ));
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
    let [from, to] = [from, to].map(|place| places.waypoint(place).attitude);
    let turn = from.signed_turn_to(&places.arrival.signed(&to, &from));
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
