//! Flights that nobody waits for any more.

use super::super::{ControllerSpec, SimulationSpec};
use super::build::{calm_scenario, idle, simulation};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use std::cell::Cell;
use std::num::NonZeroUsize;
use std::time::Duration;

/// Far more steps than any computer takes at once.
fn long() -> SimulationSpec {
    SimulationSpec {
        controller: ControllerSpec::FeedForward,
        max_step_s: Some(1e-3),
        ..SimulationSpec::default()
    }
}

/// How often a flight of so many steps asks, and whether it comes to its end, when it is given up at
/// a look.
fn asked(spec: &SimulationSpec, given_up_at: Option<usize>) -> (usize, bool) {
    let (scenario, flight) = (calm_scenario(), idle(10.0));
    let looks = Cell::new(0);
    let look = || {
        looks.set(looks.get() + 1);
        given_up_at == Some(looks.get())
    };
    let flown = simulation(&scenario, &flight, spec).fly(0, Some(1), &look);
    (looks.get(), flown.is_some())
}

#[test]
fn a_flight_looks_up_at_regular_steps_and_ends_at_once() {
    // The same number of steps in short cycles and in one that lasts all the flight.
    let slow = SimulationSpec {
        on_board_rate_hz: Some(0.1),
        wheel_loop_rate_hz: Some(0.1),
        ..long()
    };
    for spec in [long(), slow] {
        assert_eq!(asked(&spec, None), (1 + 10_000 / 256, true));
        for look in [1, 2, 20] {
            assert_eq!(asked(&spec, Some(look)), (look, false));
        }
    }
}

#[test]
fn a_stop_comes_before_and_during_many_flights() {
    let (scenario, flight) = (calm_scenario(), idle(1999.0));
    let simulation = simulation(&scenario, &flight, &long());
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a pool");
    let given = StopSignal::new();
    given.request();
    assert_eq!(simulation.monte_carlo(&pool, &given).runs, 0);
    // Two million steps take longer, so that the first flight is under way when the time is up.
    let limited = StopSignal::new().with_time_limit(Duration::from_millis(50));
    let spread = simulation.monte_carlo(&pool, &limited);
    assert_eq!((spread.runs, spread.runs_asked), (0, 1000));
}
