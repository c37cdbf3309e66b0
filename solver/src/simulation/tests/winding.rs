//! Integral windup while wheels are at their limits.

use super::super::{ControllerSpec, ErrorsSpec, PidGainsSpec, SimulationSpec};
use super::build::{calm_scenario, idle, simulation};
use crate::model::attitude::Attitude;

/// A controller with an initial error so large that the wheels saturate.
fn spec(anti_windup: bool) -> SimulationSpec {
    SimulationSpec {
        controller: ControllerSpec::GeometricPid {
            gains: PidGainsSpec::Bandwidth {
                bandwidth_rad_s: 0.2,
                damping: 0.8,
                integral_rad_s: 0.2,
            },
            anti_windup,
        },
        errors: ErrorsSpec {
            initial_attitude_3_sigma_rad: Some(2.0),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    }
}

/// Overshoot as a share of the initial error, and the time, s, after which the error stays within a
/// hundredth of the initial one.
fn recovery(spec: &SimulationSpec, number: u64) -> (f64, f64) {
    let (scenario, flight) = (calm_scenario(), idle(600.0));
    let simulated = simulation(&scenario, &flight, spec).simulate(number, Some(1), &|| false);
    let states = simulated.expect("not stopped").states;
    let turn = |attitude: &Attitude| Attitude::identity().signed_turn_to(attitude);
    let begin = turn(&states[0].attitude);
    let (size, axis) = (begin.norm(), begin.normalize());
    let along = states.iter().map(|state| -turn(&state.attitude).dot(&axis));
    let settled = states
        .iter()
        .rev()
        .find(|state| state.error.attitude_rad > 0.01 * size);
    let settled = settled.map_or(0.0, |state| state.time_s);
    (along.fold(0.0, f64::max) / size, settled)
}

#[test]
fn anti_windup_reduces_overshoot_and_settling_time() {
    for number in [1, 2] {
        let [clamped, pure] = [true, false].map(|anti_windup| recovery(&spec(anti_windup), number));
        println!("{number}: {clamped:?}, as published {pure:?}");
        let ((over, settled), (pure_over, pure_settled)) = (clamped, pure);
        assert!(pure_over > 0.015 && over < 0.5 * pure_over);
        assert!(settled < 0.85 * pure_settled);
    }
}
