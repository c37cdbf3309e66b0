//! Reading the spacecraft.

use super::document::Node;
use super::reader::{Cursor, Fields, Sink};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spacecraft::{MAX_BORESIGHTS, MAX_WHEELS};
use slewplan_solver::model::spec::{
    BoresightSpec, ScenarioSpec, SpacecraftSpec, TargetSpec, WheelSpec,
};

/// Stands in where the inertia cannot be read: larger than that of any wheel.
const SUBSTITUTE_INERTIA: [[f64; 3]; 3] = [[1e6, 0.0, 0.0], [0.0, 1e6, 0.0], [0.0, 0.0, 1e6]];

/// Reads the spacecraft; harmless values stand in where it cannot be read.
pub(super) fn read(cursor: &Cursor<'_>) -> SpacecraftSpec {
    try_read(cursor).unwrap_or_else(substitute)
}

/// Everything that is wrong with a spacecraft alone, with pointers into it.
pub(crate) fn problems(node: &Node) -> Vec<Problem> {
    let sink = Sink::default();
    let spec = ScenarioSpec {
        spacecraft: read(&Cursor::root(node, &sink)),
        targets: vec![TargetSpec {
            id: "t".into(),
            ..TargetSpec::default()
        }],
        ..ScenarioSpec::default()
    };
    let shape = sink.into_problems();
    if !shape.is_empty() {
        return shape;
    }
    // At rest at the identity nothing is wrong but what is wrong with the spacecraft.
    let found = Scenario::try_new(&spec).err().unwrap_or_default();
    let within = |problem: Problem| {
        let pointer = problem.pointer.strip_prefix("/spacecraft")?.to_owned();
        Some(Problem { pointer, ..problem })
    };
    found.into_iter().filter_map(within).collect()
}

/// A spacecraft with which nothing is wrong.
pub(super) fn substitute() -> SpacecraftSpec {
    SpacecraftSpec {
        inertia_kg_m2: SUBSTITUTE_INERTIA,
        wheels: substitute_wheels(),
        ..SpacecraftSpec::default()
    }
}

fn substitute_wheels() -> Vec<WheelSpec> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    axes.map(|axis| WheelSpec {
        axis,
        ..substitute_wheel()
    })
    .into()
}

fn substitute_wheel() -> WheelSpec {
    WheelSpec {
        axis: [1.0, 0.0, 0.0],
        normalize_axis: true,
        inertia_kg_m2: 1e-9,
        max_torque_nm: 1.0,
        min_torque_nm: None,
        max_speed_rad_s: None,
        enabled: true,
    }
}

fn try_read(cursor: &Cursor<'_>) -> Option<SpacecraftSpec> {
    if let Some(reference) = cursor.member("ref") {
        reference.report(
            Code::UnknownReference,
            "spacecraft stored by name are known only to the service",
            "write the spacecraft out in the scenario, with inertia_kg_m2 and wheels",
        );
        return None;
    }
    let fields = cursor.object(&[
        "inertia_kg_m2",
        "max_body_rate_rad_s",
        "max_body_rate_norm_rad_s",
        "wheels",
        "boresights",
    ])?;
    Some(SpacecraftSpec {
        inertia_kg_m2: fields
            .required("inertia_kg_m2")
            .and_then(|inertia| inertia.matrix())
            .unwrap_or(SUBSTITUTE_INERTIA),
        max_body_rate_rad_s: fields
            .optional("max_body_rate_rad_s")
            .and_then(|rates| rates.nullable_numbers())
            .unwrap_or_default(),
        max_body_rate_norm_rad_s: fields
            .optional("max_body_rate_norm_rad_s")
            .and_then(|rate| rate.number()),
        wheels: fields
            .required("wheels")
            .and_then(|wheels| wheels.each_of_at_most(MAX_WHEELS, wheel))
            .unwrap_or_else(substitute_wheels),
        boresights: fields
            .optional("boresights")
            .and_then(|boresights| boresights.each_of_at_most(MAX_BORESIGHTS, boresight))
            .unwrap_or_default(),
    })
}

fn wheel(cursor: &Cursor<'_>) -> WheelSpec {
    let known = &[
        "axis",
        "normalize_axis",
        "inertia_kg_m2",
        "max_torque_nm",
        "min_torque_nm",
        "max_speed_rad_s",
        "enabled",
    ];
    cursor
        .object(known)
        .map_or_else(substitute_wheel, |fields| wheel_of(&fields))
}

fn wheel_of(fields: &Fields<'_>) -> WheelSpec {
    let substitute = substitute_wheel();
    let required = |name| fields.required(name).and_then(|value| value.number());
    let optional = |name| fields.optional(name).and_then(|value| value.number());
    let flag = |name| {
        fields
            .optional(name)
            .and_then(|value| value.boolean())
            .unwrap_or(true)
    };
    WheelSpec {
        axis: fields
            .required("axis")
            .and_then(|axis| axis.numbers())
            .unwrap_or(substitute.axis),
        normalize_axis: flag("normalize_axis"),
        inertia_kg_m2: required("inertia_kg_m2").unwrap_or(substitute.inertia_kg_m2),
        max_torque_nm: required("max_torque_nm").unwrap_or(substitute.max_torque_nm),
        min_torque_nm: optional("min_torque_nm"),
        max_speed_rad_s: optional("max_speed_rad_s"),
        enabled: flag("enabled"),
    }
}

fn boresight(cursor: &Cursor<'_>) -> BoresightSpec {
    let fields = cursor.object(&["name", "axis"]);
    let member = |name| fields.as_ref().and_then(|fields| fields.required(name));
    BoresightSpec {
        // The place is unique, so that a substitute is no duplicate.
        name: member("name")
            .and_then(|name| name.text().map(str::to_owned))
            .unwrap_or_else(|| cursor.pointer().to_owned()),
        axis: member("axis")
            .and_then(|axis| axis.numbers())
            .unwrap_or([0.0, 0.0, 1.0]),
    }
}
