//! The spacecraft as a caller writes it, or refers to it.

use crate::model::input::{
    InputForm, InputPlace, MemberRule, MemberSchema, NamedSchema, Schema, UpTo, input_object,
    optional, or, required, required_or,
};
use crate::model::problem::Code;
use crate::model::spacecraft::{MAX_BORESIGHTS, MAX_WHEELS};

/// Stands in where the inertia cannot be read: larger than that of any wheel.
const SUBSTITUTE_INERTIA: [[f64; 3]; 3] = [[1e6, 0.0, 0.0], [0.0, 1e6, 0.0], [0.0, 0.0, 1e6]];

input_object! {
    /// A rigid body with reaction wheels.
    #[derive(Default)]
    pub struct SpacecraftSpec as "Spacecraft" {
        /// Inertia of the whole spacecraft with its wheels locked, body axes.
        pub inertia_kg_m2: [[f64; 3]; 3] as InertiaMatrix = required_or(SUBSTITUTE_INERTIA),
        /// Limit of each body rate component; `null` is none.
        pub max_body_rate_rad_s: [Option<f64>; 3] = or([None; 3]),
        /// Limit of the norm of the body rate.
        pub max_body_rate_norm_rad_s: Option<f64> = optional().above(0.0),
        /// At least three enabled ones that span space. Every per-wheel array has their order.
        pub wheels: Vec<WheelSpec> as UpTo<MAX_WHEELS, WheelSpec>
            = required_or(substitute_wheels()).min_length(3),
        /// Named instrument axes.
        pub boresights: Vec<BoresightSpec> as UpTo<MAX_BORESIGHTS, BoresightSpec> = or(Vec::new()),
    }
}

input_object! {
    /// A reaction wheel.
    pub struct WheelSpec as "Wheel" {
        /// Spin axis in body axes.
        pub axis: [f64; 3] = required_or([1.0, 0.0, 0.0]),
        /// Whether the axis is scaled to unit length; else it enters as given, 0.001 to 1000 long.
        pub normalize_axis: bool = or(true),
        /// Inertia about the spin axis.
        pub inertia_kg_m2: f64 = required_or(1e-9).above(0.0),
        /// Largest motor torque on the wheel.
        pub max_torque_nm: f64 = required_or(1.0).above(0.0),
        /// Smallest motor torque on the wheel; minus the largest without it.
        pub min_torque_nm: Option<f64> = optional().below(0.0),
        /// Limit of the speed relative to the body; none without it.
        pub max_speed_rad_s: Option<f64> = optional().above(0.0),
        /// Whether the wheel may be commanded; a disabled wheel is locked at its start speed.
        pub enabled: bool = or(true),
    }
}

input_object! {
    /// A named body-fixed direction.
    pub struct BoresightSpec as "Boresight" {
        /// Name by which keep-out cones and attitudes refer to it.
        pub name: String = MemberRule::required_or_pointer(),
        /// Direction in body axes, any length.
        pub axis: [f64; 3] = required_or([0.0, 0.0, 1.0]),
    }
}

/// The rows of an inertia matrix. Three numbers are what many tools call an inertia, so that they get
/// the matrix that is meant as a hint.
struct InertiaMatrix;

impl InputForm for InertiaMatrix {
    type Value = [[f64; 3]; 3];

    fn read<P: InputPlace>(place: &P) -> Option<Self::Value> {
        let number = |index| place.entry(index).filter(P::is_number)?.number();
        if number(0).is_none() {
            return <[[f64; 3]; 3]>::read(place);
        }
        let moments = (number(0), number(1), number(2), place.entry(3));
        let (Some(x), Some(y), Some(z), None) = moments else {
            place.report(
                Code::WrongType,
                "a list of numbers, not the three rows of the inertia matrix",
                "write three rows of three numbers, such as [[6.6, 0, 0], [0, 8.9, 0], [0, 0, 9.6]]",
            );
            return None;
        };
        place.report(
            Code::WrongType,
            "a vector of numbers, not the three rows of the inertia matrix",
            format!("for these principal moments write [[{x}, 0, 0], [0, {y}, 0], [0, 0, {z}]]"),
        );
        None
    }

    fn schema() -> Schema {
        <[[f64; 3]; 3]>::schema()
    }
}

impl SpacecraftSpec {
    /// A spacecraft with which nothing is wrong, which stands in for one that cannot be read.
    #[must_use]
    pub fn substitute() -> Self {
        Self {
            inertia_kg_m2: SUBSTITUTE_INERTIA,
            wheels: substitute_wheels(),
            ..Self::default()
        }
    }
}

/// Three wheels with which nothing is wrong.
fn substitute_wheels() -> Vec<WheelSpec> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    axes.map(|axis| WheelSpec {
        axis,
        normalize_axis: true,
        inertia_kg_m2: 1e-9,
        max_torque_nm: 1.0,
        min_torque_nm: None,
        max_speed_rad_s: None,
        enabled: true,
    })
    .into()
}

/// A spacecraft, or the name of a stored one. What is stored is known to a service only, which has
/// put it in place of its name before the document is read: a name that is still there is refused.
#[derive(Debug)]
pub struct SpacecraftOrReference;

impl InputForm for SpacecraftOrReference {
    type Value = SpacecraftSpec;

    fn read<P: InputPlace>(place: &P) -> Option<SpacecraftSpec> {
        if let Some(reference) = place.member("ref") {
            reference.report(
                Code::UnknownReference,
                "spacecraft stored by name are known only to the service",
                "write the spacecraft out in the scenario, with inertia_kg_m2 and wheels",
            );
            return None;
        }
        SpacecraftSpec::read(place)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "SpacecraftOrReference",
            doc: "A spacecraft, or the name of a stored one.",
            schema: || {
                Schema::OneOf(vec![
                    ("Written out.".into(), SpacecraftSpec::schema()),
                    ("Stored before.".into(), reference()),
                ])
            },
        })
    }
}

/// The name of a stored spacecraft, for the description: the service reads it.
fn reference() -> Schema {
    Schema::Named(NamedSchema {
        name: "SpacecraftReference",
        doc: "A stored spacecraft.",
        schema: || {
            let version = optional().at_least(1.0).format("int32");
            Schema::Object(vec![
                MemberSchema::of::<String>("ref", "Its name.", &required()),
                MemberSchema::of::<Option<u64>>(
                    "version",
                    "Its version; the newest without it.",
                    &version,
                ),
            ])
        },
    })
}
