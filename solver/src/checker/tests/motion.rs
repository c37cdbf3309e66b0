//! The integrated motion against closed forms and against a second method.

use super::super::dynamics::{
    Body, QuaternionComponents, Snapshot, conjugate, norm, product, quaternion_derivative,
    to_reference,
};
use super::super::integrator::{Integration, STEP_TOLERANCE, TorqueSpan, integrate};
use super::super::series::{Expansion, ORDER};
use crate::model::spacecraft::Wheel;
use nalgebra::{Matrix3, Vector3};

fn wheel(axis: [f64; 3], inertia: f64, enabled: bool) -> Wheel {
    Wheel {
        axis: Vector3::from(axis),
        inertia,
        min_torque: -1.0,
        max_torque: 1.0,
        max_speed: f64::INFINITY,
        enabled,
    }
}

/// Four wheels, one of them with an axis that is not of unit length, one of them locked.
fn busy_body() -> Body {
    let inertia = Matrix3::new(6.63, 0.3, -0.2, 0.3, 8.9, 0.1, -0.2, 0.1, 9.63);
    let wheels = [
        wheel([0.577, 0.577, 0.577], 0.002, true),
        wheel([-0.7, 0.7, 0.4], 0.003, true),
        wheel([0.0, 1.0, 0.0], 0.0025, false),
        wheel([0.5, -0.5, 0.7], 0.002, true),
    ];
    Body::new(&inertia, &wheels).unwrap()
}

fn busy_start() -> Snapshot {
    Snapshot {
        time_s: 0.0,
        quaternion: [0.1, -0.5, 0.5, 0.7].map(|c: f64| c),
        rate: Vector3::new(0.01, -0.03, 0.02),
        wheel_speed: vec![200.0, -150.0, 90.0, 300.0],
    }
}

fn turn_between(a: &QuaternionComponents, b: &QuaternionComponents) -> f64 {
    let turn = product(&conjugate(a), b);
    2.0 * norm(&[turn[0], turn[1], turn[2], 0.0]).atan2(turn[3])
}

/// Integrates and returns the last state.
fn end_of(body: &Body, start: &Snapshot, intervals: &[TorqueSpan<'_>], tolerance: f64) -> Snapshot {
    let mut last = start.clone();
    integrate(body, start.clone(), intervals, tolerance, |step| {
        last = step.motion.state(*step.grid.last().unwrap());
    })
    .unwrap();
    last
}

fn about(axis: Vector3<f64>, angle: f64) -> QuaternionComponents {
    let v = axis.normalize() * (0.5 * angle).sin();
    [v.x, v.y, v.z, (0.5 * angle).cos()]
}

/// A symmetric body with a locked wheel along its axis precesses about its momentum:
/// `w = H_b / J_t + c e_z` with constant `c`, so that two turns give the attitude.
fn top_error(inertia: f64, seconds: f64) -> f64 {
    let (transverse, axial) = (2.0 * inertia, 3.0 * inertia);
    let body_inertia = Matrix3::from_diagonal(&Vector3::new(transverse, transverse, axial));
    let spun = wheel([0.0, 0.0, 1.0], 1e-3 * inertia, false);
    let body = Body::new(&body_inertia, &[spun]).unwrap();
    let start = Snapshot {
        time_s: 0.0,
        quaternion: about(Vector3::new(1.0, 2.0, -0.5), 1.0),
        rate: Vector3::new(0.03, -0.02, 0.05) * (1000.0 / seconds),
        wheel_speed: vec![80.0 * (1000.0 / seconds)],
    };
    let momentum = body.momentum(&start.rate, &start.wheel_speed);
    let relative_spin = start.rate.z - momentum.z / transverse;
    let reference_momentum = to_reference(&start.quaternion, &momentum);
    let precession = about(reference_momentum, momentum.norm() / transverse * seconds);
    let spin = about(Vector3::z(), relative_spin * seconds);
    let expected = product(&product(&precession, &start.quaternion), &spin);
    let interval = TorqueSpan {
        begin_s: 0.0,
        end_s: seconds,
        torque: &[0.0],
        slope: &[],
    };
    let last = end_of(&body, &start, &[interval], STEP_TOLERANCE);
    // Quaternions of the same attitude may differ in sign.
    let error = turn_between(&last.quaternion, &expected);
    error.min(std::f64::consts::TAU - error)
}

#[test]
fn symmetric_top_keeps_its_closed_form_at_every_scale() {
    for inertia in [0.01, 5.0, 1e5] {
        for seconds in [1e-3, 1.0, 1000.0, 40_000.0] {
            let error = top_error(inertia, seconds);
            assert!(
                error < 1e-11,
                "{error} rad at {inertia} kg m2 over {seconds} s"
            );
        }
    }
}

#[test]
fn a_tighter_tolerance_does_not_change_a_long_tour() {
    let torques = [[0.01, -0.02, 0.0, 0.005], [-0.01, 0.015, 0.0, -0.02]];
    let intervals: Vec<TorqueSpan<'_>> = (0..100)
        .map(|k| TorqueSpan {
            begin_s: 10.0 * f64::from(k),
            end_s: 10.0 * f64::from(k + 1),
            torque: &torques[usize::from(k % 2 == 1)],
            slope: &[],
        })
        .collect();
    let body = busy_body();
    let usual = end_of(&body, &busy_start(), &intervals, STEP_TOLERANCE);
    let tight = end_of(&body, &busy_start(), &intervals, 1e-3 * STEP_TOLERANCE);
    let error = turn_between(&usual.quaternion, &tight.quaternion);
    assert!(error < 1e-11, "{error} rad");
    assert!((usual.rate - tight.rate).norm() < 1e-13);
}

/// One step of the classical Runge-Kutta method on the equations of motion.
fn classical_step(body: &Body, at: &Snapshot, torque: &[f64], h: f64) -> Snapshot {
    let derivative = |state: &Snapshot| {
        let rate = body.rate_derivative(state, torque);
        let wheels: Vec<f64> = (0..torque.len())
            .map(|i| body.wheel_derivative(i, torque[i], state.wheel_speed[i], &rate))
            .collect();
        (
            quaternion_derivative(&state.quaternion, &state.rate),
            rate,
            wheels,
        )
    };
    let moved =
        |state: &Snapshot, d: &(QuaternionComponents, Vector3<f64>, Vec<f64>), h: f64| Snapshot {
            time_s: state.time_s,
            quaternion: std::array::from_fn(|c| state.quaternion[c] + h * d.0[c]),
            rate: state.rate + d.1 * h,
            wheel_speed: state
                .wheel_speed
                .iter()
                .zip(&d.2)
                .map(|(w, d)| w + h * d)
                .collect(),
        };
    let k1 = derivative(at);
    let k2 = derivative(&moved(at, &k1, 0.5 * h));
    let k3 = derivative(&moved(at, &k2, 0.5 * h));
    let k4 = derivative(&moved(at, &k3, h));
    let weights = [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)];
    weights.iter().fold(at.clone(), |sum, (k, weight)| {
        moved(&sum, k, h * weight / 6.0)
    })
}

