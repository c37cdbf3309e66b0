//! Stopping simulated flights.

use super::super::{ControllerSpec, SimulationSpec};
use super::build::{calm_scenario, idle, simulation};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use std::cell::Cell;
use std::num::NonZeroUsize;
use std::time::Duration;

/// Short steps, so that a flight takes many of them.
fn long() -> SimulationSpec {
    SimulationSpec {
        controller: ControllerSpec::FeedForward,
        max_step_s: Some(1e-3),
        ..SimulationSpec::default()
    }
}

/// How often a simulation checks for a stop, and whether it completes, when the check with a number
/// says to stop.
fn checked(spec: &SimulationSpec, stopped_at: Option<usize>) -> (usize, bool) {
    let (scenario, flight) = (calm_scenario(), idle(10.0));
    let checks = Cell::new(0);
    let check = || {
        checks.set(checks.get() + 1);
        stopped_at == Some(checks.get())
    };
    let simulated = simulation(&scenario, &flight, spec).simulate(0, Some(1), &check);
    (checks.get(), simulated.is_some())
}

#[test]
fn a_simulation_checks_every_256_steps_and_ends_at_once() {
    // The same number of steps, in short cycles and in a single one.
    let slow = SimulationSpec {
        on_board_rate_hz: Some(0.1),
        wheel_loop_rate_hz: Some(0.1),
        ..long()
    };
    for spec in [long(), slow] {
        assert_eq!(checked(&spec, None), (1 + 10_000 / 256, true));
        for check in [1, 2, 20] {
            assert_eq!(checked(&spec, Some(check)), (check, false));
        }
    }
}

#[test]
fn a_monte_carlo_run_stops_before_and_during_flights() {
    let (scenario, flight) = (calm_scenario(), idle(1999.0));
    let simulation = simulation(&scenario, &flight, &long());
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a pool");
    let given = StopSignal::new();
    given.request();
    assert_eq!(simulation.monte_carlo(&pool, &given).runs, 0);
    // Two million steps take longer than the limit, so that the first flight is interrupted.
    let limited = StopSignal::new().with_time_limit(Duration::from_millis(50));
    let spread = simulation.monte_carlo(&pool, &limited);
    assert_eq!((spread.runs, spread.runs_asked), (0, 1000));
}
