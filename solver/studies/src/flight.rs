//! One simulated flight of a plan.

use slewplan_solver::model::plan::{self, Flight, Optimality};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::simulation::{SimulatedFlight, Simulation, SimulationSpec};
use slewplan_solver::tour::planner::{self, Run};

/// Number of states that are kept by default, and the greatest number.
const DEFAULT_STATES: usize = 2_000;
const MAX_STATES: usize = 10_000;

/// A valid request for a simulated flight.
#[derive(Debug)]
pub struct FlightStudy {
    /// The scenario of the plan.
    pub scenario: Scenario,
    /// The plan; the scenario is solved when there is none.
    pub plan: Option<Flight>,
    /// How the plan is simulated.
    pub simulation: SimulationSpec,
    /// Number of the flight: for the same seed other numbers draw other errors.
    pub number: u64,
    /// A state is kept every this many samples of the on-board computer.
    pub keep_every: Option<usize>,
    /// Remarks that do not keep the flight from being simulated.
    pub warnings: Vec<Problem>,
}

/// The outcome of a request.
#[derive(Debug)]
pub enum FlightStudyOutcome {
    /// A plan and its simulated flight.
    Simulated(Box<SimulatedPlan>),
    /// The scenario has no plan, for these reasons.
    NoPlan(Vec<Problem>),
    /// Stopped before there was a plan, or cancelled before the simulation was complete.
    Stopped,
}

/// A plan and its simulated flight.
#[derive(Debug)]
pub struct SimulatedPlan {
    /// The plan.
    pub plan: Flight,
    /// Optimality of a plan that was solved for this request.
    pub optimality: Option<Optimality>,
    /// The simulated flight.
    pub simulated: SimulatedFlight,
    /// A state was kept every this many samples of the on-board computer.
    pub keep_every: usize,
    /// Time between samples of the on-board computer, s.
    pub sample_s: f64,
    /// Duration of the simulation, s.
    pub flight_time_s: f64,
    /// Greatest attitude error that counts as a success, rad.
    pub tolerance_rad: f64,
}

/// Solves the scenario, unless a plan is given, and simulates one flight.
///
/// # Errors
///
/// Problems of the simulation that depend on the plan.
pub fn simulate(study: &FlightStudy, run: Run<'_>) -> Result<FlightStudyOutcome, Vec<Problem>> {
    let (plan, optimality) = match &study.plan {
        Some(flight) => (flight.clone(), None),
        None => match planner::solve(&study.scenario, run) {
            plan::Outcome::Planned(plan) => (plan.flight, Some(plan.optimality)),
            plan::Outcome::Infeasible(reasons) | plan::Outcome::Failed(reasons) => {
                return Ok(FlightStudyOutcome::NoPlan(reasons));
            }
            plan::Outcome::StoppedEmpty => return Ok(FlightStudyOutcome::Stopped),
        },
    };
    let simulation = Simulation::try_new(&study.scenario, &plan, &study.simulation, "/simulation")?;
    let keep_every = keep_every(study, simulation.samples())?;
    // A stop asks for the best result so far, so that only cancelling ends the simulation.
    let cancelled = || run.stop.is_cancelled();
    let Some(simulated) = simulation.simulate(study.number, Some(keep_every), &cancelled) else {
        return Ok(FlightStudyOutcome::Stopped);
    };
    Ok(FlightStudyOutcome::Simulated(Box::new(SimulatedPlan {
        keep_every,
        simulated,
        sample_s: simulation.sample_s(),
        flight_time_s: simulation.flight_time_s(),
        tolerance_rad: simulation.tolerance_rad(),
        optimality,
        plan,
    })))
}

/// Number of samples per state that is kept: as asked for, or so that [`DEFAULT_STATES`] are kept.
fn keep_every(study: &FlightStudy, samples: usize) -> Result<usize, Vec<Problem>> {
    let Some(asked) = study.keep_every else {
        return Ok(samples.div_ceil(DEFAULT_STATES).max(1));
    };
    if samples / asked <= MAX_STATES {
        return Ok(asked);
    }
    Err(vec![Problem::new(
        "/keep_every",
        Code::OutOfRange,
        format!("the flight has {samples} samples, at most {MAX_STATES} can be kept"),
        format!("give at least {}", samples.div_ceil(MAX_STATES)),
    )])
}
