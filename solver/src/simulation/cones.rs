//! How close boresights come to cones during a simulated flight.

use crate::checker::NOT_COMPUTED;
use crate::model::attitude::Attitude;
use crate::model::cone::{Applies, Cone};
use crate::model::plan::{ConeClearance, Flight};
use crate::model::scenario::Scenario;

/// The cones that apply at some time of a plan: those at targets only if it has any.
pub(super) fn applicable<'a>(
    scenario: &'a Scenario,
    flight: &Flight,
) -> impl Iterator<Item = &'a Cone> {
    let passes = !flight.passages.is_empty();
    let cones = scenario.cones().iter();
    cones.filter(move |cone| passes || cone.applies != Applies::AtTargets)
}

/// The closest approaches to the cones of a scenario so far.
#[derive(Debug)]
pub(super) struct ConeApproaches<'a> {
    flight: &'a Flight,
    /// Cones with the least angle to their surface, rad, and its time, s.
    nearest: Vec<(&'a Cone, f64, f64)>,
}

impl<'a> ConeApproaches<'a> {
    /// `flight` is the plan, whose passages say when the spacecraft is at targets.
    pub(super) fn new(scenario: &'a Scenario, flight: &'a Flight) -> Self {
        let cones = applicable(scenario, flight);
        Self {
            flight,
            nearest: cones.map(|cone| (cone, f64::INFINITY, 0.0)).collect(),
        }
    }

    /// Takes in the true attitude at a time, s.
    pub(super) fn sample(&mut self, time_s: f64, attitude: &Attitude) {
        if self.nearest.is_empty() {
            return;
        }
        let passages = &self.flight.passages;
        let next = passages.partition_point(|passage| passage.departure_s < time_s);
        let at_target = passages.get(next).is_some_and(|it| it.time_s <= time_s);
        self.take_in(time_s, attitude, at_target);
    }

    /// Takes in the true attitude at an arrival, which may be the only moment at a target.
    pub(super) fn arrive(&mut self, time_s: f64, attitude: &Attitude) {
        self.take_in(time_s, attitude, true);
    }

    fn take_in(&mut self, time_s: f64, attitude: &Attitude, at_target: bool) {
        for (cone, least, when_s) in &mut self.nearest {
            let clearance = cone.clearance(attitude);
            let applies = at_target || cone.applies != Applies::AtTargets;
            if applies && clearance < *least {
                (*least, *when_s) = (clearance, time_s);
            }
        }
    }

    /// The motion is not finite from this time, s, on: how close it comes is not known.
    pub(super) fn break_off(&mut self, time_s: f64) {
        for (_, least, when_s) in &mut self.nearest {
            if *least > -NOT_COMPUTED {
                (*least, *when_s) = (-NOT_COMPUTED, time_s);
            }
        }
    }

    /// The closest approach to each cone.
    pub(super) fn clearances(&self) -> Vec<ConeClearance> {
        let each = self.nearest.iter();
        each.map(|&(cone, least, time_s)| ConeClearance::new(cone, least, time_s))
            .collect()
    }
}
