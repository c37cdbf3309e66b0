//! Warnings about numbers that no spacecraft has: most of them are a slip of the unit.

use super::Start;
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spacecraft::{Spacecraft, Wheel};
use crate::model::spec::ScenarioSpec;
use nalgebra::{Matrix3, Vector3};

/// A limit of the rate that is so many times what the wheels reach limits nothing. A degree for a
/// radian is 57 times too much.
const UNREACHABLE: f64 = 20.0;
/// Share of the body's inertia above which a wheel is a large one. Those of spacecraft have less than
/// a thousandth.
const LARGE_WHEEL: f64 = 0.01;
/// Speed that large wheels do not have, rad/s: 9,500 rpm.
const FAST_WHEEL: f64 = 1000.0;
/// Acceleration that no spacecraft has, rad/s^2. The most agile small satellites reach a tenth.
const VIOLENT: f64 = 1.0;

/// Warns of a scenario without targets.
pub(super) fn check_targets(spec: &ScenarioSpec, findings: &mut Findings) {
    if spec.targets.is_empty() && spec.end.is_some() {
        findings.warn(
            "/targets",
            Code::NoTargets,
            "there are no targets, so the plan is a single slew from start to end",
            "list the attitudes to visit in targets",
        );
    }
}

/// Warns of limits, wheels and inertias that do not fit together.
pub(super) fn check_spacecraft(spacecraft: &Spacecraft, start: &Start, findings: &mut Findings) {
    check_rate_limits(spacecraft, start, findings);
    for (index, wheel) in spacecraft.wheels().iter().enumerate() {
        check_wheel(spacecraft, index, wheel, findings);
    }
    check_acceleration(spacecraft, findings);
}

fn check_rate_limits(spacecraft: &Spacecraft, start: &Start, findings: &mut Findings) {
    let reach = reachable_rates(spacecraft, start);
    let limits = spacecraft.max_rate();
    let excess = |k: usize| limits[k] / reach[k];
    // The one that is most out of reach stands for all of them.
    let worst = (0..3).filter(|&k| limits[k].is_finite() && excess(k) > UNREACHABLE);
    let worst = worst.max_by(|a, b| excess(*a).total_cmp(&excess(*b)));
    let (member, limit, reach) = if let Some(k) = worst {
        (format!("max_body_rate_rad_s/{k}"), limits[k], reach[k])
    } else {
        let (limit, reach) = (spacecraft.max_rate_norm(), reach.norm());
        if limit.is_infinite() || limit / reach <= UNREACHABLE {
            return;
        }
        ("max_body_rate_norm_rad_s".to_owned(), limit, reach)
    };
    findings.warn(
        format!("/spacecraft/{member}"),
        Code::RateLimitUnreachable,
        format!(
            "the limit of {limit} rad/s is {:.0} times the {reach:.2e} rad/s that the wheels can reach",
            limit / reach
        ),
        format!(
            "are these degrees per second? Then write {:.6}; without a limit write null",
            limit.to_radians()
        ),
    );
}

/// Bounds of the rates, by components, that the wheels can give the body at all, rad/s; infinite with
/// a wheel without a limit of speed.
fn reachable_rates(spacecraft: &Spacecraft, start: &Start) -> Vector3<f64> {
    let inverse = spacecraft.inertia_inverse();
    let momentum = start.momentum(spacecraft).norm();
    let of_momentum = Vector3::from_fn(|k, _| inverse.row(k).norm() * momentum);
    let wheels = spacecraft.wheels().iter().zip(&start.wheel_speed);
    wheels.fold(of_momentum, |sum, (wheel, speed)| {
        let speed = if wheel.enabled {
            wheel.max_speed
        } else {
            speed.abs()
        };
        sum + per_wheel(inverse, wheel, wheel.inertia * speed)
    })
}

/// What an amount about a wheel's axis does to the components of the body; zero also of an infinite
/// amount, where the wheel has no part in a component.
fn per_wheel(inverse: &Matrix3<f64>, wheel: &Wheel, amount: f64) -> Vector3<f64> {
    (inverse * wheel.axis).map(|share| {
        if share == 0.0 {
            0.0
        } else {
            share.abs() * amount
        }
    })
}

fn check_wheel(spacecraft: &Spacecraft, index: usize, wheel: &Wheel, findings: &mut Findings) {
    let along = wheel.axis.dot(&(spacecraft.inertia() * wheel.axis));
    let share = wheel.inertia * wheel.axis.norm_squared().powi(2) / along;
    let fast = wheel.max_speed.is_finite() && wheel.max_speed >= FAST_WHEEL;
    if !fast || share <= LARGE_WHEEL {
        return;
    }
    findings.warn(
        format!("/spacecraft/wheels/{index}/max_speed_rad_s"),
        Code::WheelSpeedImplausible,
        format!(
            "a wheel with {:.1} % of the body's inertia turns at {} rad/s",
            100.0 * share,
            wheel.max_speed
        ),
        format!(
            "are these revolutions per minute? Then write {:.1}; look at inertia_kg_m2 too",
            wheel.max_speed * std::f64::consts::PI / 30.0
        ),
    );
}

fn check_acceleration(spacecraft: &Spacecraft, findings: &mut Findings) {
    let inverse = spacecraft.effective_inertia_inverse();
    let wheels = spacecraft.enabled_wheels();
    let acceleration = wheels.fold(Vector3::zeros(), |sum, (_, wheel)| {
        let torque = wheel.max_torque.max(-wheel.min_torque);
        sum + per_wheel(inverse, wheel, torque)
    });
    if acceleration.amax() <= VIOLENT {
        return;
    }
    findings.warn(
        "/spacecraft/inertia_kg_m2",
        Code::AccelerationImplausible,
        format!(
            "the wheels accelerate the body by {:.3e} rad/s2, more than any spacecraft",
            acceleration.amax()
        ),
        "inertias are in kg m2 (1 kg m2 = 1e9 g mm2 = 1e4 kg cm2), torques in N m (1 N m = 1000 mN m)",
    );
}
