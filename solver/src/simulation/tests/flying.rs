//! The truth: convergence, conservation, drives and their limits.

use super::super::draws::draw;
use super::super::truth::{Scratch, State};
use super::super::{ControllerSpec, ErrorsSpec, FeedForward, GainsSpec, SimulationSpec};
use super::build::{
    BANDWIDTH, MAX_TORQUE, calm_scenario, idle, lively, quaternion, scenario, simulation,
};
use crate::model::attitude::Attitude;
use crate::model::drive::{DriveSpec, SpeedLawSpec};
use nalgebra::Vector3;

fn open(feed_forward: FeedForward) -> SimulationSpec {
    SimulationSpec {
        controller: ControllerSpec::FeedForward,
        feed_forward: Some(feed_forward),
        ..SimulationSpec::default()
    }
}

#[test]
fn without_errors_the_flight_is_the_plan() {
    let (scenario, flight) = (scenario(), lively());
    let flown = simulation(&scenario, &flight, &open(FeedForward::TimeTagged))
        .fly(0, None, &|| false)
        .expect("nobody gives up");
    assert!(flown.end.attitude_rad < 1e-9, "{flown:?}");
    assert!(flown.end.rate_rad_s < 1e-10, "{flown:?}");
    assert!(flown.passages[0].error.attitude_rad < 1e-9, "{flown:?}");
    assert!(flown.peak.attitude_rad < 1e-9, "{flown:?}");
    assert_eq!(flown.plan_end, flown.end);
    let idle = |share: f64| share.abs() <= 0.0;
    let wheels = &flown.saturation;
    assert!(wheels.iter().all(|s| idle(s.torque) && idle(s.speed)));
}

#[test]
fn errors_fall_with_the_fourth_power_of_the_step() {
    let (scenario, flight) = (scenario(), lively());
    let error = |max_step_s| {
        let spec = SimulationSpec {
            on_board_rate_hz: Some(0.5),
            wheel_loop_rate_hz: Some(0.5),
            max_step_s: Some(max_step_s),
            ..open(FeedForward::TimeTagged)
        };
        let flown = simulation(&scenario, &flight, &spec)
            .fly(0, None, &|| false)
            .expect("nobody gives up");
        flown.end.attitude_rad
    };
    let (coarse, fine) = (error(0.5), error(0.25));
    assert!(coarse > 1e-9, "{coarse:e} is too small to tell");
    let ratio = coarse / fine;
    assert!((11.0..22.0).contains(&ratio), "{coarse:e} to {fine:e}");
}

#[test]
fn mean_torques_keep_the_rate_and_nearly_the_attitude() {
    let (scenario, flight) = (scenario(), lively());
    let flown = simulation(&scenario, &flight, &open(FeedForward::Averaged))
        .fly(0, None, &|| false)
        .expect("nobody gives up");
    // Largest change of acceleration 0.04 rad/s2, an eighth of its product with 0.1 s squared at a
    // switch, and three switches.
    assert!(flown.end.attitude_rad < 1.5e-4, "{flown:?}");
    assert!(flown.end.attitude_rad > 1e-8, "{flown:?}");
    assert!(flown.end.rate_rad_s < 1e-4, "{flown:?}");
}

/// How the momentum in the reference frame changes, of a body with every error, and the angle by
/// which the body turns meanwhile.
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
    let mut scratch = Scratch::new(&state);
    let attitude = |state: &State| {
        let q = state.attitude;
        Attitude::from_xyzw([q.i, q.j, q.k, q.w]).unwrap()
    };
    let (begin, truth) = (state.clone(), &drawn.truth);
    let motor = [0.03, -0.02, 0.04, 0.01, 0.0];
    truth.advance(&mut state, &motor, (seconds / 1000.0, 1000), &mut scratch);
    let momentum = |state: &State| attitude(state).to_reference(truth.body_momentum(state));
    let turn = attitude(&begin).angle_to(&attitude(&state));
    (momentum(&state) - momentum(&begin), turn)
}

#[test]
fn momentum_is_conserved_but_for_external_torques() {
    let (change, turn) = momentum_change(Vector3::zeros(), 10.0);
    assert!(change.norm() < 1e-10, "{change}");
    assert!(turn > 0.2, "{turn}");
    let torque = Vector3::new(1e-3, -2e-3, 5e-4);
    // The body hardly turns away from its start, which is turned itself: only the size is known.
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
fn the_wheel_loop_takes_friction_away() {
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
            ..open(FeedForward::TimeTagged)
        };
        simulation(&scenario, &flight, &spec)
            .fly(0, None, &|| false)
            .expect("nobody gives up")
            .end
            .attitude_rad
    };
    let (with, without) = (error(true), error(false));
    assert!(without > 0.01, "{without:e}");
    assert!(with < 0.01 * without, "{with:e} against {without:e}");
}

#[test]
fn a_wheel_with_a_law_comes_to_its_speed() {
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
    let flown = simulation(&scenario, &flight, &spec)
        .fly(0, Some(1), &|| false)
        .expect("nobody gives up");
    let last = flown.states.last().unwrap();
    assert!((last.wheel_speed_rad_s[3] - 25.0).abs() < 0.01, "{last:?}");
    // The others take up its momentum, without a command for it.
    assert!(flown.end.attitude_rad < 1e-4, "{flown:?}");
    assert!(last.wheel_torque_nm[3].abs() <= 0.0);
}

#[test]
fn drives_stay_within_torque_and_speed() {
    let scenario = calm_scenario();
    let mut flight = lively();
    // Twice the torque, and for long.
    for control in &mut flight.controls {
        control.wheel_torque_nm = vec![2.0 * MAX_TORQUE, 0.0, 0.0, 0.0, 0.0];
    }
    let flown = simulation(&scenario, &flight, &open(FeedForward::Averaged))
        .fly(0, Some(1), &|| false)
        .expect("nobody gives up");
    let speeds = flown.states.iter().map(|state| state.wheel_speed_rad_s[0]);
    let fastest = speeds.fold(0.0, f64::max);
    assert!((fastest - 400.0).abs() < 1e-2, "{fastest}");
    // The limit is reached after 400 * 2e-3 / 0.05 = 16 of 20 s.
    let [first, second, ..] = flown.saturation[..] else {
        panic!("{flown:?}")
    };
    assert!((first.speed - 0.2).abs() < 2e-3, "{first:?}");
    assert!(first.torque > 0.99, "{first:?}");
    assert!(second.torque.abs() <= 0.0 && second.speed.abs() <= 0.0);
}

#[test]
fn kept_states_tell_which_limits_are_met_until_the_next() {
    let (scenario, flight) = (scenario(), lively());
    let calm = simulation(&scenario, &flight, &open(FeedForward::TimeTagged));
    let flown = calm.fly(0, Some(1), &|| false).expect("nobody gives up");
    assert_eq!(flown.states.len(), calm.samples());
    let met = |flags: &[bool]| flags.contains(&true);
    assert!(
        !flown
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
        stiff.fly(0, Some(1), &|| false).expect("nobody gives up"),
        stiff.fly(0, Some(10), &|| false).expect("nobody gives up"),
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