#[test]
fn the_runge_kutta_method_on_the_equations_of_motion_agrees() {
    let (body, torque) = (busy_body(), [0.01, -0.02, 0.0, 0.015]);
    let mut state = busy_start();
    for _ in 0..40_000 {
        state = classical_step(&body, &state, &torque, 1e-3);
    }
    let interval = TorqueSpan {
        begin_s: 0.0,
        end_s: 40.0,
        torque: &torque,
        slope: &[],
    };
    let last = end_of(&body, &busy_start(), &[interval], STEP_TOLERANCE);
    let turn = turn_between(&last.quaternion, &state.quaternion);
    assert!(turn < 1e-11, "{turn} rad");
    assert!((last.rate - state.rate).norm() < 1e-13);
    for (ours, theirs) in last.wheel_speed.iter().zip(&state.wheel_speed) {
        assert!((ours - theirs).abs() < 1e-9, "{ours} {theirs}");
    }
    assert!(
        (last.wheel_speed[2] - 90.0).abs() == 0.0,
        "a locked wheel keeps its speed"
    );
}

#[test]
fn the_error_of_the_series_falls_with_its_order() {
    let (body, torque) = (busy_body(), [0.01, -0.02, 0.0, 0.015]);
    let series = Expansion::about(&body, &busy_start(), &torque, &[]);
    let error = |s: f64| {
        let interval = TorqueSpan {
            begin_s: 0.0,
            end_s: s,
            torque: &torque,
            slope: &[],
        };
        let exact = end_of(&body, &busy_start(), &[interval], STEP_TOLERANCE);
        (series.state(s).rate - exact.rate).norm()
    };
    let long = 4.0 * series.step_length(STEP_TOLERANCE);
    let order = (error(long) / error(0.5 * long)).log2();
    let expected = (ORDER + 1) as f64;
    assert!((order - expected).abs() < 1.5, "observed order {order}");
}

#[test]
fn momentum_is_conserved_over_a_tour_with_bias() {
    let torque = [0.01, -0.02, 0.0, 0.015];
    let interval = |begin_s: f64, end_s: f64| TorqueSpan {
        begin_s,
        end_s,
        torque: &torque,
        slope: &[],
    };
    let intervals = [interval(0.0, 30.0), interval(30.0, 500.0)];
    let Integration {
        steps,
        momentum_drift,
    } = integrate(
        &busy_body(),
        busy_start(),
        &intervals,
        STEP_TOLERANCE,
        |_| {},
    )
    .unwrap();
    assert!(momentum_drift < 1e-13, "{momentum_drift}");
    assert!(steps > 2);
}

#[test]
fn a_motion_too_fast_to_integrate_gives_a_sentence() {
    let torque = [1e300, 0.0, 0.0, 0.0];
    let absurd = TorqueSpan {
        begin_s: 0.0,
        end_s: 1e9,
        torque: &torque,
        slope: &[],
    };
    let sentence = integrate(
        &busy_body(),
        busy_start(),
        &[absurd],
        STEP_TOLERANCE,
        |_| {},
    )
    .unwrap_err();
    assert!(sentence.starts_with("the integration"), "{sentence}");

    let mut spinning = busy_start();
    spinning.rate *= 1e9;
    let long = TorqueSpan {
        begin_s: 0.0,
        end_s: 1e6,
        torque: &[0.0; 4],
        slope: &[],
    };
    let sentence = integrate(&busy_body(), spinning, &[long], STEP_TOLERANCE, |_| {}).unwrap_err();
    assert!(sentence.contains("ran out of steps"), "{sentence}");
}
