//! Arrays of wheels, and their envelopes of torque and momentum.
//!
//! Every wheel `i` can take any amount between two limits along its axis, torque in N m or momentum in
//! N m s, and the array takes the sum (RW/CMG thesis, equation 86):
//!
//! ```text
//!   y = A x,      least_i <= x_i <= most_i,      A: axes as columns, 3 x K
//! ```
//!
//! The set of all `y`, in body axes, is a zonotope: the *full* envelope. Allocated by the
//! pseudo-inverse, `x = A^+ y` (equation 87), only the smaller set `{y : least <= A^+ y <= most}` is
//! within the limits: the *pseudo-inverse-limited* envelope. Both are computed exactly, facet by facet
//! ([`Polytope`]), without sampling.
//!
//! Amounts are those of the wheels; the body gets the opposite, which for limits of equal size in both
//! directions is the same set. Locked wheels do not contribute.

mod half_spaces;
mod mean_radius;
mod of_spacecraft;
mod polytope;
mod size;
mod zonotope;

pub use of_spacecraft::authority_problems;
pub use of_spacecraft::{EnvelopedArray, SpacecraftEnvelopes};
pub use polytope::{Facet, Polytope};
pub use size::PolytopeSize;

use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};
use crate::model::spacecraft::{Spacecraft, Wheel};
use crate::model::wheel_axes;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Axis and limits of one wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelRange {
    /// `a_i`: axis in body axes, of unit length or any other of the same order.
    pub axis: Vector3<f64>,
    /// Least amount, below zero.
    pub least: f64,
    /// Greatest amount, above zero.
    pub most: f64,
}

impl WheelRange {
    /// A range with limits of equal size in both directions.
    #[must_use]
    pub fn symmetric(axis: Vector3<f64>, most: f64) -> Self {
        Self {
            axis,
            least: -most,
            most,
        }
    }
}

/// The wheels of an array with their limits, valid by construction.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelArray {
    ranges: Vec<WheelRange>,
    /// Position of each range among all wheels of the spacecraft.
    places: Vec<usize>,
    /// Number of all wheels of the spacecraft.
    wheels: usize,
    /// `A^+`, K x 3.
    inverse: DMatrix<f64>,
}

/// The two envelopes of an array.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelopes {
    /// The full envelope.
    pub full: Polytope,
    /// The pseudo-inverse-limited envelope.
    pub pseudo_inverse: Polytope,
}

impl WheelArray {
    /// An array of given wheels; `pointer` is that of their list.
    ///
    /// # Errors
    ///
    /// All problems at once: numbers that are not finite, ranges that do not have zero inside, axes
    /// that do not span space.
    pub fn try_new(ranges: &[WheelRange], pointer: &str) -> Result<Self, Vec<Problem>> {
        let mut findings = Findings::default();
        // All ranges are checked before any result is used, so that every problem is found.
        let valid: Vec<bool> = ranges
            .iter()
            .enumerate()
            .map(|(i, range)| is_valid(range, &format!("{pointer}/{i}"), &mut findings))
            .collect();
        let array = valid.iter().all(|&valid| valid).then(|| {
            let axes: Vec<_> = ranges.iter().map(|range| range.axis).collect();
            Some(Self {
                ranges: ranges.to_vec(),
                places: (0..ranges.len()).collect(),
                wheels: ranges.len(),
                inverse: wheel_axes::pseudo_inverse(&axes)?,
            })
        });
        if array == Some(None) {
            findings.refuse(
                pointer,
                Code::WheelAxesCoplanar,
                format!("the axes of the {} wheels do not span space", ranges.len()),
                "give at least three wheels whose axes do not lie in a plane",
            );
        }
        findings.conclude(array.flatten()).map(|(array, _)| array)
    }

    /// The torques, N m, that the motors of the enabled wheels give; `authority` is the usable share
    /// of the limits.
    ///
    /// # Errors
    ///
    /// An authority that is not in (0, 1]; the pointer is that of a scenario's option.
    pub fn torque(spacecraft: &Spacecraft, authority: f64) -> Result<Self, Vec<Problem>> {
        check_authority("/options/torque_authority", authority)?;
        Ok(Self::of_wheels(spacecraft, |wheel| WheelRange {
            axis: wheel.axis,
            least: wheel.min_torque * authority,
            most: wheel.max_torque * authority,
        }))
    }

    /// The momenta relative to the body, N m s, that the enabled wheels hold; `authority` is the
    /// usable share of the speed limits.
    ///
    /// # Errors
    ///
    /// An authority that is not in (0, 1], or one problem per enabled wheel without a speed limit: the
    /// envelope would be unbounded. Pointers are those of a scenario.
    pub fn momentum(spacecraft: &Spacecraft, authority: f64) -> Result<Self, Vec<Problem>> {
        check_authority("/options/momentum_authority", authority)?;
        let unlimited: Vec<_> = spacecraft
            .enabled_wheels()
            .filter(|(_, wheel)| wheel.max_speed.is_infinite())
            .map(|(i, _)| {
                Problem::new(
                    format!("/spacecraft/wheels/{i}/max_speed_rad_s"),
                    Code::MissingField,
                    format!("wheel {i} has no speed limit, so its array has no momentum envelope"),
                    "give the wheel a speed limit, or disable it",
                )
            })
            .collect();
        if !unlimited.is_empty() {
            return Err(unlimited);
        }
        Ok(Self::of_wheels(spacecraft, |wheel| {
            WheelRange::symmetric(wheel.axis, wheel.inertia * wheel.max_speed * authority)
        }))
    }

