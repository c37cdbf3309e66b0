//! The keep-out cones.

use super::KeepOut;
use crate::model::boresights;
use crate::model::findings::{Findings, unit};
use crate::model::problem::Code;
use crate::model::spec::{BoresightSpec, KeepOutSpec, MAX_CONES, ScenarioSpec};
use nalgebra::Vector3;

pub(super) fn read_all(spec: &ScenarioSpec, findings: &mut Findings) -> Option<Vec<KeepOut>> {
    if !findings.at_most("/keep_out", spec.keep_out.len(), MAX_CONES) {
        return None;
    }
    // All are read before they are collected: collecting into an option stops at the first fault.
    let cones: Vec<_> = spec
        .keep_out
        .iter()
        .enumerate()
        .map(|(i, cone)| {
            read(
                cone,
                &spec.spacecraft.boresights,
                &format!("/keep_out/{i}"),
                findings,
            )
        })
        .collect();
    cones.into_iter().collect()
}

fn read(
    spec: &KeepOutSpec,
    boresights: &[BoresightSpec],
    pointer: &str,
    findings: &mut Findings,
) -> Option<KeepOut> {
    let boresight_pointer = format!("{pointer}/boresight");
    let boresight = boresights::find(&spec.boresight, boresights, &boresight_pointer, findings);
    let direction = findings.direction(&format!("{pointer}/direction"), spec.direction);
    let half_angle = read_half_angle(spec, &format!("{pointer}/half_angle_deg"), findings);
    Some(KeepOut {
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
