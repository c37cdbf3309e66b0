//! The arrays of a spacecraft's wheels, of torque and of momentum, with their envelopes.

use super::{Envelopes, WheelArray, check_authority};
use crate::model::problem::Problem;
use crate::model::spacecraft::Spacecraft;

/// An array with its envelopes, computed once.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopedArray {
    /// The wheels with their limits.
    pub array: WheelArray,
    /// Their envelopes.
    pub envelopes: Envelopes,
}

impl From<WheelArray> for EnvelopedArray {
    fn from(array: WheelArray) -> Self {
        Self {
            envelopes: array.envelopes(),
            array,
        }
    }
}

/// Arrays and envelopes of the enabled wheels of a spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub struct SpacecraftEnvelopes {
    /// Of torque, N m.
    pub torque: EnvelopedArray,
    /// Of momentum relative to the body, N m s. `None` when an enabled wheel has no speed limit: the
    /// envelope would be unbounded.
    pub momentum: Option<EnvelopedArray>,
}

impl SpacecraftEnvelopes {
    /// Those of a spacecraft with the usable shares of its torque and speed limits.
    ///
    /// # Errors
    ///
    /// Every share that is not in (0, 1]; pointers are those of a scenario's options.
    pub fn of(
        spacecraft: &Spacecraft,
        torque_authority: f64,
        momentum_authority: f64,
    ) -> Result<Self, Vec<Problem>> {
        let problems = authority_problems(torque_authority, momentum_authority);
        if !problems.is_empty() {
            return Err(problems);
        }
        let limited = spacecraft
            .enabled_wheels()
            .all(|(_, wheel)| wheel.max_speed.is_finite());
        let momentum = limited.then(|| WheelArray::momentum(spacecraft, momentum_authority));
        Ok(Self {
            torque: WheelArray::torque(spacecraft, torque_authority)?.into(),
            momentum: momentum.transpose()?.map(EnvelopedArray::from),
        })
    }
}

/// Problems with the usable shares of torque and speed limits.
#[must_use]
pub fn authority_problems(torque: f64, momentum: f64) -> Vec<Problem> {
    let shares = [
        ("/options/torque_authority", torque),
        ("/options/momentum_authority", momentum),
    ];
    let checked = shares.map(|(pointer, share)| check_authority(pointer, share).err());
    checked.into_iter().flatten().flatten().collect()
}
