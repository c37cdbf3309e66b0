//! The wheels of a spacecraft, which have to turn it about every axis.

use super::Wheel;
use super::inertia::positive_definite_inverse;
use crate::model::findings::{Findings, unit};
use crate::model::problem::Code;
use crate::model::spec::WheelSpec;
use crate::model::wheel_axes;
use nalgebra::{DMatrix, Matrix3};

/// Limit of the enabled wheels.
pub(crate) const MAX_ENABLED: usize = 17;
/// Limit of the wheels of a spacecraft, enabled or not.
pub const MAX_WHEELS: usize = 100;

/// Reads the wheels, of which the enabled ones must span space, with the pseudo-inverse of their
/// axes.
pub(super) fn read(
    specs: &[WheelSpec],
    pointer: &str,
    findings: &mut Findings,
) -> Option<(Vec<Wheel>, DMatrix<f64>)> {
    if !findings.at_most(pointer, specs.len(), MAX_WHEELS) {
        return None;
    }
    // All are read before they are collected: collecting into an option stops at the first fault.
    let wheels: Vec<_> = specs
        .iter()
        .enumerate()
        .map(|(i, spec)| wheel(spec, &format!("{pointer}/{i}"), findings))
        .collect();
    let enabled = specs.iter().filter(|spec| spec.enabled).count();
    if enabled < 3 {
        findings.refuse(
            pointer,
            Code::TooFewWheels,
            format!(
                "{enabled} of {} wheels are enabled, at least 3 are needed",
                specs.len()
            ),
            "enable or add wheels until their axes span space",
        );
        return None;
    }
    if enabled > MAX_ENABLED {
        findings.refuse(
            pointer,
            Code::TooManyWheels,
            format!("{enabled} wheels are enabled, at most {MAX_ENABLED} can be"),
            "set \"enabled\": false for wheels to spare; each keeps its start speed",
        );
        return None;
    }
    let wheels: Vec<Wheel> = wheels.into_iter().collect::<Option<_>>()?;
    let inverse = axes_inverse(&wheels, pointer, findings)?;
    Some((wheels, inverse))
}

fn wheel(spec: &WheelSpec, pointer: &str, findings: &mut Findings) -> Option<Wheel> {
    let axis_pointer = format!("{pointer}/axis");
    let axis = if spec.normalize_axis {
        findings.nonzero(&axis_pointer, spec.axis).map(unit)
    } else {
        wheel_axes::read(&axis_pointer, spec.axis, findings)
    };
    let inertia = findings.positive(&format!("{pointer}/inertia_kg_m2"), spec.inertia_kg_m2);
    let torque = torque_limits(spec, pointer, findings);
    let max_speed = match spec.max_speed_rad_s {
        None => Some(f64::INFINITY),
        Some(speed) => findings.positive(&format!("{pointer}/max_speed_rad_s"), speed),
    };
    let (min_torque, max_torque) = torque?;
    Some(Wheel {
        axis: axis?,
        inertia: inertia?,
        min_torque,
        max_torque,
        max_speed: max_speed?,
        enabled: spec.enabled,
    })
}

/// Smallest and largest torque, N m, on either side of zero.
fn torque_limits(spec: &WheelSpec, pointer: &str, findings: &mut Findings) -> Option<(f64, f64)> {
    let max_pointer = format!("{pointer}/max_torque_nm");
    let max = findings
        .finite(&max_pointer, spec.max_torque_nm)
        .filter(|&max| {
            if max <= 0.0 {
                findings.refuse(
                &max_pointer,
                Code::TorqueLimits,
                format!("the largest torque is {max} N m, it must be above 0"),
                "give a largest torque above 0; set \"enabled\": false for a wheel without torque",
            );
            }
            max > 0.0
        });
    let Some(min) = spec.min_torque_nm else {
        return max.map(|max| (-max, max));
    };
    let min_pointer = format!("{pointer}/min_torque_nm");
    let min = findings.finite(&min_pointer, min).filter(|&min| {
        if min >= 0.0 {
            findings.refuse(
                &min_pointer,
                Code::TorqueLimits,
                format!("the smallest torque is {min} N m, it must be below 0"),
                "give a negative value, or leave it out for minus the largest torque",
            );
        }
        min < 0.0
    });
    Some((min?, max?))
}

fn axes_inverse(wheels: &[Wheel], pointer: &str, findings: &mut Findings) -> Option<DMatrix<f64>> {
    let enabled = wheels.iter().filter(|wheel| wheel.enabled);
    let axes: Vec<_> = enabled.map(|wheel| wheel.axis).collect();
    let inverse = wheel_axes::pseudo_inverse(&axes);
    if inverse.is_none() {
        let (least, greatest) = wheel_axes::singular_values(&axes);
        findings.refuse(
            pointer,
            Code::WheelAxesCoplanar,
            format!(
                "the axes of the {} enabled wheels lie in a plane (singular values from {least:.3e} \
                 to {greatest:.3e})",
                axes.len()
            ),
            "no torque can be made across that plane; enable or add a wheel out of it",
        );
    }
    inverse
}

/// `J_eff` and its inverse.
pub(super) fn effective_inertia(
    inertia: &Matrix3<f64>,
    wheels: &[Wheel],
    pointer: &str,
    findings: &mut Findings,
) -> Option<(Matrix3<f64>, Matrix3<f64>)> {
    let spin: Matrix3<f64> = wheels
        .iter()
        .filter(|wheel| wheel.enabled)
        .map(|wheel| wheel.axis * wheel.axis.transpose() * wheel.inertia)
        .sum();
    let effective = inertia - spin;
    let inverse = effective
        .iter()
        .all(|entry| entry.is_finite())
        .then(|| positive_definite_inverse(&effective))
        .flatten();
    if inverse.is_none() {
        let diagonal = |m: &Matrix3<f64>| format!("{}, {}, {}", m.m11, m.m22, m.m33);
        findings.refuse(
            pointer,
            Code::WheelInertiaExceedsBody,
            format!(
                "the enabled wheels' spin inertia (diagonal {} kg m2) leaves nothing positive of \
                 the spacecraft's (diagonal {} kg m2)",
                diagonal(&spin),
                diagonal(inertia)
            ),
            "inertia_kg_m2 of the spacecraft includes its wheels; check both and their units",
        );
    }
    Some((effective, inverse?))
}
