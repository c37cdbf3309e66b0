//! The true spacecraft: convergence of the integration, conservation, drives and their limits.

use super::super::draws::draw;
use super::super::truth::{IntegratorScratch, TrueState};
use super::super::{ControllerSpec, ErrorsSpec, FeedForwardMode, GainsSpec, SimulationSpec};
use super::build::{
    BANDWIDTH, MAX_TORQUE, calm_scenario, idle, lively, quaternion, scenario, simulation,
};
use crate::model::attitude::Attitude;
use crate::model::drive::{DriveSpec, SpeedLawSpec};
use nalgebra::Vector3;

fn open(feed_forward: FeedForwardMode) -> SimulationSpec {
    SimulationSpec {
        controller: ControllerSpec::FeedForward,
        feed_forward: Some(feed_forward),
        ..SimulationSpec::default()
    }
}

#[test]
fn without_errors_the_simulated_motion_is_the_plan() {
    let (scenario, flight) = (scenario(), lively());
    let simulated = simulation(&scenario, &flight, &open(FeedForwardMode::TimeTagged))
        .simulate(0, None, &|| false)
        .expect("not stopped");
    assert!(simulated.end.attitude_rad < 1e-9, "{simulated:?}");
    assert!(simulated.end.rate_rad_s < 1e-10, "{simulated:?}");
    assert!(
        simulated.passages[0].error.attitude_rad < 1e-9,
        "{simulated:?}"
    );
    assert!(simulated.peak.attitude_rad < 1e-9, "{simulated:?}");
    assert_eq!(simulated.plan_end, simulated.end);
    let idle = |share: f64| share.abs() <= 0.0;
    let wheels = &simulated.saturation;
    assert!(wheels.iter().all(|s| idle(s.torque) && idle(s.speed)));
}

#[test]
fn the_integration_error_falls_with_the_fourth_power_of_the_step() {
    let (scenario, flight) = (scenario(), lively());
    let error = |max_step_s| {
        let spec = SimulationSpec {
            on_board_rate_hz: Some(0.5),
            wheel_loop_rate_hz: Some(0.5),
            max_step_s: Some(max_step_s),
            ..open(FeedForwardMode::TimeTagged)
        };
        let simulated = simulation(&scenario, &flight, &spec)
            .simulate(0, None, &|| false)
            .expect("not stopped");
        simulated.end.attitude_rad
    };
    let (coarse, fine) = (error(0.5), error(0.25));
    assert!(coarse > 1e-9, "{coarse:e} is too small to tell");
    let ratio = coarse / fine;
    assert!((11.0..22.0).contains(&ratio), "{coarse:e} to {fine:e}");
}

#[test]
fn averaged_feed_forward_keeps_the_rate_and_almost_the_attitude() {
    let (scenario, flight) = (scenario(), lively());
    let simulated = simulation(&scenario, &flight, &open(FeedForwardMode::Averaged))
        .simulate(0, None, &|| false)
        .expect("not stopped");
    // Largest change of acceleration 0.04 rad/s2, an eighth of its product with 0.1 s squared at a
    // switch, and three switches.
    assert!(simulated.end.attitude_rad < 1.5e-4, "{simulated:?}");
    assert!(simulated.end.attitude_rad > 1e-8, "{simulated:?}");
    assert!(simulated.end.rate_rad_s < 1e-4, "{simulated:?}");
}

