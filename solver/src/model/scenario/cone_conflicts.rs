//! Attitudes of a scenario that themselves point a boresight to the wrong side of a cone: no plan
//! through them keeps it. Where the roll is free, none of the admissible ones does.

use super::{End, Scenario, Start, Target};
use crate::model::attitude::Attitude;
use crate::model::cone::{Applies, Cone, Side};
use crate::model::findings::Findings;
use crate::model::problem::{Code, MAX_KEPT, Problem};
use crate::model::roll::FreeRoll;
use crate::model::tolerances::ATTITUDE_TOLERANCE;
use std::fmt;

/// Greatest number of cones that a message names.
const MAX_NAMED: usize = 10;
/// What to do about a roll that cones exclude.
const ROLL_HINT: &str = "widen the limits of the roll, move the direction, or change the cone; with \
                         \"applies\": \"report\" a cone is reported and not enforced";

/// An attitude that every plan passes through, or one of its rolls.
#[derive(Clone, Copy)]
enum Place<'a> {
    Start(&'a Start),
    End(&'a End),
    Target(usize, &'a Target),
}

/// A place on the wrong side of a cone by an angle, rad; where the roll is free, at least by it.
struct Conflict<'a> {
    place: Place<'a>,
    cone: &'a Cone,
    depth: f64,
}

/// Problems of attitudes that violate a cone that is enforced there.
#[must_use]
pub(crate) fn cone_problems(scenario: &Scenario) -> Vec<Problem> {
    let problems = places(scenario).flat_map(|place| {
        let conflicts = conflicts_at(place, enforced(scenario, place)).take(MAX_KEPT);
        let mut problems: Vec<_> = conflicts.map(|conflict| conflict.problem()).collect();
        if problems.is_empty() {
            problems.extend(no_roll_left(scenario, place));
        }
        problems
    });
    problems.take(MAX_KEPT).collect()
}

/// Warns of attitudes that violate a cone that is only reported.
pub(super) fn warn_of_reported(scenario: &Scenario, findings: &mut Findings) {
    let reported = || {
        let cones = scenario.cones.iter();
        cones.filter(|cone| cone.applies == Applies::Report)
    };
    let conflicts = places(scenario).flat_map(|place| conflicts_at(place, reported()));
    for conflict in conflicts.take(MAX_KEPT) {
        findings.warn(
            conflict.place.pointer(),
            Code::AttitudeInKeepOut,
            conflict.message(),
            "every plan through this attitude violates the cone: change the attitude, or the cone",
        );
    }
}

/// The cones that are enforced at a place.
fn enforced<'a>(
    scenario: &'a Scenario,
    place: Place<'a>,
) -> impl Iterator<Item = &'a Cone> + Clone {
    let is_target = matches!(place, Place::Target(..));
    let cones = scenario.cones.iter();
    cones.filter(move |cone| cone.is_enforced_at(is_target))
}

/// The cones that a place violates, each at every admissible roll, in the order of the document.
fn conflicts_at<'a>(
    place: Place<'a>,
    cones: impl Iterator<Item = &'a Cone>,
) -> impl Iterator<Item = Conflict<'a>> {
    cones.filter_map(move |cone| {
        let depth = match place.roll() {
            None => -cone.clearance(place.attitude()),
            Some(free) => free.least_depth(&cone.forbidden(), place.attitude()),
        };
        (depth > ATTITUDE_TOLERANCE).then_some(Conflict { place, cone, depth })
    })
}

/// The problem of a free roll for which limits and enforced cones together leave nothing, although
/// each cone alone does.
fn no_roll_left(scenario: &Scenario, place: Place<'_>) -> Option<Problem> {
    let cones = enforced(scenario, place);
    let forbidden = cones.clone().map(Cone::forbidden);
    let clear = place
        .roll()?
        .clear_of(forbidden, place.attitude(), ATTITUDE_TOLERANCE);
    if !clear.is_empty() {
        return None;
    }
    let named: Vec<String> = cones.map(Cone::pointer).collect();
    let (first, more) = named.split_at(named.len().min(MAX_NAMED));
    let more = match more.len() {
        0 => String::new(),
        count => format!(" and {count} others"),
    };
    Some(Problem::new(
        format!("{}/pointing", place.pointer()),
        Code::NoRollLeft,
        format!(
            "limits and cones leave no roll: at {place} every admissible roll violates one of {}{more}",
            first.join(", ")
        ),
        ROLL_HINT,
    ))
}

/// The start, the end and the targets, in the order of the document.
fn places(scenario: &Scenario) -> impl Iterator<Item = Place<'_>> {
    let start = Place::Start(&scenario.start);
    let end = scenario.end.iter().map(Place::End);
    let targets = scenario.targets.iter().enumerate();
    let targets = targets.map(|(index, target)| Place::Target(index, target));
    std::iter::once(start).chain(end).chain(targets)
}

impl<'a> Place<'a> {
    fn attitude(self) -> &'a Attitude {
        match self {
            Self::Start(start) => &start.attitude,
            Self::End(end) => &end.attitude,
            Self::Target(_, target) => &target.attitude,
        }
    }

    fn roll(self) -> Option<&'a FreeRoll> {
        match self {
            Self::Start(start) => start.roll.as_ref(),
            Self::End(end) => end.roll.as_ref(),
            Self::Target(_, target) => target.roll.as_ref(),
        }
    }

    fn pointer(self) -> String {
        match self {
            Self::Start(_) => "/start".to_owned(),
            Self::End(_) => "/end".to_owned(),
            Self::Target(index, _) => format!("/targets/{index}"),
        }
    }
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(_) => f.write_str("the start"),
            Self::End(_) => f.write_str("the end"),
            Self::Target(_, target) => write!(f, "target \"{}\"", target.id),
        }
    }
}

impl Conflict<'_> {
    fn problem(&self) -> Problem {
        if self.place.roll().is_some() {
            return Problem::new(
                format!("{}/pointing", self.place.pointer()),
                Code::NoRollLeft,
                format!("limits and cones leave no roll: {}", self.message()),
                ROLL_HINT,
            );
        }
        Problem::new(
            self.place.pointer(),
            Code::AttitudeViolatesCone,
            self.message(),
            "change the attitude or the cone; with \"applies\": \"report\" the cone is reported \
             and not enforced",
        )
    }

    fn message(&self) -> String {
        let cone = self.cone;
        let side = match cone.side {
            Side::Out => "into the keep-out cone",
            Side::In => "out of the keep-in cone",
        };
        let [least, rolls] = match self.place.roll() {
            Some(_) => ["at least ", " at every admissible roll"],
            None => [""; 2],
        };
        format!(
            "{} points boresight '{}' {least}{:.3} degrees {side} of {} degrees ({}){rolls}",
            self.place,
            cone.boresight,
            self.depth.to_degrees(),
            // Rounding in the conversion to radians and back.
            (cone.half_angle.to_degrees() * 1e9).round() / 1e9,
            cone.pointer()
        )
    }
}
