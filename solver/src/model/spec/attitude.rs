//! An attitude as a caller writes it, in one of several forms.

use crate::model::input::{
    InputForm, InputPlace, MemberSchema, NamedSchema, Schema, input_object, required, required_or,
};
use crate::model::problem::Code;

/// One of the input forms of an attitude.
#[derive(Debug, Clone, PartialEq)]
pub enum AttitudeSpec {
    /// Scalar-last components `[x, y, z, w]`, rotating body vectors into the reference frame.
    Quaternion([f64; 4]),
    /// Roll, pitch and yaw of the z-y-x sequence, degrees.
    RollPitchYawDeg([f64; 3]),
    /// Modified Rodrigues parameters.
    Mrp([f64; 3]),
    /// Rows of the rotation matrix whose columns are the body axes in the reference frame.
    Matrix([[f64; 3]; 3]),
    /// Right ascension, declination and roll of a body axis, degrees.
    RaDecRollDeg {
        /// Right ascension, declination and roll, degrees.
        angles: [f64; 3],
        /// The body axis that is pointed.
        boresight: BoresightChoice,
    },
}

/// A body axis as a vector, or as the name of one of the spacecraft's boresights.
#[derive(Debug, Clone, PartialEq)]
pub enum BoresightChoice {
    /// Direction in body axes, any length.
    Axis([f64; 3]),
    /// Name of one of the spacecraft's boresights.
    Name(String),
}

impl InputForm for BoresightChoice {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        if place.is_text() {
            return place.text().map(|name| Self::Name(name.to_owned()));
        }
        <[f64; 3]>::read(place).map(Self::Axis)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "BoresightChoice",
            doc: "A body axis: a vector, or the name of one of `spacecraft.boresights`.",
            schema: || {
                Schema::OneOf(vec![
                    (
                        "Direction in body axes, any length.".into(),
                        <[f64; 3]>::schema(),
                    ),
                    (
                        "Name of one of `spacecraft.boresights`.".into(),
                        Schema::Text,
                    ),
                ])
            },
        })
    }
}

impl Default for AttitudeSpec {
    fn default() -> Self {
        Self::Quaternion([0.0, 0.0, 0.0, 1.0])
    }
}

input_object! {
    /// From one attitude to another.
    #[derive(Default)]
    pub struct PairSpec as "PairBody" {
        /// Attitude at the start.
        pub from: AttitudeSpec = required_or(AttitudeSpec::default()),
        /// Attitude at the end.
        pub to: AttitudeSpec = required_or(AttitudeSpec::default()),
    }
}

input_object! {
    /// A quaternion with scalar part `w`, of unit norm within 1e-3.
    struct QuaternionSpec as "Quaternion" {
        /// First component of the vector part.
        x: f64 = required(),
        /// Second component of the vector part.
        y: f64 = required(),
        /// Third component of the vector part.
        z: f64 = required(),
        /// Scalar part.
        w: f64 = required(),
    }
}

/// The members of which an attitude has exactly one.
const FORMS: [&str; 5] = [
    "quaternion",
    "roll_pitch_yaw_deg",
    "mrp",
    "matrix",
    "ra_dec_roll_deg",
];
/// All members of an attitude.
const NAMES: [&str; 6] = [
    "quaternion",
    "roll_pitch_yaw_deg",
    "mrp",
    "matrix",
    "ra_dec_roll_deg",
    "boresight",
];
/// What the form of right ascension, declination and roll means.
const RA_DEC_ROLL: &str = "Right ascension, declination and roll of a body axis, degrees: the \
    boresight points to that place of the sky. Declination is from -90 to 90; whole turns may be \
    added to right ascension and roll. At roll 0 the body's +Z axis (+X where the boresight lies \
    along Z), as far as it is perpendicular to the boresight, points to celestial north: in the \
    picture of a camera that looks along the boresight with body +Z upwards, north is up and east \
    to the left. Roll is a right-handed turn about the boresight: seen from behind, looking along \
    it, the body turns clockwise.";
