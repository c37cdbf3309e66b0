//! A body axis pointed at a direction, as a caller writes it.

use super::{AttitudeSpec, BoresightChoice, DirectionSpec};
use crate::model::input::{
    InputForm, InputPlace, MemberSchema, NamedSchema, Schema, input_object, optional, required,
    required_or,
};

input_object! {
    /// A body axis pointed at a direction: an attitude whose roll about that axis is left to the plan.
    /// Exactly one of `direction` and `ra_dec_deg` says where. Roll is measured as in `ra_dec_roll_deg`:
    /// at roll 0 the body's +Z axis (+X where the boresight lies along Z), as far as it is perpendicular
    /// to the boresight, points to celestial north, and roll is a right-handed turn about the boresight.
    pub struct PointingSpec as "Pointing" {
        /// The body axis that is pointed.
        pub boresight: BoresightChoice = required_or(BoresightChoice::Axis([1.0, 0.0, 0.0])),
        /// Where it points.
        pub direction: Option<DirectionSpec> = optional(),
        /// Where it points, as right ascension and declination; declination is from -90 to 90.
        pub ra_dec_deg: Option<[f64; 2]> = optional(),
        /// Least roll; both limits or none. Every roll is admissible without them, and where they are a
        /// whole turn or more apart. Across 180 degrees write 170 and 190.
        pub roll_min_deg: Option<f64> = optional(),
        /// Greatest roll; equal limits fix it.
        pub roll_max_deg: Option<f64> = optional(),
    }
}

impl Default for PointingSpec {
    fn default() -> Self {
        Self {
            boresight: BoresightChoice::Axis([1.0, 0.0, 0.0]),
            direction: Some(DirectionSpec::Vector([1.0, 0.0, 0.0])),
            ra_dec_deg: None,
            roll_min_deg: None,
            roll_max_deg: None,
        }
    }
}

/// An attitude, or where a boresight points, as one value of a document.
#[derive(Debug, Clone, PartialEq)]
pub enum OrientationSpec {
    /// The attitude.
    Attitude(AttitudeSpec),
    /// A pointed boresight.
    Pointing(PointingSpec),
}

impl Default for OrientationSpec {
    fn default() -> Self {
        Self::Attitude(AttitudeSpec::default())
    }
}

/// The only member of an orientation that is no attitude.
const POINTING: &str = "pointing";

impl InputForm for OrientationSpec {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        let Some(pointing) = place.member(POINTING) else {
            return AttitudeSpec::read(place).map(Self::Attitude);
        };
        if !place.is_object(Some(&[POINTING])) {
            return None;
        }
        PointingSpec::read(&pointing).map(Self::Pointing)
    }

    fn schema() -> Schema {
        Schema::Named(NamedSchema {
            name: "Orientation",
            doc: "An attitude in one of its forms, or `pointing`, which leaves the roll about a boresight \
                  free.",
            schema: || {
                Schema::OneOf(vec![
                    (String::new(), AttitudeSpec::schema()),
                    (String::new(), Schema::Named(POINTING_FORM)),
                ])
            },
        })
    }
}

const POINTING_FORM: NamedSchema = NamedSchema {
    name: "PointingForm",
    doc: "A boresight pointed at a direction.",
    schema: || {
        let pointing = MemberSchema::of::<PointingSpec>(POINTING, "", &required());
        Schema::Object(vec![pointing])
    },
};

impl OrientationSpec {
    /// The members of a target or a state that say the same.
    #[must_use]
    pub fn into_members(self) -> (AttitudeSpec, Option<PointingSpec>) {
        match self {
            Self::Attitude(attitude) => (attitude, None),
            Self::Pointing(pointing) => (AttitudeSpec::default(), Some(pointing)),
        }
    }
}
