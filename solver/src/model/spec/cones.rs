//! Cones that bound where boresights point, as a caller writes them.

use crate::model::input::{
    InputForm, InputPlace, MemberSchema, NamedSchema, Schema, input_choice, input_object, or,
    required, required_or,
};
use crate::model::problem::Code;

input_object! {
    /// A cone that bounds where a boresight points.
    pub struct ConeSpec as "Cone" {
        /// Name of the boresight.
        pub boresight: String = required_or(String::new()),
        /// Axis of the cone.
        pub direction: DirectionSpec = required_or(DirectionSpec::Vector([1.0, 0.0, 0.0])),
        /// Half angle of the cone.
        pub half_angle_deg: f64 = required_or(1.0).above(0.0).below(180.0),
        /// When the cone is enforced; `always` without it.
        pub applies: Applies = or(Applies::Always),
    }
}

input_choice! {
    /// When a cone is enforced.
    pub enum Applies as "ConeApplies" {
        /// Along the whole flight.
        Always = "always",
        /// From arrival to departure at targets.
        AtTargets = "at_targets",
        /// Never: intrusions are reported.
        Report = "report",
    }
}

/// A direction in the reference frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DirectionSpec {
    /// Components in the reference frame, any length.
    Vector([f64; 3]),
    /// Right ascension and declination, degrees.
    RaDecDeg([f64; 2]),
    /// Where a body of the sky stands at the epoch.
    Body(CelestialBody),
}

impl From<[f64; 3]> for DirectionSpec {
    fn from(vector: [f64; 3]) -> Self {
        Self::Vector(vector)
    }
}

input_choice! {
    /// A body of the sky.
    pub enum CelestialBody as "CelestialBody" {
        /// The Sun as seen from the Earth's centre.
        Sun = "sun",
    }
}

/// The members of which a direction that is no vector has exactly one.
const NAMES: [&str; 2] = ["ra_dec_deg", "body"];
const HINT: &str = "write a vector [x, y, z], {\"ra_dec_deg\": [ra, dec]} or {\"body\": \"sun\"}";

impl InputForm for DirectionSpec {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        if place.is_list() {
            return <[f64; 3]>::read(place).map(Self::Vector);
        }
        if !place.is_object(Some(&NAMES)) {
            return None;
        }
        match NAMES.map(|name| place.member(name)) {
            [Some(angles), None] => <[f64; 2]>::read(&angles).map(Self::RaDecDeg),
            [None, Some(body)] => CelestialBody::read(&body).map(Self::Body),
            [None, None] => {
                place.report(Code::WrongType, "the direction has no form", HINT);
                None
            }
            [Some(_), Some(_)] => {
                let message = "the direction is given in two forms: ra_dec_deg and body";
                place.report(Code::ConflictingFields, message, HINT);
                None
            }
        }
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "Direction",
            doc: "A direction in the reference frame.",
            schema: || {
                Schema::OneOf(vec![
                    ("A vector of any length.".into(), <[f64; 3]>::schema()),
                    (String::new(), Schema::Named(RA_DEC)),
                    (String::new(), Schema::Named(BODY)),
                ])
            },
        })
    }
}

const RA_DEC: NamedSchema = NamedSchema {
    name: "RaDecForm",
    doc: "Right ascension and declination, degrees: declination is from -90 to 90.",
    schema: || {
        let angles = MemberSchema::of::<[f64; 2]>("ra_dec_deg", "", &required());
        Schema::Object(vec![angles])
    },
};
const BODY: NamedSchema = NamedSchema {
    name: "BodyForm",
    doc: "Where a body of the sky stands at the scenario's epoch, in EME2000 axes.",
    schema: || {
        let body = MemberSchema::of::<CelestialBody>("body", "", &required());
        Schema::Object(vec![body])
    },
};
