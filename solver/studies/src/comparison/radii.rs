//! Radii of the spheres that represent the envelopes of a pyramid of four devices.

use super::study::pyramid_envelopes;
use crate::cmg::CmgCluster;
use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::input::{
    InputForm, InputPlace, Schema, input_object, input_union, or, required,
};

/// Kind of devices of a pyramid, and how they are controlled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum PyramidControl {
    /// Wheels, slews about the eigenaxis, allocation by the pseudo-inverse.
    #[strum(serialize = "rw_eigenaxis")]
    Eigenaxis,
    /// Wheels, time-optimal slews, allocation by the pseudo-inverse.
    #[strum(serialize = "rw_pseudo_optimal")]
    PseudoOptimal,
    /// Wheels, time-optimal slews with any allocation.
    #[strum(serialize = "rw_optimal")]
    Optimal,
    /// Control moment gyroscopes, within the sphere inside their internal singularities.
    #[strum(serialize = "cmg")]
    Gyroscopes,
}

impl PyramidControl {
    /// All of them, the gyroscopes last.
    pub const ALL: [Self; 4] = [
        Self::Eigenaxis,
        Self::PseudoOptimal,
        Self::Optimal,
        Self::Gyroscopes,
    ];
}

input_object! {
    /// Body momentum and torque as multiples of a device's.
    #[derive(Copy)]
    pub struct Radius as "GivenRadius" {
        /// Of momentum.
        pub momentum: f64 = required().at_least(1e-9).at_most(1e9),
        /// Of torque.
        pub torque: f64 = required().at_least(1e-9).at_most(1e9),
    }
}

/// The radii of all controls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radii {
    /// [`PyramidControl::Eigenaxis`].
    pub eigenaxis: Radius,
    /// [`PyramidControl::PseudoOptimal`].
    pub pseudo_optimal: Radius,
    /// [`PyramidControl::Optimal`].
    pub optimal: Radius,
    /// [`PyramidControl::Gyroscopes`].
    pub gyroscopes: Radius,
}

input_union! {
    /// Body momentum and torque of a pyramid of four, as multiples of a device's.
    enum RadiiSpec as "ComparisonRadii" {
        /// As published.
        Published = "published",
        /// From envelopes and singular surfaces.
        Computed = "computed",
        /// Those that are left out are as published.
        Given = "given" {
            /// Of wheels, slews about the eigenaxis, allocation by the pseudo-inverse.
            rw_eigenaxis: Radius = or(Radii::PUBLISHED.eigenaxis),
            /// Of wheels, time-optimal slews, allocation by the pseudo-inverse.
            rw_pseudo_optimal: Radius = or(Radii::PUBLISHED.pseudo_optimal),
            /// Of wheels, time-optimal slews with any allocation.
            rw_optimal: Radius = or(Radii::PUBLISHED.optimal),
            /// Of control moment gyroscopes.
            cmg: Radius = or(Radii::PUBLISHED.gyroscopes),
        },
    }
}

impl InputForm for Radii {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        match RadiiSpec::read(place)? {
            RadiiSpec::Published => Some(Self::PUBLISHED),
            RadiiSpec::Computed => Self::of_the_pyramid(),
            RadiiSpec::Given {
                rw_eigenaxis,
                rw_pseudo_optimal,
                rw_optimal,
                cmg,
            } => Some(Self {
                eigenaxis: rw_eigenaxis,
                pseudo_optimal: rw_pseudo_optimal,
                optimal: rw_optimal,
                gyroscopes: cmg,
            }),
        }
    }

    fn schema() -> Schema {
        RadiiSpec::schema()
    }
}

impl Radii {
    /// The thesis's radii, equations 270 and 271. (In the computation of the rate of 4.067 deg/s it has
    /// 1.807 instead of 1.805.)
    pub const PUBLISHED: Self = Self {
        eigenaxis: Radius {
            momentum: 1.333,
            torque: 1.333,
        },
        pseudo_optimal: Radius {
            momentum: 1.577,
            torque: 1.333,
        },
        optimal: Radius {
            momentum: 1.805,
            torque: 1.333,
        },
        gyroscopes: Radius {
            momentum: 1.007,
            torque: 1.007,
        },
    };

    /// Computed from the envelopes and the singular surfaces of the thesis's pyramid: inscribed spheres
    /// or spheres of equal volume, and for gyroscopes the exact sphere by the thesis's definition
    /// ([`CmgCluster::least_with_one_reversed`]). Always `Some` for this pyramid.
    #[must_use]
    pub fn of_the_pyramid() -> Option<Self> {
        let envelopes = pyramid_envelopes()?;
        let torque = envelopes.pseudo_inverse.inscribed_radius;
        let sphere = CmgCluster::thesis().least_with_one_reversed();
        let wheels = |momentum| Radius { momentum, torque };
        Some(Self {
            eigenaxis: wheels(envelopes.pseudo_inverse.inscribed_radius),
            pseudo_optimal: wheels(envelopes.pseudo_inverse.equal_volume_radius),
            optimal: wheels(envelopes.full.equal_volume_radius),
            gyroscopes: Radius {
                momentum: sphere,
                torque: sphere,
            },
        })
    }

    /// The radii of a kind of control.
    #[must_use]
    pub fn of(&self, control: PyramidControl) -> Radius {
        match control {
            PyramidControl::Eigenaxis => self.eigenaxis,
            PyramidControl::PseudoOptimal => self.pseudo_optimal,
            PyramidControl::Optimal => self.optimal,
            PyramidControl::Gyroscopes => self.gyroscopes,
        }
    }

    /// Refuses every radius that is not above zero.
    pub(super) fn check(&self, pointer: &str, findings: &mut Findings) {
        for control in PyramidControl::ALL {
            let radius = self.of(control);
            let at = format!("{pointer}/{control}");
            findings.positive(&format!("{at}/momentum"), radius.momentum);
            findings.positive(&format!("{at}/torque"), radius.torque);
        }
    }
}
