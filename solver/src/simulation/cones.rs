//! How close boresights come to cones during a simulated flight.

use crate::model::attitude::Attitude;
use crate::model::cone::Applies;
use crate::model::plan::{ConeClearance, Flight};
use crate::model::scenario::Scenario;

/// The closest approaches to the cones of a scenario so far.
#[derive(Debug)]
pub(super) struct ConeApproaches<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    /// Least angle to the surface, rad, with its time, s, of every cone.
    nearest: Vec<(f64, f64)>,
}

impl<'a> ConeApproaches<'a> {
    /// `flight` is the plan, whose passages say when the spacecraft is at targets.
    pub(super) fn new(scenario: &'a Scenario, flight: &'a Flight) -> Self {
        Self {
            scenario,
            flight,
            nearest: vec![(f64::INFINITY, 0.0); scenario.cones().len()],
        }
    }

    /// Takes in the true attitude at a time, s.
    pub(super) fn sample(&mut self, time_s: f64, attitude: &Attitude) {
        let cones = self.scenario.cones();
        if cones.is_empty() {
            return;
        }
        let passages = &self.flight.passages;
        let next = passages.partition_point(|passage| passage.departure_s < time_s);
        let at_target = passages.get(next).is_some_and(|it| it.time_s <= time_s);
        for (cone, nearest) in cones.iter().zip(&mut self.nearest) {
            let clearance = cone.clearance(attitude);
            let applies = at_target || cone.applies != Applies::AtTargets;
            if applies && clearance < nearest.0 {
                *nearest = (clearance, time_s);
            }
        }
    }

    /// The closest approach to each cone that applied at some sample.
    pub(super) fn clearances(&self) -> Vec<ConeClearance> {
        let each = self.scenario.cones().iter().zip(&self.nearest);
        let met = each.filter(|(_, (clearance, _))| clearance.is_finite());
        met.map(|(cone, &(clearance, time_s))| ConeClearance::new(cone, clearance, time_s))
            .collect()
    }
}