/// Change of the momentum in the reference frame, N m s, of a spacecraft with every error, and the angle
/// by which the body turns, rad.
fn momentum_change(disturbance: Vector3<f64>, seconds: f64) -> (Vector3<f64>, f64) {
    let (scenario, flight) = (scenario(), idle(1.0));
    let spec = SimulationSpec {
        drives: vec![rubbing(true); 5],
        errors: ErrorsSpec {
            inertia_3_sigma: Some(0.1),
            alignment_3_sigma_rad: Some(0.05),
            friction_3_sigma: Some(0.5),
            initial_attitude_3_sigma_rad: Some(0.3),
            disturbance_torque_nm: Some(disturbance.into()),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    };
    let simulation = simulation(&scenario, &flight, &spec);
    let drawn = draw(&scenario, &simulation.settings, &simulation.nominal, 3);
    let mut state = drawn.start;
    let mut scratch = IntegratorScratch::new(&state);
    let attitude = |state: &TrueState| {
        let q = state.attitude;
        Attitude::from_xyzw([q.i, q.j, q.k, q.w]).unwrap()
    };
    let (begin, truth) = (state.clone(), &drawn.truth);
    let motor = [0.03, -0.02, 0.04, 0.01, 0.0];
    truth.advance(&mut state, &motor, seconds / 1000.0, 1000, &mut scratch);
    let momentum = |state: &TrueState| attitude(state).to_reference(truth.body_momentum(state));
    let turn = attitude(&begin).angle_to(&attitude(&state));
    (momentum(&state) - momentum(&begin), turn)
}

#[test]
fn momentum_changes_by_external_torques_only() {
    let (change, turn) = momentum_change(Vector3::zeros(), 10.0);
    assert!(change.norm() < 1e-10, "{change}");
    assert!(turn > 0.2, "{turn}");
    let torque = Vector3::new(1e-3, -2e-3, 5e-4);
    // The initial attitude has an error, so that only the size of the change is known.
    let (change, turn) = momentum_change(torque, 0.1);
    assert!(turn < 1e-3, "{turn}");
    let expected = 0.1 * torque.norm();
    assert!(
        (change.norm() - expected).abs() < 0.01 * expected,
        "{change}"
    );
}

fn rubbing(friction_compensated: bool) -> DriveSpec {
    DriveSpec {
        viscous_friction_nms: Some(2e-5),
        coulomb_friction_nm: Some(1e-3),
        friction_compensated: Some(friction_compensated),
        ..DriveSpec::default()
    }
}

#[test]
fn the_wheel_loop_compensates_friction() {
    let (scenario, mut flight) = (scenario(), lively());
    // The motors need some of their torque for friction.
    for control in &mut flight.controls {
        for torque in &mut control.wheel_torque_nm {
            *torque *= 0.5;
        }
    }
    let error = |compensated| {
        let spec = SimulationSpec {
            drives: vec![rubbing(compensated); 5],
            ..open(FeedForwardMode::TimeTagged)
        };
        simulation(&scenario, &flight, &spec)
            .simulate(0, None, &|| false)
            .expect("not stopped")
            .end
            .attitude_rad
    };
    let (with, without) = (error(true), error(false));
    assert!(without > 0.01, "{without:e}");
    assert!(with < 0.01 * without, "{with:e} against {without:e}");
}

#[test]
fn a_wheel_with_a_speed_law_reaches_its_speed() {
    let (scenario, flight) = (calm_scenario(), idle(200.0));
    let mut drives = vec![DriveSpec::default(); 5];
    drives[3].speed_law = Some(SpeedLawSpec {
        rate_per_s: 0.05,
        speed_rad_s: 25.0,
    });
    let spec = SimulationSpec {
        drives,
        controller: quaternion(BANDWIDTH),
        ..SimulationSpec::default()
    };
    let simulated = simulation(&scenario, &flight, &spec)
        .simulate(0, Some(1), &|| false)
        .expect("not stopped");
    let last = simulated.states.last().unwrap();
    assert!((last.wheel_speed_rad_s[3] - 25.0).abs() < 0.01, "{last:?}");
    // Feedback has the other wheels take up its momentum.
    assert!(simulated.end.attitude_rad < 1e-4, "{simulated:?}");
    assert!(last.wheel_torque_nm[3].abs() <= 0.0);
}

#[test]
fn drives_keep_the_limits_of_torque_and_speed() {
    let scenario = calm_scenario();
    let mut flight = lively();
    // Twice the greatest torque, until the speed limit is reached.
    for control in &mut flight.controls {
        control.wheel_torque_nm = vec![2.0 * MAX_TORQUE, 0.0, 0.0, 0.0, 0.0];
    }
    let simulated = simulation(&scenario, &flight, &open(FeedForwardMode::Averaged))
        .simulate(0, Some(1), &|| false)
        .expect("not stopped");
    let speeds = simulated
        .states
        .iter()
        .map(|state| state.wheel_speed_rad_s[0]);
    let fastest = speeds.fold(0.0, f64::max);
    assert!((fastest - 400.0).abs() < 1e-2, "{fastest}");
    // The limit is reached after 400 * 2e-3 / 0.05 = 16 of 20 s.
    let [first, second, ..] = simulated.saturation[..] else {
        panic!("{simulated:?}")
    };
    assert!((first.speed - 0.2).abs() < 2e-3, "{first:?}");
    assert!(first.torque > 0.99, "{first:?}");
    assert!(second.torque.abs() <= 0.0 && second.speed.abs() <= 0.0);
}

#[test]
fn kept_states_show_which_limits_are_reached_before_the_next() {
    let (scenario, flight) = (scenario(), lively());
    let calm = simulation(&scenario, &flight, &open(FeedForwardMode::TimeTagged));
    let simulated = calm.simulate(0, Some(1), &|| false).expect("not stopped");
    assert_eq!(simulated.states.len(), calm.samples());
    let met = |flags: &[bool]| flags.contains(&true);
    assert!(
        !simulated
            .states
            .iter()
            .any(|s| met(&s.torque_limited) || met(&s.speed_limited))
    );
    // Much too high a gain for the wheels.
    let stiff = SimulationSpec {
        controller: quaternion(GainsSpec::Given {
            attitude_per_s2: 50.0,
            rate_per_s: 50.0,
        }),
        errors: ErrorsSpec {
            initial_attitude_3_sigma_rad: Some(0.3),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    };
    let stiff = simulation(&scenario, &flight, &stiff);
    let (all, few) = (
        stiff.simulate(0, Some(1), &|| false).expect("not stopped"),
        stiff.simulate(0, Some(10), &|| false).expect("not stopped"),
    );
    for (wheel, share) in all.saturation.iter().enumerate() {
        let limited = all
            .states
            .iter()
            .filter(|s| s.torque_limited[wheel])
            .count();
        assert!(limited as f64 >= share.torque * all.states.len() as f64 - 1e-9);
        assert_eq!(limited > 0, share.torque > 0.0);
        for (chunk, kept) in all.states.chunks(10).zip(&few.states) {
            let any = chunk.iter().any(|s| s.torque_limited[wheel]);
            assert_eq!(any, kept.torque_limited[wheel]);
        }
    }
    assert!(all.states.iter().any(|s| met(&s.torque_limited)));
}
