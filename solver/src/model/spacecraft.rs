//! A rigid spacecraft with reaction wheels, valid by construction.
//!
//! Symbols and dynamics (all vectors in body axes):
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `J` | inertia of the whole spacecraft, wheels locked | kg m² |
//! | `a_i`, `I_i` | spin axis and spin inertia of wheel `i` | -, kg m² |
//! | `W_i` | wheel speed relative to the body | rad/s |
//! | `w` | body rate | rad/s |
//! | `h_i = I_i (W_i + a_i . w)` | momentum of wheel `i` about its axis | N m s |
//! | `u_i = h_i'` | motor torque on wheel `i` | N m |
//! | `J_eff = J - sum I_i a_i a_i^T` | inertia without the enabled wheels' spin | kg m² |
//!
//! Total momentum `J_eff w + sum a_i h_i + (locked wheels)` is constant in the reference frame.

mod inertia;
mod wheels;

pub(crate) use wheels::MAX_ENABLED;
pub use wheels::MAX_WHEELS;

use crate::model::findings::Findings;
use crate::model::problem::{Code, Problem};
use crate::model::spec::{BoresightSpec, SpacecraftSpec};
use nalgebra::{DMatrix, Matrix3, Vector3};
use std::collections::HashSet;

/// Limit of the boresights of a spacecraft.
pub const MAX_BORESIGHTS: usize = 100;

/// A valid wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Spin axis as it enters the equations (unit length unless the caller asked otherwise).
    pub axis: Vector3<f64>,
    /// Spin inertia, kg m².
    pub inertia: f64,
    /// Smallest motor torque, N m, below zero.
    pub min_torque: f64,
    /// Largest motor torque, N m, above zero.
    pub max_torque: f64,
    /// Limit of the speed relative to the body, rad/s; infinite when unlimited.
    pub max_speed: f64,
    /// Whether the wheel may be commanded; otherwise it is locked at its start speed.
    pub enabled: bool,
}

/// A named body axis of unit length.
#[derive(Debug, Clone, PartialEq)]
pub struct Boresight {
    /// Its name.
    pub name: String,
    /// Unit direction in body axes.
    pub axis: Vector3<f64>,
}

/// A valid spacecraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacecraft {
    inertia: Matrix3<f64>,
    inertia_inverse: Matrix3<f64>,
    effective_inertia: Matrix3<f64>,
    effective_inertia_inverse: Matrix3<f64>,
    wheels: Vec<Wheel>,
    axes_inverse: DMatrix<f64>,
    max_rate: Vector3<f64>,
    max_rate_norm: f64,
    boresights: Vec<Boresight>,
}

impl Spacecraft {
    /// Validates a description and collects every problem; `pointer` is its JSON pointer.
    ///
    /// # Errors
    ///
    /// All problems at once, in the order of the document.
    pub fn try_new(spec: &SpacecraftSpec, pointer: &str) -> Result<Self, Vec<Problem>> {
        let mut findings = Findings::default();
        let spacecraft = Self::read(spec, pointer, &mut findings);
        findings
            .conclude(spacecraft)
            .map(|(spacecraft, _)| spacecraft)
    }

    /// Like [`Spacecraft::try_new`], for a reader of a larger description.
    pub fn read(spec: &SpacecraftSpec, pointer: &str, findings: &mut Findings) -> Option<Self> {
        let inertia_pointer = format!("{pointer}/inertia_kg_m2");
        let inertia = inertia::read(&spec.inertia_kg_m2, &inertia_pointer, findings);
        let max_rate = axis_limits(spec, pointer, findings);
        let norm_pointer = format!("{pointer}/max_body_rate_norm_rad_s");
        let max_rate_norm = limit(spec.max_body_rate_norm_rad_s, &norm_pointer, findings);
        let wheels_pointer = format!("{pointer}/wheels");
        let wheels = wheels::read(&spec.wheels, &wheels_pointer, findings);
        let effective = match (&inertia, &wheels) {
            (Some((inertia, _)), Some((wheels, _))) => {
                wheels::effective_inertia(inertia, wheels, &wheels_pointer, findings)
            }
            _ => None,
        };
        let boresights_pointer = format!("{pointer}/boresights");
        let boresights = boresights(&spec.boresights, &boresights_pointer, findings);
        let (effective_inertia, effective_inertia_inverse) = effective?;
        let (inertia, inertia_inverse) = inertia?;
        let (wheels, axes_inverse) = wheels?;
        Some(Self {
            inertia,
            inertia_inverse,
            effective_inertia,
            effective_inertia_inverse,
            wheels,
            axes_inverse,
            max_rate: max_rate?,
            max_rate_norm: max_rate_norm?,
            boresights: boresights?,
        })
    }

