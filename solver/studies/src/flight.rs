//! One flight of a plan in closed loop, for the command line and the service alike.

use slewplan_solver::model::plan::{self, Flight, Optimality};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::simulation::{SimulatedFlight, Simulation, SimulationSpec};
use slewplan_solver::tour::planner::{self, Run};

/// States that are kept when nothing is said about it, and at most.
const DEFAULT_STATES: usize = 2_000;
const MAX_STATES: usize = 10_000;

/// A valid request for a flight.
#[derive(Debug)]
pub struct FlightStudy {
    /// What is flown.
    pub scenario: Scenario,
    /// The plan; made for the flight when there is none.
    pub plan: Option<Flight>,
    /// How it is flown.
    pub simulation: SimulationSpec,
    /// Which of the flights of the seed: other numbers draw other errors.
    pub number: u64,
    /// Every so many samples a state is wanted.
    pub keep_every: Option<usize>,
    /// Doubts that do not stand in the way.
    pub warnings: Vec<Problem>,
}

/// What came of a request.
#[derive(Debug)]
pub enum Outcome {
    /// A flight.
    Flown(Box<FlownOnce>),
    /// No plan to fly, for these reasons.
    NoPlan(Vec<Problem>),
    /// Stopped before there was a plan, or cancelled before it was flown.
    Stopped,
}

/// A plan and its flight.
#[derive(Debug)]
pub struct FlownOnce {
    /// The plan; with its optimality when it was made for the flight.
    pub plan: Flight,
    /// Of a plan that was made for the flight.
    pub optimality: Option<Optimality>,
    /// The flight.
    pub simulated: SimulatedFlight,
    /// Every so many samples of the on-board computer a state was kept.
    pub keep_every: usize,
    /// Time between samples of the on-board computer, s.
    pub sample_s: f64,
    /// How long it was flown, s.
    pub flight_time_s: f64,
    /// Error up to which an attitude counts as reached, rad.
    pub tolerance_rad: f64,
}

/// Plans, unless a plan is given, and flies once.
///
/// # Errors
///
/// Problems that are only known of with the plan.
pub fn fly(study: &FlightStudy, run: Run<'_>) -> Result<Outcome, Vec<Problem>> {
    let (plan, optimality) = match &study.plan {
        Some(flight) => (flight.clone(), None),
        None => match planner::solve(&study.scenario, run) {
            plan::Outcome::Planned(plan) => (plan.flight, Some(plan.optimality)),
            plan::Outcome::Infeasible(reasons) | plan::Outcome::Failed(reasons) => {
                return Ok(Outcome::NoPlan(reasons));
            }
            plan::Outcome::StoppedEmpty => return Ok(Outcome::Stopped),
        },
    };
    let simulation = Simulation::try_new(&study.scenario, &plan, &study.simulation, "/simulation")?;
    let keep_every = keep_every(study, simulation.samples())?;
    // Whoever wants the best so far wants this flight: half of it would be worth nothing.
    let cancelled = || run.stop.is_cancelled();
    let Some(simulated) = simulation.simulate(study.number, Some(keep_every), &cancelled) else {
        return Ok(Outcome::Stopped);
    };
    Ok(Outcome::Flown(Box::new(FlownOnce {
        keep_every,
        simulated,
        sample_s: simulation.sample_s(),
        flight_time_s: simulation.flight_time_s(),
        tolerance_rad: simulation.tolerance_rad(),
        optimality,
        plan,
    })))
}

/// Which samples are kept: as asked for, or so many that a picture does not need more.
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