const FORM_HINT: &str = "give exactly one of quaternion, roll_pitch_yaw_deg, mrp, matrix, or \
                         ra_dec_roll_deg together with boresight";

impl InputForm for AttitudeSpec {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        if !place.is_object(Some(&NAMES)) {
            return None;
        }
        let form = only_form(place)?;
        if form != "ra_dec_roll_deg"
            && let Some(boresight) = place.member("boresight")
        {
            boresight.report(
                Code::AttitudeForm,
                format!("boresight has no meaning beside {form}"),
                "remove boresight, or give the attitude as ra_dec_roll_deg",
            );
        }
        read_form(place, form)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "Attitude",
            doc: "One of the forms of an attitude; body axes to the reference frame.",
            schema: || {
                let unsaid = |form| (String::new(), form);
                Schema::OneOf(forms().map(unsaid).into())
            },
        })
    }
}

/// The form in which an attitude is given, unless it is none or several.
fn only_form<P: InputPlace>(place: &P) -> Option<&'static str> {
    let given = FORMS
        .into_iter()
        .filter(|form| place.member(form).is_some());
    let given: Vec<&str> = given.collect();
    let message = match given[..] {
        [form] => return Some(form),
        [] => "the attitude is given in no form".to_owned(),
        _ => format!(
            "the attitude is given in {} forms: {}",
            given.len(),
            given.join(", ")
        ),
    };
    place.report(Code::AttitudeForm, message, FORM_HINT);
    None
}

fn read_form<P: InputPlace>(place: &P, form: &str) -> Option<AttitudeSpec> {
    let value = place.member(form)?;
    Some(match form {
        "quaternion" => {
            let QuaternionSpec { x, y, z, w } = QuaternionSpec::read(&value)?;
            AttitudeSpec::Quaternion([x, y, z, w])
        }
        "roll_pitch_yaw_deg" => AttitudeSpec::RollPitchYawDeg(<[f64; 3]>::read(&value)?),
        "mrp" => AttitudeSpec::Mrp(<[f64; 3]>::read(&value)?),
        "matrix" => AttitudeSpec::Matrix(<[[f64; 3]; 3]>::read(&value)?),
        _ => {
            let angles = <[f64; 3]>::read(&value);
            let boresight = place.required("boresight");
            let boresight = boresight.and_then(|choice| BoresightChoice::read(&choice));
            AttitudeSpec::RaDecRollDeg {
                angles: angles?,
                boresight: boresight?,
            }
        }
    })
}

/// The forms for the description, each an object of its own.
fn forms() -> [Schema; 5] {
    let named = |name, doc, schema| Schema::Named(NamedSchema { name, doc, schema });
    [
        named("QuaternionForm", "", || {
            let components = MemberSchema::of::<QuaternionSpec>("quaternion", "", &required());
            Schema::Object(vec![components])
        }),
        named(
            "RollPitchYawForm",
            "Roll, pitch and yaw of the z-y-x sequence, degrees.",
            || Schema::Object(vec![vector("roll_pitch_yaw_deg")]),
        ),
        named("MrpForm", "Modified Rodrigues parameters.", || {
            Schema::Object(vec![vector("mrp")])
        }),
        named(
            "MatrixForm",
            "Rotation matrix whose columns are the body axes in the reference frame.",
            || {
                let matrix = MemberSchema::of::<[[f64; 3]; 3]>("matrix", "", &required());
                Schema::Object(vec![matrix])
            },
        ),
        named("RaDecRollForm", RA_DEC_ROLL, || {
            let boresight = MemberSchema::of::<BoresightChoice>("boresight", "", &required());
            Schema::Object(vec![vector("ra_dec_roll_deg"), boresight])
        }),
    ]
}

fn vector(name: &'static str) -> MemberSchema {
    MemberSchema::of::<[f64; 3]>(name, "", &required())
}
