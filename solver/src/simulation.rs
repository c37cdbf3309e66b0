//! Closed-loop simulation of plans, with a true spacecraft that differs from the nominal one.
//!
//! A plan's torques are the feed-forward. A [control law](ControllerSpec) on the on-board computer adds
//! feedback through the pseudo-inverse of the wheel axes. A faster wheel loop compensates friction and
//! keeps torque and speed within the hardware's limits. The true spacecraft has its own inertia, wheel
//! axes and friction, and all of its 7 + K states are integrated. The shares of torque and speed that a
//! plan does not use ([`torque_authority`] and [`momentum_authority`]) are left to feedback.
//!
//! Random numbers depend on a seed and the number of the flight only, so that single flights can be
//! repeated and results do not depend on the number of threads.
//!
//! The plan's motion comes from the [`checker`](crate::checker); the loop itself uses neither the
//! checker's integrator nor the optimiser.
//!
//! [`torque_authority`]: crate::model::spec::OptionsSpec::torque_authority
//! [`momentum_authority`]: crate::model::spec::OptionsSpec::momentum_authority

mod allocation;
mod closed_loop;
mod cone_spread;
mod cones;
mod controller;
mod draws;
mod gains;
mod monte_carlo;
mod outcome;
mod percentiles;
mod preparation;
mod sampled_plan;
mod settings;
mod spec;
mod stop_poll;
mod truth;
mod wheel_loop;

pub use cone_spread::ConeSpread;
pub use gains::QuaternionGains;
pub use monte_carlo::{PassageSpread, SaturationSpread, Spread};
pub use outcome::{PassageError, Saturation, SimulatedFlight, SimulatedState, TrackingError};
pub use percentiles::{LowPercentiles, Percentiles};
pub use settings::check;
pub use spec::{
    ControllerSpec, ErrorsSpec, FeedForwardMode, GainsSpec, PidGainsSpec, SimulationSpec,
};

use crate::checker::PropagatedMotion;
use crate::model::findings::Findings;
use crate::model::plan::Flight;
use crate::model::problem::Problem;
use crate::model::scenario::Scenario;
use preparation::{fits, longest_step, motion, refuse_flight, rotors};
use sampled_plan::SampledPlan;
use settings::SimulationSettings;
use truth::TrueSpacecraft;

/// A plan that can be simulated any number of times.
#[derive(Debug)]
pub struct Simulation<'a> {
    scenario: &'a Scenario,
    flight: &'a Flight,
    settings: SimulationSettings,
    sampled_plan: SampledPlan,
    /// The nominal spacecraft, with the disturbance torque.
    nominal: TrueSpacecraft,
}

impl<'a> Simulation<'a> {
    /// Validates the description of a simulation for a scenario's flight and collects every problem;
    /// `pointer` is the JSON pointer of the description.
    ///
    /// # Errors
    ///
    /// All problems at once. Problems of the flight itself, which need not be a plan of this program,
    /// have the code [`Code::VerificationFailed`](crate::model::problem::Code::VerificationFailed) and
    /// the pointer `/plan`.
    pub fn try_new(
        scenario: &'a Scenario,
        flight: &'a Flight,
        spec: &SimulationSpec,
        pointer: &str,
    ) -> Result<Self, Vec<Problem>> {
        let mut findings = Findings::default();
        let settings =
            SimulationSettings::read(spec, scenario.spacecraft(), pointer, &mut findings);
        let motion = motion(scenario, flight, &mut findings);
        let simulation = settings.zip(motion).and_then(|(mut settings, motion)| {
            settings.max_step_s = longest_step(scenario, &settings);
            fits(flight, &motion, &settings, pointer, &mut findings)
                .then(|| Self::prepare(scenario, flight, settings, &motion, &mut findings))?
        });
        findings
            .conclude(simulation)
            .map(|(simulation, _)| simulation)
    }

    fn prepare(
        scenario: &'a Scenario,
        flight: &'a Flight,
        settings: SimulationSettings,
        motion: &PropagatedMotion,
        findings: &mut Findings,
    ) -> Option<Self> {
        let sampled_plan = SampledPlan::new(scenario, flight, motion, &settings);
        let nominal = TrueSpacecraft::new(
            scenario.spacecraft().inertia(),
            rotors(scenario, &settings),
            &scenario.start().wheel_speed,
            settings.errors.disturbance,
        );
        let prepared = sampled_plan.zip(nominal);
        if prepared.is_none() {
            refuse_flight(
                findings,
                "the motion leaves the range of numbers that can be computed",
            );
        }
        let (sampled_plan, nominal) = prepared?;
        Some(Self {
            scenario,
            flight,
            settings,
            sampled_plan,
            nominal,
        })
    }

    /// Number of samples of the on-board computer.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.sampled_plan.samples.len()
    }

    /// Time between two samples of the on-board computer, s.
    #[must_use]
    pub fn sample_s(&self) -> f64 {
        self.settings.sample_s
    }

    /// Duration of a flight with the time to settle, s.
    #[must_use]
    pub fn flight_time_s(&self) -> f64 {
        self.flight.total_time_s + self.settings.settle_s
    }

    /// Attitude error at the end up to which a flight counts as a success, rad.
    #[must_use]
    pub fn tolerance_rad(&self) -> f64 {
        self.settings.tolerance
    }
}

#[cfg(test)]
mod tests;
