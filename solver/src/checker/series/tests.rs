//! Every polynomial of an expansion is tested against the equations of motion.

use super::super::dynamics::Body;
use super::*;
use crate::model::spacecraft::Wheel;
use nalgebra::Matrix3;

const TORQUE: [f64; 3] = [0.01, -0.02, 0.005];

fn body() -> Body {
    let wheel = |axis: Vector3<f64>| Wheel {
        axis,
        inertia: 2e-3,
        min_torque: -0.05,
        max_torque: 0.05,
        max_speed: 400.0,
        enabled: true,
    };
    let inertia = Matrix3::new(4.0, 0.2, 0.0, 0.2, 5.0, -0.1, 0.0, -0.1, 6.0);
    let wheels = [Vector3::x(), Vector3::y(), Vector3::z()].map(wheel);
    Body::new(&inertia, &wheels).expect("a body")
}

fn expansion(body: &Body) -> Expansion {
    let state = Snapshot {
        time_s: 0.0,
        quaternion: [0.1, -0.3, 0.2, (1.0_f64 - 0.14).sqrt()],
        rate: Vector3::new(0.02, -0.05, 0.03),
        wheel_speed: vec![50.0, -80.0, 20.0],
    };
    Expansion::about(body, &state, &TORQUE, &[])
}

/// Name and change of a coefficient.
type Damage = (&'static str, fn(&mut Expansion));

#[test]
fn a_changed_coefficient_of_any_polynomial_raises_the_defect() {
    let body = body();
    let sound = expansion(&body);
    let s = 0.5 * sound.step_length(1e-15);
    assert!(sound.defect(&body, &TORQUE, s) < 1e-13);
    let damages: [Damage; 7] = [
        ("quaternion", |e| e.quaternion[1][2] += 1e-6),
        ("rate x", |e| e.rate[1].x += 1e-6),
        ("rate z", |e| e.rate[2].z -= 1e-6),
        ("wheel 0", |e| e.wheel[0][1] *= 1.0 + 1e-5),
        ("wheel 1", |e| e.wheel[1][1] *= 1.0 - 1e-5),
        ("wheel 2", |e| e.wheel[2][2] += 1e-4),
        ("no number", |e| e.rate[3].y = f64::NAN),
    ];
    for (what, damage) in damages {
        let mut bad = sound.clone();
        damage(&mut bad);
        let defect = bad.defect(&body, &TORQUE, s);
        assert!(defect > 1e-9, "{what}: {defect}");
    }
}

#[test]
fn the_step_length_scales_with_the_unit_of_time() {
    let mut size = [0.0; LEN];
    for (k, term) in size.iter_mut().enumerate() {
        *term = 0.4_f64.powi(i32::try_from(k).expect("few terms"));
    }
    let usual = longest(&size, 1e-12);
    let scaled = longest(&size.map(|term| 1e5 * term), 1e-12);
    assert!((scaled - usual).abs() < 1e-9 * usual, "{scaled} {usual}");
    // Each term is 0.4 t of the one before.
    let last = (1e-12_f64.ln() / (LEN - TAIL) as f64).exp() / 0.4;
    assert!(usual >= last * (1.0 - 1e-9), "{usual} {last}");
}
