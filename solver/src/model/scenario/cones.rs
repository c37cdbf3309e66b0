//! The cones that bound where boresights point.

use super::directions::Sky;
use crate::model::boresights;
use crate::model::cone::{Cone, Side};
use crate::model::findings::{Findings, unit};
use crate::model::problem::Code;
use crate::model::spec::{ConeSpec, MAX_CONES, ScenarioSpec};
use nalgebra::Vector3;

pub(super) fn read_all(
    spec: &ScenarioSpec,
    sky: Sky,
    findings: &mut Findings,
) -> Option<Vec<Cone>> {
    let lists = [(Side::Out, &spec.keep_out), (Side::In, &spec.keep_in)];
    if !are_few(spec, findings) {
        return None;
    }
    // All are read before they are collected: collecting into an option stops at the first fault.
    let cones: Vec<_> = lists
        .into_iter()
        .flat_map(|(side, list)| {
            list.iter()
                .enumerate()
                .map(move |(i, cone)| (side, i, cone))
        })
        .map(|(side, index, cone)| read(side, index, cone, spec, sky, findings))
        .collect();
    cones.into_iter().collect()
}

/// Whether the lists have at most so many cones, each and together; longer ones are not read.
fn are_few(spec: &ScenarioSpec, findings: &mut Findings) -> bool {
    let [out, inside] = [&spec.keep_out, &spec.keep_in].map(Vec::len);
    let few_out = findings.at_most("/keep_out", out, MAX_CONES);
    if !findings.at_most("/keep_in", inside, MAX_CONES) || !few_out {
        return false;
    }
    let all = out + inside;
    if all > MAX_CONES {
        findings.refuse(
            "/keep_in",
            Code::WrongLength,
            format!("keep_out and keep_in have {all} cones together, they may have {MAX_CONES}"),
            format!("list at most {MAX_CONES}"),
        );
    }
    all <= MAX_CONES
}

fn read(
    side: Side,
    index: usize,
    cone: &ConeSpec,
    spec: &ScenarioSpec,
    sky: Sky,
    findings: &mut Findings,
) -> Option<Cone> {
    let pointer = format!("/{}/{index}", side.list());
    let known = &spec.spacecraft.boresights;
    let boresight_pointer = format!("{pointer}/boresight");
    let boresight = boresights::find(&cone.boresight, known, &boresight_pointer, findings);
    let direction = sky.direction(&cone.direction, &format!("{pointer}/direction"), findings);
    let half_angle = read_half_angle(cone, &format!("{pointer}/half_angle_deg"), findings);
    Some(Cone {
        side,
        index,
        applies: cone.applies,
        boresight: cone.boresight.clone(),
        axis: unit(Vector3::from(boresight?.axis)),
        direction: direction?,
        half_angle: half_angle?,
    })
}

/// Half angle in rad.
fn read_half_angle(spec: &ConeSpec, pointer: &str, findings: &mut Findings) -> Option<f64> {
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
