//! The control laws against closed forms of small errors.

use super::super::{
    ControllerSpec, ErrorsSpec, GainsSpec, SimulatedFlight, SimulationSpec, TrackingError,
};
use super::build::{BANDWIDTH, calm_scenario, idle, lively, pid, quaternion, scenario, simulation};
use crate::model::spec::{AttitudeSpec, TargetSpec};

/// A controller with an initial attitude error.
fn off(controller: ControllerSpec) -> SimulationSpec {
    SimulationSpec {
        controller,
        errors: ErrorsSpec {
            initial_attitude_3_sigma_rad: Some(0.03),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    }
}

fn simulated(spec: &SimulationSpec, seconds: f64) -> SimulatedFlight {
    let (scenario, flight) = (calm_scenario(), idle(seconds));
    simulation(&scenario, &flight, spec)
        .simulate(1, Some(1), &|| false)
        .expect("not stopped")
}

#[test]
fn every_controller_reduces_an_initial_attitude_error() {
    let step = ControllerSpec::StepInput {
        gains: BANDWIDTH,
        gyroscopic: false,
    };
    for controller in [quaternion(BANDWIDTH), step, pid(0.0), pid(0.02)] {
        let simulated = simulated(&off(controller), 400.0);
        let begin = simulated.states[0].error.attitude_rad;
        assert!(begin > 1e-3, "{begin:e}");
        assert!(
            simulated.end.attitude_rad < 2e-3 * begin,
            "{:?}",
            simulated.end
        );
    }
    let adrift = simulated(&off(ControllerSpec::FeedForward), 400.0);
    let change = adrift.end.attitude_rad - adrift.states[0].error.attitude_rad;
    assert!(change.abs() < 1e-9, "{change:e}");
}

#[test]
fn small_errors_decay_with_the_frequency_and_damping_of_the_gains() {
    let mut spec = off(quaternion(BANDWIDTH));
    spec.on_board_rate_hz = Some(100.0);
    let (w, z) = (0.1_f64, 0.7_f64);
    let damped = w * (1.0 - z * z).sqrt();
    for controller in [quaternion(BANDWIDTH), pid(0.0)] {
        spec.controller = controller;
        let simulated = simulated(&spec, 40.0);
        let begin = simulated.states[0].error.attitude_rad;
        for state in simulated.states.iter().step_by(100) {
            let phase = damped * state.time_s;
            let wave = phase.cos() + z * w / damped * phase.sin();
            let expected = begin * (-z * w * state.time_s).exp() * wave.abs();
            let error = state.error.attitude_rad;
            assert!(
                (error - expected).abs() < 2e-3 * begin,
                "{state:?}: {expected}"
            );
        }
    }
}

#[test]
fn published_gains_are_stable_at_200_hz_and_not_at_2_hz() {
    let gains = GainsSpec::SettlingTime {
        settling_time_s: 0.1,
        damping: 0.9,
    };
    let mut spec = off(quaternion(gains));
    spec.errors.initial_attitude_3_sigma_rad = Some(1e-4);
    let end = |spec: &SimulationSpec| simulated(spec, 5.0).end.attitude_rad;
    let begin = simulated(&spec, 5.0).states[0].error.attitude_rad;
    spec.on_board_rate_hz = Some(200.0);
    assert!(end(&spec) < 1e-3 * begin, "{:e}", end(&spec));
    spec.on_board_rate_hz = Some(2.0);
    assert!(end(&spec) > 10.0 * begin, "{:e}", end(&spec));
}

#[test]
fn delayed_feedback_uses_up_the_phase_margin() {
    let gains = GainsSpec::Bandwidth {
        bandwidth_rad_s: 0.5,
        damping: 0.7,
    };
    let mut spec = off(quaternion(gains));
    spec.errors.initial_attitude_3_sigma_rad = Some(1e-3);
    let end = |spec: &SimulationSpec| simulated(spec, 60.0).end.attitude_rad;
    let begin = simulated(&spec, 60.0).states[0].error.attitude_rad;
    assert!(end(&spec) < 1e-6 * begin);
    // The phase margin of 65 degrees is used up by 1.6 s.
    spec.delay_samples = Some(30);
    assert!(end(&spec) > begin, "{:e}", end(&spec));
}

/// Error at the end under a constant torque about x.
fn pushed(controller: ControllerSpec) -> TrackingError {
    let spec = SimulationSpec {
        controller,
        errors: ErrorsSpec {
            disturbance_torque_nm: Some([1e-4, 0.0, 0.0]),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    };
    simulated(&spec, 1000.0).end
}

#[test]
fn the_integral_term_removes_the_offset_of_a_constant_torque() {
    // J w_n^2 times the offset is the torque.
    let inverse = calm_scenario()
        .spacecraft()
        .inertia()
        .try_inverse()
        .unwrap();
    let expected = (inverse.column(0) * (1e-4 / 0.01)).norm();
    for controller in [quaternion(BANDWIDTH), pid(0.0)] {
        let left = pushed(controller).attitude_rad;
        assert!(
            (left - expected).abs() < 0.02 * expected,
            "{left} {expected}"
        );
    }
    let left = pushed(pid(0.02)).attitude_rad;
    assert!(left < 1e-3 * expected, "{left:e} of {expected:e}");
}

#[test]
fn compensating_the_gyroscopic_torque_keeps_a_step_input_on_the_eigenaxis() {
    // The momentum of spinning wheels turns with the body: without the term the path leaves the eigenaxis.
    let mut spec = super::build::spec();
    spec.targets[0] = TargetSpec {
        id: "turned".to_owned(),
        attitude: AttitudeSpec::RollPitchYawDeg([0.0, 0.0, 30.0]),
        ..TargetSpec::default()
    };
    let scenario = crate::model::scenario::Scenario::try_new(&spec)
        .unwrap()
        .scenario;
    let flight = lively();
    let peak = |gyroscopic| {
        let spec = SimulationSpec {
            controller: ControllerSpec::StepInput {
                gains: BANDWIDTH,
                gyroscopic,
            },
            settle_s: None,
            ..SimulationSpec::default()
        };
        let simulated = simulation(&scenario, &flight, &spec)
            .simulate(0, Some(1), &|| false)
            .expect("not stopped");
        let first = simulated.states[0].attitude;
        let axis = |state: &super::super::SimulatedState| {
            first.signed_turn_to(&state.attitude).try_normalize(1e-3)
        };
        let axes: Vec<_> = simulated.states.iter().filter_map(axis).collect();
        axes.iter()
            .map(|axis| axis.angle(&axes[0]))
            .fold(0.0, f64::max)
    };
    let (with, without) = (peak(true), peak(false));
    assert!(with < 0.2 * without, "{with} against {without}");
}

#[test]
fn feedback_follows_the_plan_without_disturbing_it() {
    let (scenario, flight) = (scenario(), lively());
    for controller in [quaternion(BANDWIDTH), pid(0.02)] {
        let spec = SimulationSpec {
            controller,
            ..SimulationSpec::default()
        };
        let simulated = simulation(&scenario, &flight, &spec)
            .simulate(0, None, &|| false)
            .expect("not stopped");
        assert!(simulated.end.attitude_rad < 1.5e-4, "{simulated:?}");
        assert!(simulated.peak.attitude_rad < 3e-4, "{simulated:?}");
    }
}
