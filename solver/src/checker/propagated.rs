//! The motion of a flight as a function of time.

use super::dynamics::{Body, Snapshot};
use super::integrator::{STEP_TOLERANCE, integrate};
use super::series::Expansion;
use super::{state, timeline};
use crate::model::plan::{Flight, State};
use crate::model::scenario::Scenario;
use nalgebra::Vector3;

/// The integrated motion of a flight: the polynomials of the verification's steps, so that states
/// between two steps are as accurate as those at steps.
#[derive(Debug)]
pub struct PropagatedMotion {
    steps: Vec<KeptStep>,
}

#[derive(Debug)]
struct KeptStep {
    begin_s: f64,
    end_s: f64,
    expansion: Expansion,
}

impl PropagatedMotion {
    /// Integrates a flight from the scenario's start, without testing limits and targets.
    ///
    /// # Errors
    ///
    /// Sentences about why the flight cannot be propagated: controls that do not fit the wheels or
    /// leave gaps, numbers that are not finite, a motion too fast for the integration.
    pub fn of(scenario: &Scenario, flight: &Flight) -> Result<Self, Vec<String>> {
        let spacecraft = scenario.spacecraft();
        let intervals = timeline::intervals(flight, spacecraft.wheels())?;
        let body = Body::new(spacecraft.inertia(), spacecraft.wheels());
        let body = body.map_err(|sentence| vec![sentence])?;
        let start = Snapshot::at_start(scenario);
        let mut steps = Vec::new();
        integrate(&body, start, &intervals, STEP_TOLERANCE, |step| {
            steps.push(KeptStep {
                begin_s: step.begin_s,
                end_s: step.end_s,
                expansion: step.motion.clone(),
            });
        })
        .map_err(|sentence| vec![sentence])?;
        if steps.is_empty() {
            return Err(vec!["the flight takes no time".to_owned()]);
        }
        Ok(Self { steps })
    }

    /// The state at a time, s; before the start that of the start, after the end that of the end.
    /// The sign of the quaternion is continuous from the start's. `None` when the quaternion is not
    /// finite, which no flight that [`PropagatedMotion::of`] accepts leads to.
    #[must_use]
    pub fn state(&self, time_s: f64) -> Option<State> {
        let (step, since) = self.step_at(time_s)?;
        let snapshot = Snapshot {
            time_s,
            ..step.expansion.state(since)
        };
        state(&snapshot)
    }

    /// The angular acceleration in body axes, rad/s², at a time, s; where the torques switch, the one
    /// after the switch.
    #[must_use]
    pub fn acceleration(&self, time_s: f64) -> Option<Vector3<f64>> {
        let (step, since) = self.step_at(time_s)?;
        Some(step.expansion.rate_slope(since))
    }

    fn step_at(&self, time_s: f64) -> Option<(&KeptStep, f64)> {
        let begun = self.steps.partition_point(|step| step.begin_s <= time_s);
        let step = self.steps.get(begun.saturating_sub(1))?;
        let since = (time_s.min(step.end_s) - step.begin_s).max(0.0);
        Some((step, since))
    }
}