    /// Inertia of the whole spacecraft with its wheels locked, kg m².
    #[must_use]
    pub fn inertia(&self) -> &Matrix3<f64> {
        &self.inertia
    }

    /// Its inverse, 1/(kg m²).
    pub(crate) fn inertia_inverse(&self) -> &Matrix3<f64> {
        &self.inertia_inverse
    }

    /// `J_eff`, kg m².
    #[must_use]
    pub fn effective_inertia(&self) -> &Matrix3<f64> {
        &self.effective_inertia
    }

    /// Inverse of `J_eff`, 1/(kg m²).
    #[must_use]
    pub fn effective_inertia_inverse(&self) -> &Matrix3<f64> {
        &self.effective_inertia_inverse
    }

    /// All wheels, disabled ones included, in the caller's order.
    #[must_use]
    pub fn wheels(&self) -> &[Wheel] {
        &self.wheels
    }

    /// The enabled wheels with their index among all wheels.
    pub fn enabled_wheels(&self) -> impl Iterator<Item = (usize, &Wheel)> {
        self.wheels.iter().enumerate().filter(|(_, w)| w.enabled)
    }

    /// Pseudo-inverse of the axes of the enabled wheels as they enter the equations, as columns:
    /// one row per enabled wheel.
    pub(crate) fn axes_inverse(&self) -> &DMatrix<f64> {
        &self.axes_inverse
    }

    /// Limit of each body rate component, rad/s; infinite where unlimited.
    #[must_use]
    pub fn max_rate(&self) -> Vector3<f64> {
        self.max_rate
    }

    /// Limit of the norm of the body rate, rad/s; infinite when unlimited.
    #[must_use]
    pub fn max_rate_norm(&self) -> f64 {
        self.max_rate_norm
    }

    /// Named instrument axes.
    #[must_use]
    pub fn boresights(&self) -> &[Boresight] {
        &self.boresights
    }

    /// Total angular momentum in body axes, N m s, of a body rate (rad/s) and wheel speeds
    /// relative to the body (rad/s, one per wheel): `J w + sum a_i I_i W_i`.
    #[must_use]
    pub fn body_momentum(&self, rate: Vector3<f64>, wheel_speed: &[f64]) -> Vector3<f64> {
        let spin: Vector3<f64> = self
            .wheels
            .iter()
            .zip(wheel_speed)
            .map(|(wheel, speed)| wheel.axis * (wheel.inertia * speed))
            .sum();
        self.inertia * rate + spin
    }
}

/// An optional limit above zero; infinite when there is none.
fn limit(value: Option<f64>, pointer: &str, findings: &mut Findings) -> Option<f64> {
    match value {
        None => Some(f64::INFINITY),
        Some(value) => findings.positive(pointer, value),
    }
}

fn axis_limits(
    spec: &SpacecraftSpec,
    pointer: &str,
    findings: &mut Findings,
) -> Option<Vector3<f64>> {
    let mut limits = Vector3::repeat(f64::INFINITY);
    let mut valid = true;
    for (i, value) in spec.max_body_rate_rad_s.into_iter().enumerate() {
        match limit(
            value,
            &format!("{pointer}/max_body_rate_rad_s/{i}"),
            findings,
        ) {
            Some(value) => limits[i] = value,
            None => valid = false,
        }
    }
    valid.then_some(limits)
}

fn boresights(
    specs: &[BoresightSpec],
    pointer: &str,
    findings: &mut Findings,
) -> Option<Vec<Boresight>> {
    if !findings.at_most(pointer, specs.len(), MAX_BORESIGHTS) {
        return None;
    }
    let mut names = HashSet::new();
    // All are read before they are collected: collecting into an option stops at the first fault.
    let read: Vec<_> = specs
        .iter()
        .enumerate()
        .map(|(i, spec)| {
            let name_pointer = format!("{pointer}/{i}/name");
            if spec.name.is_empty() {
                findings.refuse(
                    &name_pointer,
                    Code::MissingField,
                    "the boresight's name is empty",
                    "give each boresight a name by which keep-out cones can refer to it",
                );
            } else if !names.insert(spec.name.as_str()) {
                findings.refuse(
                    &name_pointer,
                    Code::DuplicateId,
                    format!("another boresight is already named \"{}\"", spec.name),
                    "give each boresight a name of its own",
                );
            }
            let axis = findings.direction(&format!("{pointer}/{i}/axis"), spec.axis)?;
            Some(Boresight {
                name: spec.name.clone(),
                axis,
            })
        })
        .collect();
    read.into_iter().collect()
}

#[cfg(test)]
mod tests;