    fn of_wheels(spacecraft: &Spacecraft, range: impl Fn(&Wheel) -> WheelRange) -> Self {
        let (places, ranges) = spacecraft
            .enabled_wheels()
            .map(|(i, wheel)| (i, range(wheel)))
            .unzip();
        Self {
            ranges,
            places,
            wheels: spacecraft.wheels().len(),
            inverse: spacecraft.axes_inverse().clone(),
        }
    }

    /// Axis and limits of each wheel of the array.
    #[must_use]
    pub fn ranges(&self) -> &[WheelRange] {
        &self.ranges
    }

    /// `A`: the axes as columns, 3 x K.
    #[must_use]
    pub fn axes(&self) -> DMatrix<f64> {
        columns(&self.ranges)
    }

    /// `A^+`, K x 3.
    #[must_use]
    pub fn pseudo_inverse(&self) -> &DMatrix<f64> {
        &self.inverse
    }

    /// The sum over the wheels, `A x`, in body axes, of one amount for every wheel of the
    /// spacecraft; those of locked wheels are not read.
    ///
    /// # Panics
    ///
    /// When there are fewer amounts than wheels.
    #[must_use]
    pub fn sum(&self, amounts: &[f64]) -> Vector3<f64> {
        self.ranges
            .iter()
            .zip(&self.places)
            .map(|(range, &place)| range.axis * amounts[place])
            .sum()
    }

    /// Amounts of the array's wheels as amounts of all wheels of the spacecraft, zero for locked
    /// ones.
    pub(crate) fn spread(&self, amounts: &DVector<f64>) -> Vec<f64> {
        let mut all = vec![0.0; self.wheels];
        for (&place, amount) in self.places.iter().zip(amounts.iter()) {
            all[place] = *amount;
        }
        all
    }

    /// Greatest amount of a wheel as a share of its limit; at most one within the limits.
    pub(crate) fn load(&self, amounts: &DVector<f64>) -> f64 {
        let limits = self.ranges.iter();
        wheel_axes::greatest_share(limits.map(|range| (range.least, range.most)), amounts)
    }

    /// The sets of all `y`, full and limited by the pseudo-inverse.
    #[must_use]
    pub fn envelopes(&self) -> Envelopes {
        Envelopes {
            full: self.full_envelope(),
            pseudo_inverse: self.pseudo_inverse_envelope(),
        }
    }

    /// The set of all `y = A x`.
    #[must_use]
    pub fn full_envelope(&self) -> Polytope {
        let middle = |range: &WheelRange| range.axis * (0.5 * (range.most + range.least));
        let half = |range: &WheelRange| range.axis * (0.5 * (range.most - range.least));
        let generators: Vec<_> = self.ranges.iter().map(half).collect();
        zonotope::zonotope(self.ranges.iter().map(middle).sum(), &generators)
    }

    /// The set `{y : least <= A^+ y <= most}`.
    #[must_use]
    pub fn pseudo_inverse_envelope(&self) -> Polytope {
        let planes: Vec<_> = self
            .ranges
            .iter()
            .zip(self.inverse.row_iter())
            .flat_map(|(range, row)| {
                let row = Vector3::new(row[0], row[1], row[2]);
                let (normal, size) = (row.normalize(), row.norm());
                [(normal, range.most / size), (-normal, -range.least / size)]
            })
            .collect();
        half_spaces::polytope(&planes)
    }
}

/// The axes as columns.
fn columns(ranges: &[WheelRange]) -> DMatrix<f64> {
    DMatrix::from_fn(3, ranges.len(), |row, column| ranges[column].axis[row])
}

fn is_valid(range: &WheelRange, pointer: &str, findings: &mut Findings) -> bool {
    let axis = wheel_axes::read(&format!("{pointer}/axis"), range.axis.into(), findings);
    let mut side = |name: &str, value: f64, sign: f64| {
        let at = format!("{pointer}/{name}");
        let value = findings.finite(&at, value);
        let wrong = value.filter(|value| value * sign <= 0.0);
        if let Some(value) = wrong {
            findings.refuse(
                &at,
                Code::EmptyRange,
                format!("the limit is {value}, zero must lie inside the range"),
                "give a least amount below 0 and a greatest amount above 0",
            );
        }
        value.is_some() && wrong.is_none()
    };
    let (least, most) = (
        side("least", range.least, -1.0),
        side("most", range.most, 1.0),
    );
    axis.is_some() && least && most
}

fn check_authority(pointer: &str, authority: f64) -> Result<(), Vec<Problem>> {
    if authority > 0.0 && authority <= 1.0 {
        return Ok(());
    }
    Err(vec![Problem::new(
        pointer,
        Code::OutOfRange,
        format!("the authority is {authority}, it must be above 0 and at most 1"),
        "give the share of the wheels' limits that may be used",
    )])
}

/// Two orthonormal vectors that make a right-handed frame with a unit normal.
fn plane_axes(normal: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    (first, normal.cross(&first))
}

/// Three normals as the rows of a matrix.
fn rows(normals: [&Vector3<f64>; 3]) -> Matrix3<f64> {
    Matrix3::from_rows(&normals.map(Vector3::transpose))
}

#[cfg(test)]
mod tests;
