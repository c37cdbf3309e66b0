//! The spacecraft of the sources.

use crate::model::drive::{DriveSpec, MotorSpec, SpeedLawSpec};
use crate::model::spec::{
    Applies, AttitudeSpec, BoresightSpec, ConeSpec, SpacecraftSpec, StateSpec, WheelSpec,
};
use crate::run::stop::StopSignal;
use crate::slew::{Slew, SlewOutcome, SlewSpec, solve};

pub(super) fn wheel(axis: [f64; 3], inertia: f64, torque: f64, speed: Option<f64>) -> WheelSpec {
    WheelSpec {
        axis,
        normalize_axis: false,
        inertia_kg_m2: inertia,
        max_torque_nm: torque,
        min_torque_nm: None,
        max_speed_rad_s: speed,
        enabled: true,
    }
}

pub(super) fn camera(axis: [f64; 3]) -> BoresightSpec {
    BoresightSpec {
        name: "camera".into(),
        axis,
    }
}

/// An enforced cone of the camera.
pub(super) fn cone(direction: [f64; 3], half_angle_deg: f64) -> ConeSpec {
    ConeSpec {
        boresight: "camera".into(),
        direction: direction.into(),
        half_angle_deg,
        applies: Applies::Always,
    }
}

pub(super) fn diagonal(moments: [f64; 3]) -> [[f64; 3]; 3] {
    let [x, y, z] = moments;
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// A turn about an axis of any length by an angle, rad.
pub(super) fn turn(axis: [f64; 3], angle: f64) -> StateSpec {
    let norm = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|a| a / norm * (0.5 * angle).sin());
    StateSpec {
        attitude: AttitudeSpec::Quaternion([x, y, z, (0.5 * angle).cos()]),
        ..StateSpec::default()
    }
}

/// Solves a slew and panics unless it is solved.
pub(super) fn solved(spec: &SlewSpec) -> SlewOutcome {
    let slew = Slew::try_new(spec).expect("a valid slew").slew;
    let outcome = solve(&slew, &StopSignal::new());
    println!(
        "{:?} {:?}: {} {:?} time {:.4} effort {:.5} proxy {:.4} bill {:.4} continuous {:?} | att {:.2e} rate {:.2e} torque {:.1e} speed {:.1e} rate {:.1e} | {} starts {} iterations",
        spec.objective,
        spec.command,
        outcome.status,
        outcome.propagated.failures,
        outcome.time_s,
        outcome.effort,
        outcome.propagated.energies.proxy_j,
        outcome.propagated.energies.bill_j,
        outcome.continuous_time_s,
        outcome.propagated.attitude_error_rad,
        outcome.propagated.rate_error_rad_s,
        outcome.propagated.torque_excess,
        outcome.propagated.wheel_speed_excess,
        outcome.propagated.rate_excess,
        outcome.starts,
        outcome.iterations,
    );
    assert!(
        outcome.solved,
        "{} {:?}",
        outcome.status, outcome.propagated.failures
    );
    outcome
}

/// OLRAC's spacecraft with the first `wheels` of its wheels.
pub(super) fn olrac(wheels: usize) -> SpacecraftSpec {
    let axes = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.5, 0.5],
        [-0.5, 0.5, -0.5],
    ];
    SpacecraftSpec {
        inertia_kg_m2: diagonal([86.215, 85.070, 133.565]),
        wheels: axes[..wheels]
            .iter()
            .map(|axis| wheel(*axis, 0.05, 0.55, None))
            .collect(),
        ..SpacecraftSpec::default()
    }
}

/// The RW/CMG thesis's pyramid of four wheels, 1 N m s and 85.7 mN m each.
pub(super) fn pyramid() -> SpacecraftSpec {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    SpacecraftSpec {
        inertia_kg_m2: diagonal([25.4; 3]),
        wheels: [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]]
            .map(|axis| wheel(axis, 1.0 / 314.159, 0.0857, Some(314.159)))
            .to_vec(),
        ..SpacecraftSpec::default()
    }
}

