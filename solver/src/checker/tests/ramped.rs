//! Linear torques and wheels under speed laws against the classical Runge-Kutta method.

use super::build::scenario;
use crate::checker::ramped::{TorqueRamp, propagate_ramps};
use crate::model::drive::{Drive, SpeedLaw};
use crate::model::scenario::Scenario;
use nalgebra::{Matrix3, Vector3};

/// Torques at beginning and end of the ramp, N m, and its length, s.
const BEGIN: [f64; 2] = [0.015, -0.01];
const END: [f64; 2] = [-0.02, 0.018];
const LENGTH: f64 = 30.0;

/// Body rate and wheel speeds by the equations of motion: wheels x and y are driven, z follows a speed law.
fn reference(rate: Vector3<f64>, speeds: [f64; 3], law: (f64, f64)) -> (Vector3<f64>, [f64; 3]) {
    let spin = super::build::SPIN_INERTIA;
    let inertia = Vector3::new(4.0, 5.0, 6.0);
    let effective = Matrix3::from_diagonal(&(inertia - Vector3::new(spin, spin, 0.0)));
    let inverse = effective.try_inverse().expect("an inverse");
    let slope = |t: f64, (w, s): (Vector3<f64>, [f64; 3])| {
        let u = [0, 1].map(|i| BEGIN[i] + (END[i] - BEGIN[i]) * t / LENGTH);
        let returns = -law.0 * (s[2] - law.1);
        let momentum = inertia.component_mul(&w) + Vector3::from(s) * spin;
        let push = Vector3::new(u[0], u[1], spin * returns);
        let w_slope = inverse * (-w.cross(&momentum) - push);
        (
            w_slope,
            [u[0] / spin - w_slope.x, u[1] / spin - w_slope.y, returns],
        )
    };
    let add = |(w, s): (Vector3<f64>, [f64; 3]), h: f64, (dw, ds): (Vector3<f64>, [f64; 3])| {
        (w + dw * h, [0, 1, 2].map(|i| s[i] + ds[i] * h))
    };
    let (steps, mut state) = (6000, (rate, speeds));
    let h = LENGTH / f64::from(steps);
    for step in 0..steps {
        let t = h * f64::from(step);
        let a = slope(t, state);
        let b = slope(t + h / 2.0, add(state, h / 2.0, a));
        let c = slope(t + h / 2.0, add(state, h / 2.0, b));
        let d = slope(t + h, add(state, h, c));
        for (weight, k) in [(1.0, a), (2.0, b), (2.0, c), (1.0, d)] {
            state = add(state, h * weight / 6.0, k);
        }
    }
    state
}

#[test]
fn ramps_and_speed_laws_agree_with_the_equations_of_motion() {
    let mut spec = scenario(Vec::new());
    spec.spacecraft
        .wheels
        .push(spec.spacecraft.wheels[2].clone());
    spec.spacecraft.wheels[2].enabled = false;
    spec.start.body_rate_rad_s = Some([0.02, -0.01, 0.03]);
    spec.start.wheel_speed_rad_s = Some(vec![50.0, -80.0, 120.0, 0.0]);
    spec.end = Some(crate::model::spec::StateSpec::default());
    // The fourth wheel makes the axes of driven wheels span space; it has no torque and little inertia.
    spec.spacecraft.wheels[3].inertia_kg_m2 = 1e-12;
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let mut drives = vec![Drive::IDEAL; 4];
    let law = (0.04, -30.0);
    drives[2].speed_law = Some(SpeedLaw {
        rate: law.0,
        speed: law.1,
    });
    let ramp = |from: f64, to: f64| {
        let at = |t: f64| {
            let u = |i: usize| BEGIN[i] + (END[i] - BEGIN[i]) * t / LENGTH;
            vec![u(0), u(1), 0.0, 0.0]
        };
        TorqueRamp {
            start_s: from,
            duration_s: to - from,
            begin_nm: at(from),
            end_nm: at(to),
        }
    };
    let ramps = [ramp(0.0, 11.0), ramp(11.0, LENGTH)];
    let mut impulse = 0.0;
    let flight = propagate_ramps(&scenario, &drives, &ramps, |part| {
        let ends = part.torque(0, 0.0) + part.torque(0, part.length_s);
        impulse += 0.5 * part.length_s * ends;
    })
    .expect("a flight");
    let times: Vec<_> = flight.states.iter().map(|state| state.time_s).collect();
    assert_eq!(times, [0.0, 11.0, LENGTH]);
    let end = flight.states.last().expect("an end");
    let start = Vector3::new(0.02, -0.01, 0.03);
    let (rate, speeds) = reference(start, [50.0, -80.0, 120.0], law);
    assert!(
        (end.body_rate_rad_s - rate).norm() < 1e-9,
        "{} {rate}",
        end.body_rate_rad_s
    );
    for (speed, wanted) in end.wheel_speed_rad_s.iter().zip(speeds) {
        assert!((speed - wanted).abs() < 1e-6, "{speed} {wanted}");
    }
    assert!((impulse - 0.5 * (BEGIN[0] + END[0]) * LENGTH).abs() < 1e-12);
    assert!(flight.momentum_drift < 1e-12);
    assert!(
        (flight.torque_usage - 1.0).abs() < 1e-12,
        "{}",
        flight.torque_usage
    );
}
