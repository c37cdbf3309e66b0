//! What a pyramid of four devices counts with: spheres of momentum and torque.

use super::study::pyramid_envelopes;
use crate::cmg::CmgCluster;
use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::input::{
    InputForm, InputPlace, Schema, input_object, input_union, or, required,
};

/// How a pyramid of devices is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Wheels, slews about the eigenaxis, shared out by the pseudo-inverse.
    Eigenaxis,
    /// Wheels, time-optimal slews within what the pseudo-inverse shares out.
    PseudoOptimal,
    /// Wheels, time-optimal slews.
    Optimal,
    /// Control moment gyroscopes, within the sphere inside their internal singularities.
    Gyroscopes,
}

impl Control {
    /// All of them, the gyroscopes last.
    pub const ALL: [Self; 4] = [
        Self::Eigenaxis,
        Self::PseudoOptimal,
        Self::Optimal,
        Self::Gyroscopes,
    ];

    /// The stable text of the control.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Eigenaxis => "rw_eigenaxis",
            Self::PseudoOptimal => "rw_pseudo_optimal",
            Self::Optimal => "rw_optimal",
            Self::Gyroscopes => "cmg",
        }
    }
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
    /// [`Control::Eigenaxis`].
    pub eigenaxis: Radius,
    /// [`Control::PseudoOptimal`].
    pub pseudo_optimal: Radius,
    /// [`Control::Optimal`].
    pub optimal: Radius,
    /// [`Control::Gyroscopes`].
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
            /// Of wheels, slews about the eigenaxis.
            rw_eigenaxis: Radius = or(Radii::PUBLISHED.eigenaxis),
            /// Of wheels, time-optimal slews within what the pseudo-inverse shares out.
            rw_pseudo_optimal: Radius = or(Radii::PUBLISHED.pseudo_optimal),
            /// Of wheels, time-optimal slews.
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
    /// As the thesis uses them, equations 270 and 271. (Where it computes the rate of 4.067 deg/s it
    /// writes 1.807 for 1.805.)
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

    /// Computed from the envelopes and the singular surfaces of the thesis's pyramid: spheres inside
    /// or of equal volume, and for gyroscopes the exact sphere in the sense of the thesis
    /// ([`CmgCluster::least_with_one_reversed`]). `None` never, for this pyramid.
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

    /// Those of a control.
    #[must_use]
    pub fn of(&self, control: Control) -> Radius {
        match control {
            Control::Eigenaxis => self.eigenaxis,
            Control::PseudoOptimal => self.pseudo_optimal,
            Control::Optimal => self.optimal,
            Control::Gyroscopes => self.gyroscopes,
        }
    }

    /// Notes every radius that is not above zero.
    pub(super) fn check(&self, pointer: &str, findings: &mut Findings) {
        for control in Control::ALL {
            let radius = self.of(control);
            let at = format!("{pointer}/{}", control.as_str());
            findings.positive(&format!("{at}/momentum"), radius.momentum);
            findings.positive(&format!("{at}/torque"), radius.torque);
        }
    }
}
