//! Attitudes of a scenario that themselves point a boresight to the wrong side of a cone: no plan
//! through them keeps it.

use super::{Scenario, Target};
use crate::model::attitude::Attitude;
use crate::model::cone::{Applies, Cone, Side};
use crate::model::findings::Findings;
use crate::model::problem::{Code, MAX_KEPT, Problem};
use crate::model::tolerances::ATTITUDE_TOLERANCE;
use std::fmt;

/// An attitude that every plan passes through.
#[derive(Clone, Copy)]
enum Place<'a> {
    Start(&'a Attitude),
    End(&'a Attitude),
    Target(usize, &'a Target),
}

/// An attitude on the wrong side of a cone by an angle, rad.
struct Conflict<'a> {
    place: Place<'a>,
    cone: &'a Cone,
    depth: f64,
}

/// Problems of attitudes that violate a cone that is enforced there.
#[must_use]
pub(crate) fn cone_problems(scenario: &Scenario) -> Vec<Problem> {
    let is_enforced = |cone: &Cone, place: Place<'_>| match cone.applies {
        Applies::Always => true,
        Applies::AtTargets => matches!(place, Place::Target(..)),
        Applies::Report => false,
    };
    let problem = |conflict: Conflict<'_>| {
        Problem::new(
            conflict.place.pointer(),
            Code::AttitudeViolatesCone,
            conflict.message(),
            "change the attitude or the cone; with \"applies\": \"report\" the cone is reported \
             and not enforced",
        )
    };
    let conflicts = conflicts(scenario, &is_enforced);
    conflicts.take(MAX_KEPT).map(problem).collect()
}

/// Warns of attitudes that violate a cone that is only reported.
pub(super) fn warn_of_reported(scenario: &Scenario, findings: &mut Findings) {
    let is_reported = |cone: &Cone, _: Place<'_>| cone.applies == Applies::Report;
    for conflict in conflicts(scenario, &is_reported).take(MAX_KEPT) {
        findings.warn(
            conflict.place.pointer(),
            Code::AttitudeInKeepOut,
            conflict.message(),
            "every plan through this attitude violates the cone: change the attitude, or the cone",
        );
    }
}

/// The attitudes with the chosen cones that they violate, in the order of the document.
fn conflicts<'a>(
    scenario: &'a Scenario,
    is_chosen: &'a impl Fn(&Cone, Place<'_>) -> bool,
) -> impl Iterator<Item = Conflict<'a>> {
    places(scenario).flat_map(move |place| {
        scenario.cones.iter().filter_map(move |cone| {
            let depth = -cone.clearance(place.attitude());
            (is_chosen(cone, place) && depth > ATTITUDE_TOLERANCE).then_some(Conflict {
                place,
                cone,
                depth,
            })
        })
    })
}

/// The start, the end and the targets, in the order of the document.
fn places(scenario: &Scenario) -> impl Iterator<Item = Place<'_>> {
    let start = Place::Start(&scenario.start.attitude);
    let end = scenario.end.iter().map(|end| Place::End(&end.attitude));
    let targets = scenario.targets.iter().enumerate();
    let targets = targets.map(|(index, target)| Place::Target(index, target));
    std::iter::once(start).chain(end).chain(targets)
}

impl Place<'_> {
    fn attitude(&self) -> &Attitude {
        match self {
            Self::Start(attitude) | Self::End(attitude) => attitude,
            Self::Target(_, target) => &target.attitude,
        }
    }

    fn pointer(&self) -> String {
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
    fn message(&self) -> String {
        let cone = self.cone;
        let side = match cone.side {
            Side::Out => "into the keep-out cone",
            Side::In => "out of the keep-in cone",
        };
        format!(
            "{} points boresight '{}' {:.3} degrees {side} of {} degrees ({})",
            self.place,
            cone.boresight,
            self.depth.to_degrees(),
            // Rounding in the conversion to radians and back.
            (cone.half_angle.to_degrees() * 1e9).round() / 1e9,
            cone.pointer()
        )
    }
}