/// The pyramid's turn by 120 degrees about the axis of the first wheel.
pub(super) fn pyramid_end() -> StateSpec {
    turn(pyramid().wheels[0].axis, 120_f64.to_radians())
}

/// The axis of OLRAC's slew.
pub(super) const OLRAC_AXIS: [f64; 3] = [0.4896, 0.2032, 0.8480];

/// The energy thesis's spacecraft.
pub(super) fn lro() -> SpacecraftSpec {
    let (x, y) = (0.81915, 0.40558);
    let rpm = std::f64::consts::PI / 30.0;
    let rate = Some(0.13_f64.to_radians());
    SpacecraftSpec {
        inertia_kg_m2: diagonal([955.2, 1687.4, 1609.5]),
        max_body_rate_rad_s: [rate; 3],
        wheels: [[x, y, y], [x, y, -y], [x, -y, y], [x, -y, -y]]
            .map(|axis| wheel(axis, 0.231, 0.2, Some(1000.0 * rpm)))
            .to_vec(),
        ..SpacecraftSpec::default()
    }
}

/// The drives of the energy thesis's spacecraft.
pub(super) fn lro_drives() -> Vec<DriveSpec> {
    let drive = DriveSpec {
        viscous_friction_nms: Some(2.15e-5),
        motor: Some(MotorSpec {
            resistance_ohm: 0.343,
            torque_constant_nm_a: 0.0705,
            efficiency: None,
            quiescent_power_w: None,
        }),
        ..DriveSpec::default()
    };
    vec![drive; 4]
}

/// The end of the energy thesis's slew.
pub(super) fn lro_end() -> StateSpec {
    StateSpec {
        attitude: AttitudeSpec::Quaternion([-0.8026, 0.1498, -0.2264, 0.5312]),
        wheel_speed_rad_s: Some(vec![0.0; 4]),
        ..StateSpec::default()
    }
}

/// BIROS with its three high-torque wheels, and with the pyramid of four small ones under a speed law
/// if asked for.
pub(super) fn biros(pyramid: bool) -> (SpacecraftSpec, Vec<DriveSpec>, StateSpec) {
    let rpm = std::f64::consts::PI / 30.0;
    let high = |axis| wheel(axis, 5e-3, 0.21, Some(1825.0 * rpm));
    let mut wheels = vec![
        high([1.0, 0.0, 0.0]),
        high([0.0, 1.0, 0.0]),
        high([0.0, 0.0, 1.0]),
    ];
    let friction = DriveSpec {
        viscous_friction_nms: Some(5e-6),
        coulomb_friction_nm: Some(5e-4),
        ..DriveSpec::default()
    };
    let mut drives = Vec::new();
    let mut speeds = vec![0.0; 3];
    if pyramid {
        let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
        let axes = [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]];
        wheels.extend(axes.map(|axis| wheel(axis, 4.2e-4, 0.021, Some(7800.0 * rpm))));
        drives = vec![friction.clone(); 3];
        let held = DriveSpec {
            speed_law: Some(SpeedLawSpec {
                rate_per_s: 1e-4,
                speed_rad_s: -200.0,
            }),
            ..friction
        };
        drives.extend(vec![held; 4]);
        speeds.extend([-200.0; 4]);
    }
    let spacecraft = SpacecraftSpec {
        inertia_kg_m2: diagonal([9.0, 6.0, 9.0]),
        wheels,
        ..SpacecraftSpec::default()
    };
    let start = StateSpec {
        wheel_speed_rad_s: Some(speeds),
        ..StateSpec::default()
    };
    (spacecraft, drives, start)
}

/// The end of BIROS's slew.
pub(super) fn biros_end() -> StateSpec {
    StateSpec {
        attitude: AttitudeSpec::Matrix([
            [0.8627, 0.4981, -0.0872],
            [-0.5, 0.8660, 0.0],
            [0.0755, 0.0436, 0.9962],
        ]),
        ..StateSpec::default()
    }
}
