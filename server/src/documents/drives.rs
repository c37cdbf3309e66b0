//! Reading how wheels are driven, for slews and for flights with errors.

use super::reader::Cursor;
use slewplan_solver::model::drive::{DriveSpec, MotorSpec, SpeedLawSpec};

/// Reads one drive per wheel; ideal ones stand in where they cannot be read.
pub(crate) fn read(cursor: &Cursor<'_>) -> Vec<DriveSpec> {
    cursor.each(drive).unwrap_or_default()
}

fn drive(cursor: &Cursor<'_>) -> DriveSpec {
    let known = &[
        "viscous_friction_nms",
        "coulomb_friction_nm",
        "friction_compensated",
        "motor",
        "speed_law",
    ];
    let Some(fields) = cursor.object(known) else {
        return DriveSpec::default();
    };
    let number = |name| fields.optional(name).and_then(|it| it.number());
    DriveSpec {
        viscous_friction_nms: number("viscous_friction_nms"),
        coulomb_friction_nm: number("coulomb_friction_nm"),
        friction_compensated: fields
            .optional("friction_compensated")
            .and_then(|it| it.boolean()),
        motor: fields.optional("motor").and_then(|it| motor(&it)),
        speed_law: fields.optional("speed_law").and_then(|it| speed_law(&it)),
    }
}

fn motor(cursor: &Cursor<'_>) -> Option<MotorSpec> {
    let known = &[
        "resistance_ohm",
        "torque_constant_nm_a",
        "efficiency",
        "quiescent_power_w",
    ];
    let fields = cursor.object(known)?;
    let required = |name| fields.required(name).and_then(|it| it.number());
    let optional = |name| fields.optional(name).and_then(|it| it.number());
    // Read one by one first, so that every fault is found.
    let (resistance, constant) = (required("resistance_ohm"), required("torque_constant_nm_a"));
    let (efficiency, quiescent) = (optional("efficiency"), optional("quiescent_power_w"));
    Some(MotorSpec {
        resistance_ohm: resistance?,
        torque_constant_nm_a: constant?,
        efficiency,
        quiescent_power_w: quiescent,
    })
}

fn speed_law(cursor: &Cursor<'_>) -> Option<SpeedLawSpec> {
    let fields = cursor.object(&["rate_per_s", "speed_rad_s"])?;
    let required = |name| fields.required(name).and_then(|it| it.number());
    let (rate, speed) = (required("rate_per_s"), required("speed_rad_s"));
    Some(SpeedLawSpec {
        rate_per_s: rate?,
        speed_rad_s: speed?,
    })
}
