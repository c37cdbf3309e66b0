//! The attitude of a target or an end, or where its boresight points.

use super::directions::Sky;
use crate::model::attitude::{Aim, Attitude, AttitudeContext, boresight_axis, pointed};
use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::roll::{FreeRoll, Pointing};
use crate::model::spec::{AttitudeEquivalence, AttitudeSpec, DirectionSpec, PointingSpec};
use crate::model::tolerances::ATTITUDE_TOLERANCE;
use nalgebra::Vector3;

/// What attitudes and pointed boresights may refer to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub(super) attitudes: AttitudeContext<'a>,
    pub(super) sky: Sky,
}

/// An attitude, or where a boresight points.
#[derive(Debug)]
pub(super) struct Orientation {
    /// Where the roll is free, the attitude of roll 0.
    pub(super) attitude: Attitude,
    pub(super) roll: Option<FreeRoll>,
    pub(super) pointing: Option<Pointing>,
}

impl Surroundings<'_> {
    /// Reads what stands in the object at a pointer.
    pub(super) fn orientation(
        &self,
        attitude: &AttitudeSpec,
        pointing: Option<&PointingSpec>,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Orientation> {
        if let Some(pointing) = pointing {
            return self.pointing(pointing, &format!("{pointer}/pointing"), findings);
        }
        let pointer = format!("{pointer}/attitude");
        let attitude = Attitude::read(attitude, self.attitudes, &pointer, findings)?;
        Some(Orientation {
            attitude,
            roll: None,
            pointing: None,
        })
    }

    fn pointing(
        &self,
        spec: &PointingSpec,
        pointer: &str,
        findings: &mut Findings,
    ) -> Option<Orientation> {
        let signed = self.attitudes.equivalence == AttitudeEquivalence::Quaternion;
        if signed {
            findings.refuse(
                pointer,
                Code::SignUndefined,
                "a direction does not tell q from -q, but attitude_equivalence is \"quaternion\"",
                "give an attitude as quaternion, roll_pitch_yaw_deg or mrp, or use \
                 attitude_equivalence \"rotation\"",
            );
        }
        let boresights = self.attitudes.boresights;
        let boresight = format!("{pointer}/boresight");
        let axis = boresight_axis(&spec.boresight, boresights, &boresight, findings);
        let aim = self.aim(spec, pointer, findings);
        let range = roll_range(spec, pointer, findings);
        let (axis, aim, range) = (axis?, aim?, range?);
        (!signed).then(|| Orientation::of(axis, pointed(aim, axis), range))
    }

    fn aim(&self, spec: &PointingSpec, pointer: &str, findings: &mut Findings) -> Option<Aim> {
        let place = format!("{pointer}/direction");
        let hint = "give direction as a vector, or ra_dec_deg";
        match (&spec.direction, spec.ra_dec_deg) {
            (Some(direction), None) => {
                let vector = self.sky.direction(direction, &place, findings)?;
                Some(match *direction {
                    DirectionSpec::RaDecDeg(angles) => Aim::RaDecDeg(angles),
                    DirectionSpec::Vector(_) | DirectionSpec::Body(_) => Aim::Direction(vector),
                })
            }
            (None, Some(angles)) => {
                let spec = DirectionSpec::RaDecDeg(angles);
                self.sky.direction(&spec, pointer, findings)?;
                Some(Aim::RaDecDeg(angles))
            }
            (None, None) => {
                let message = "it is not said where the boresight points";
                findings.refuse(place, Code::MissingField, message, hint);
                None
            }
            (Some(_), Some(_)) => {
                let message = "both direction and ra_dec_deg are given";
                findings.refuse(place, Code::ConflictingFields, message, hint);
                None
            }
        }
    }
}

impl Orientation {
    /// Of a boresight, the attitude of roll 0, and limits. Those within twice the tolerance of
    /// the checker make an attitude.
    fn of(axis: Vector3<f64>, level: Attitude, RollLimits(limits): RollLimits) -> Self {
        let turned = |by: f64| {
            let range = limits.map(|limits| limits.map(|limit| (limit - by).to_radians()));
            FreeRoll { axis, range }
        };
        let middle = limits.map_or(0.0, |[low, high]| 0.5 * low + 0.5 * high);
        // Whole turns are taken off in degrees, where they are exact.
        let roll = turned(360.0 * (middle / 360.0).round());
        let only = roll
            .range
            .filter(|[low, high]| high - low <= 2.0 * ATTITUDE_TOLERANCE);
        let attitude = only.map_or(level, |[low, high]| roll.rolled(&level, 0.5 * (low + high)));
        Self {
            attitude,
            roll: only.is_none().then_some(roll),
            pointing: Some(Pointing {
                level,
                roll: turned(0.0),
            }),
        }
    }
}

/// Limits of a roll, degrees; `None` where every roll is admissible.
#[derive(Debug, Clone, Copy)]
struct RollLimits(Option<[f64; 2]>);

/// The limits that are given.
fn roll_range(spec: &PointingSpec, pointer: &str, findings: &mut Findings) -> Option<RollLimits> {
    let places = ["roll_min_deg", "roll_max_deg"].map(|name| format!("{pointer}/{name}"));
    let limits = [spec.roll_min_deg, spec.roll_max_deg];
    let mut finite = true;
    for (place, limit) in places.iter().zip(limits) {
        finite &= limit.is_none_or(|limit| findings.finite(place, limit).is_some());
    }
    let [low, high] = match limits {
        [None, None] => return Some(RollLimits(None)),
        [Some(low), Some(high)] => [low, high],
        [given, _] => {
            let missing = usize::from(given.is_some());
            findings.refuse(
                &places[missing],
                Code::MissingField,
                "one limit of the roll excludes none, since whole turns are the same roll",
                "give both limits, or neither for every roll",
            );
            return None;
        }
    };
    if finite && low > high {
        findings.refuse(
            &places[0],
            Code::EmptyRange,
            format!("the least roll of {low} degrees is above the greatest of {high} degrees"),
            "exchange the limits; a range across 180 degrees is one such as 170 to 190",
        );
    }
    if !finite || low > high {
        return None;
    }
    let limited = high - low < 360.0;
    Some(RollLimits(limited.then_some([low, high])))
}
