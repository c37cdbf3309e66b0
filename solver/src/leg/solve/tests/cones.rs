//! Legs around cones.

use super::*;
use crate::leg::solve::around_cones::path_of;
use crate::model::cone::ForbiddenCone;

fn cone(direction: [f64; 3], half_angle_deg: f64) -> ForbiddenCone {
    ForbiddenCone {
        axis: Vector3::x(),
        direction: Vector3::from(direction).normalize(),
        half_angle: half_angle_deg.to_radians(),
    }
}

/// The leg from the identity attitude to another, its duration, s, and its depth inside cones, rad.
fn around(
    change: impl FnOnce(&mut ScenarioSpec),
    to: Vector3<f64>,
    cones: &[ForbiddenCone],
) -> [f64; 2] {
    let dynamics = dynamics(change).with_cones(cones.to_vec());
    let (from, to) = (
        at_rest(Attitude::identity()),
        at_rest(Attitude::from_rotation_vector(to)),
    );
    let null = &DVector::zeros(dynamics.wheel_count() - 3);
    let leg = LegProblem {
        dynamics: &dynamics,
        from: &from,
        to: &to,
        arrival: Arrival::Rotation,
        null,
        extremals: &KinematicExtremals::of(&dynamics),
        resolution: Resolution::of(Accuracy::Standard, &dynamics),
    };
    let outcome = solve(&leg, None, &|| None);
    let duration = outcome.solution.duration().expect("the leg converges");
    [
        duration,
        path_of(&dynamics, &outcome.solution.profile).depth(cones),
    ]
}

/// `CasADi` with IPOPT, best of twelve starts, 115.187 s; without the cone 113.39 s.
#[test]
fn a_camera_passes_a_bright_body() {
    let quarter = Vector3::z() * std::f64::consts::FRAC_PI_2;
    let bright = cone([1.0, 1.0, 0.0707], 25.0);
    let free = around(|_| {}, quarter, &[cone([-1.0, 0.0, 0.0], 25.0)]);
    assert!((free[0] - 113.39).abs() < 0.02, "{free:?}");
    let [duration, depth] = around(|_| {}, quarter, &[bright]);
    assert!(depth <= 1e-6, "{depth}");
    assert!(duration < 115.19 * 1.0005, "{duration}");
}
