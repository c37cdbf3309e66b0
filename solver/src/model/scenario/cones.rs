//! The cones that bound where boresights point.

use super::Scenario;
use crate::model::attitude::Attitude;
use crate::model::boresights;
use crate::model::cone::{Applies, Cone, Side};
use crate::model::findings::{Findings, unit};
use crate::model::problem::Code;
use crate::model::spec::{BoresightSpec, KeepOutSpec, MAX_CONES, ScenarioSpec};
use nalgebra::Vector3;

/// Depth, rad, up to which a boresight inside a cone is no violation for the checker.
const TOUCH: f64 = 1e-6;

pub(super) fn read_all(spec: &ScenarioSpec, findings: &mut Findings) -> Option<Vec<Cone>> {
    if !findings.at_most("/keep_out", spec.keep_out.len(), MAX_CONES) {
        return None;
    }
    // All are read before they are collected: collecting into an option stops at the first fault.
    let cones: Vec<_> = spec
        .keep_out
        .iter()
        .enumerate()
        .map(|(i, cone)| read(cone, i, &spec.spacecraft.boresights, findings))
        .collect();
    cones.into_iter().collect()
}

fn read(
    spec: &KeepOutSpec,
    index: usize,
    boresights: &[BoresightSpec],
    findings: &mut Findings,
) -> Option<Cone> {
    let pointer = format!("/keep_out/{index}");
    let boresight_pointer = format!("{pointer}/boresight");
    let boresight = boresights::find(&spec.boresight, boresights, &boresight_pointer, findings);
    let direction = findings.direction(&format!("{pointer}/direction"), spec.direction);
    let half_angle = read_half_angle(spec, &format!("{pointer}/half_angle_deg"), findings);
    Some(Cone {
        side: Side::Out,
        index,
        applies: Applies::Always,
        boresight: spec.boresight.clone(),
        axis: unit(Vector3::from(boresight?.axis)),
        direction: direction?,
        half_angle: half_angle?,
    })
}

/// Half angle in rad.
fn read_half_angle(spec: &KeepOutSpec, pointer: &str, findings: &mut Findings) -> Option<f64> {
    let degrees = findings.finite(pointer, spec.half_angle_deg)?;
    if degrees > 0.0 && degrees < 180.0 {
        return Some(degrees.to_radians());
    }
    findings.refuse(
        pointer,
        Code::OutOfRange,
        format!("the half angle is {degrees} degrees, it must be above 0 and below 180"),
        "give the angle from the cone's axis to its surface, in degrees",
    );
    None
}

/// Warns of every attitude that itself points a boresight into a cone: no plan avoids that.
pub(super) fn warn_of_attitudes(scenario: &Scenario, findings: &mut Findings) {
    if scenario.cones.is_empty() {
        return;
    }
    let mut warn = |pointer: &str, who: &str, attitude: &Attitude| {
        for cone in &scenario.cones {
            let depth = -cone.clearance(attitude);
            if depth > TOUCH {
                findings.warn(
                    pointer,
                    Code::AttitudeInKeepOut,
                    format!(
                        "{who} points boresight '{}' {:.3} degrees into the keep-out cone of {} \
                         degrees ({})",
                        cone.boresight,
                        depth.to_degrees(),
                        // Rounding in the conversion to radians and back.
                        (cone.half_angle.to_degrees() * 1e9).round() / 1e9,
                        cone.pointer()
                    ),
                    "every plan through this attitude violates the cone: change the attitude, or \
                     narrow the cone",
                );
            }
        }
    };
    warn("/start", "the start", &scenario.start.attitude);
    if let Some(end) = &scenario.end {
        warn("/end", "the end", &end.attitude);
    }
    for (index, target) in scenario.targets.iter().enumerate() {
        let who = format!("target \"{}\"", target.id);
        warn(&format!("/targets/{index}"), &who, &target.attitude);
    }
}
