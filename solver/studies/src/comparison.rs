//! Reaction wheels against control moment gyroscopes: from which angle on wheels turn a spacecraft
//! faster (RW/CMG thesis, chapter VII).
//!
//! Four pyramids of devices of the same momentum `h` turn the same spacecraft, whose inertia is such
//! that wheels with eigenaxis control just reach a required rate (equation 272). The envelope of a
//! pyramid is represented by a sphere: body momentum and torque are multiples of a device's ([`Radii`];
//! equations 270 and 271). The torque of a device follows from its momentum by a law fitted to the
//! catalogue ([`crate::catalogue`]). A slew is bang-coast-bang within rate and acceleration:
//!
//! ```text
//!   J = r_eigenaxis h / w_required,     w = r h / J,     w' = r_torque tau(h) / J
//! ```
//!
//! Gyroscopes accelerate faster, wheels hold more momentum and coast faster, so that wheels are faster
//! beyond some angle, the *advantage angle*.
//!
//! # Published and computed advantage angles
//!
//! | `h`, N m s | control | published | computed | with a cut-off |
//! |---|---|---|---|---|
//! | 0.1 | time-optimal | 77 | 83.4 | 80.5 |
//! | 0.01 | time-optimal | 24.1 | 25.5 | 24.9 |
//! | 0.01 | eigenaxis | 30.3 | 31.8 | 30.5 |
//!
//! The computed angles follow from the thesis's own radii, laws and trapezoid. The published ones were
//! read off simulated slews (its figures 80 and 82), and its simulation ends a trapezoid when 0.999 of
//! the angle is turned (as stated for figure 71). This cuts off the end of the last ramp, which is
//! longer for wheels than for gyroscopes: the last column, from [`Advantage::with_cut_off_rad`]. It
//! explains most of the difference for the eigenaxis and about half of it for the time-optimal slews;
//! the rest, 3 to 4 %, is unexplained.

mod mass;
mod radii;
mod study;

pub use mass::{MassPoint, MassStudy};
pub use radii::{PyramidControl, Radii, Radius};
pub use study::{AdvantageCurve, CatalogueFit, ComparisonStudy, PyramidEnvelopes, SingularStates};

use crate::catalogue::{GYROSCOPES, PowerLaw, WHEELS};
use slewplan_solver::math::bang_coast_bang::BangCoastBang;
use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::input::{
    self, InputForm, InputPlace, Schema, UpTo, input_object, input_union, or,
};
use slewplan_solver::model::problem::{Code, Problem};

/// Share of the angle that remains when the thesis's simulated slews end.
pub const CUT_OFF: f64 = 0.001;
/// Bisections for an advantage angle: enough for rounding accuracy.
const BISECTIONS: usize = 60;
/// Greatest number of entries of a list in a request.
const MAX_ENTRIES: usize = 10_000;

/// A published advantage angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedAngle {
    /// Momentum of a device, N m s.
    pub momentum_nms: f64,
    /// Control of the wheels.
    pub control: PyramidControl,
    /// The angle, degrees.
    pub angle_deg: f64,
}

/// The advantage angles that the thesis prints.
pub const PUBLISHED_ANGLES: [PublishedAngle; 3] = [
    PublishedAngle {
        momentum_nms: 0.1,
        control: PyramidControl::Optimal,
        angle_deg: 77.0,
    },
    PublishedAngle {
        momentum_nms: 0.01,
        control: PyramidControl::Optimal,
        angle_deg: 24.1,
    },
    PublishedAngle {
        momentum_nms: 0.01,
        control: PyramidControl::Eigenaxis,
        angle_deg: 30.3,
    },
];

/// Torque (N m) of a device over its momentum (N m s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Laws {
    /// Of a wheel.
    pub wheel: PowerLaw,
    /// Of a gyroscope.
    pub gyroscope: PowerLaw,
}

input_union! {
    /// Torque (N m) over momentum (N m s) of a device.
    enum LawsSpec as "ComparisonLaws" {
        /// As published.
        Published = "published",
        /// Fitted to the tables of devices.
        Tables = "tables",
        /// Those that are left out are as published.
        Given = "given" {
            /// Of a wheel.
            wheel: PowerLaw = or(Laws::PUBLISHED.wheel),
            /// Of a gyroscope.
            gyroscope: PowerLaw = or(Laws::PUBLISHED.gyroscope),
        },
    }
}

impl InputForm for Laws {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        match LawsSpec::read(place)? {
            LawsSpec::Published => Some(Self::PUBLISHED),
            LawsSpec::Tables => Self::of_the_tables(),
            LawsSpec::Given { wheel, gyroscope } => Some(Self { wheel, gyroscope }),
        }
    }

    fn schema() -> Schema {
        LawsSpec::schema()
    }
}

impl Laws {
    /// Equations 268 and 269.
    pub const PUBLISHED: Self = Self {
        wheel: PowerLaw::PUBLISHED_WHEEL,
        gyroscope: PowerLaw::PUBLISHED_GYROSCOPE,
    };

    /// Fitted to the thesis's tables; always `Some` for these tables.
    #[must_use]
    pub fn of_the_tables() -> Option<Self> {
        let torque = |devices| PowerLaw::of_devices(devices, |d| d.momentum_nms, |d| d.torque_nm);
        Some(Self {
            wheel: torque(&WHEELS)?,
            gyroscope: torque(&GYROSCOPES)?,
        })
    }

    fn of(&self, control: PyramidControl) -> PowerLaw {
        match control {
            PyramidControl::Gyroscopes => self.gyroscope,
            _ => self.wheel,
        }
    }
}

/// Greatest number of entries of a list in a document.
const MAX_LISTED: usize = 1000;
/// Greatest number of circles of latitude of the singular surfaces in an answer: eight surfaces of some
/// 300 kB.
pub const MAX_ROWS: usize = 40;

input_object! {
    /// Wheels against control moment gyroscopes. What is left out is as in the published study.
    pub struct ComparisonStudySpec as "ComparisonStudy" {
        /// Momenta of a device; 1, 0.1 and 0.01 without it.
        pub momenta_nms: Vec<f64> as UpTo<MAX_LISTED, f64>
            = or(vec![1.0, 0.1, 0.01]).min_length(1),
        /// Angles of the slews that are compared; every degree to a half turn without it.
        pub angles_rad: Vec<f64> as UpTo<MAX_LISTED, f64> = or(default_angles_rad()).min_length(1),
        /// Rate that sizes the spacecraft: wheels with eigenaxis control just reach it. 3 deg/s without
        /// it.
        pub required_rate_rad_s: f64 = or(3.0_f64.to_radians()).at_least(1e-9).at_most(1e9),
        /// Body momentum and torque of the pyramids; as published without it.
        pub radii: Radii = or(Radii::PUBLISHED),
        /// Torque of a device over its momentum; as published without it.
        pub laws: Laws = or(Laws::PUBLISHED),
        /// Momenta of a device at which the advantage angle is computed; 0.001 to 10 without it.
        pub curve_momenta_nms: Vec<f64> as UpTo<MAX_LISTED, f64>
            = or(study::default_curve_momenta_nms()).min_length(1),
        /// Masses of a device at which arrays are compared; 0.1 to 100 without it.
        pub device_masses_kg: Vec<f64> as UpTo<MAX_LISTED, f64>
            = or(study::default_device_masses_kg()).min_length(1),
        /// Circles of latitude of the singular surfaces.
        pub surface_rows: usize
            = or(study::SURFACE_ROWS).at_least(1.0).at_most(MAX_ROWS as f64).format("int32"),
    }
}

impl Default for ComparisonStudySpec {
    /// The thesis's comparison: 1, 0.1 and 0.01 N m s, every degree to a half turn, 3 deg/s.
    fn default() -> Self {
        input::left_out::<Self>()
    }
}

fn default_angles_rad() -> Vec<f64> {
    let degrees = 1..=180;
    degrees.map(|angle| f64::from(angle).to_radians()).collect()
}

/// Rate and acceleration of a spacecraft with one kind of control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agility {
    /// The control.
    pub control: PyramidControl,
    /// Body momentum, N m s.
    pub momentum_nms: f64,
    /// Body torque, N m.
    pub torque_nm: f64,
    /// Rate, rad/s.
    pub rate_rad_s: f64,
    /// Acceleration, rad/s².
    pub acceleration_rad_s2: f64,
}

impl Agility {
    /// The slew from rest to rest by an angle, rad, above zero.
    #[must_use]
    pub fn slew(&self, angle: f64) -> BangCoastBang {
        BangCoastBang::fastest(angle, self.acceleration_rad_s2, self.rate_rad_s)
    }

    /// The angle, rad, beyond which this control is faster than another, where slews end with the share
    /// `left` (below a half) of their angle left. Zero when it always is faster, `None` when it never is.
    #[must_use]
    pub fn advantage_over(&self, other: &Self, left: f64) -> Option<f64> {
        if self.rate_rad_s <= other.rate_rad_s {
            return None;
        }
        if self.acceleration_rad_s2 >= other.acceleration_rad_s2 {
            return Some(0.0);
        }
        // A trapezoid takes at least angle / rate and at most angle / rate + rate / acceleration: beyond
        // this angle this control is faster.
        let slower = 1.0 / other.rate_rad_s - 1.0 / self.rate_rad_s;
        let (mut behind, mut ahead) = (0.0, self.rate_rad_s / self.acceleration_rad_s2 / slower);
        for _ in 0..BISECTIONS {
            let angle = 0.5 * (behind + ahead);
            if self.slew(angle).time_with_left(left) > other.slew(angle).time_with_left(left) {
                behind = angle;
            } else {
                ahead = angle;
            }
        }
        Some(ahead)
    }
}

/// The angle beyond which wheels are faster than gyroscopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advantage {
    /// Control of the wheels.
    pub control: PyramidControl,
    /// The angle, rad, which may exceed a half turn, the largest slew. `None` when wheels never are.
    pub angle_rad: Option<f64>,
    /// The angle, rad, when slews end with [`CUT_OFF`] of their angle left, as in the thesis.
    pub with_cut_off_rad: Option<f64>,
}

/// Durations of slews with one kind of control.
#[derive(Debug, Clone, PartialEq)]
pub struct Durations {
    /// The control.
    pub control: PyramidControl,
    /// One duration per angle of the request, s.
    pub durations_s: Vec<f64>,
}

/// The comparison for devices of one momentum.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeComparison {
    /// Momentum of a device, N m s.
    pub momentum_nms: f64,
    /// Inertia of the spacecraft, kg m².
    pub inertia_kg_m2: f64,
    /// One entry per control, in the order of [`PyramidControl::ALL`].
    pub agilities: Vec<Agility>,
    /// One entry per control.
    pub slews: Vec<Durations>,
    /// One entry per control of wheels.
    pub advantages: Vec<Advantage>,
}

/// A whole comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The request.
    pub spec: ComparisonStudySpec,
    /// One entry per momentum.
    pub sizes: Vec<SizeComparison>,
}

impl Comparison {
    /// Compares.
    ///
    /// # Errors
    ///
    /// All problems of the request at once.
    pub fn of(spec: ComparisonStudySpec) -> Result<Self, Vec<Problem>> {
        let mut findings = Findings::default();
        for (name, values) in [
            ("momenta_nms", &spec.momenta_nms),
            ("angles_rad", &spec.angles_rad),
        ] {
            check_list(name, values, &mut findings);
        }
        findings.positive("/required_rate_rad_s", spec.required_rate_rad_s);
        spec.radii.check("/radii", &mut findings);
        for (name, law) in [
            ("wheel", spec.laws.wheel),
            ("gyroscope", spec.laws.gyroscope),
        ] {
            findings.positive(&format!("/laws/{name}/factor"), law.factor);
            findings.finite(&format!("/laws/{name}/exponent"), law.exponent);
        }
        findings.conclude(Some(()))?;
        let sizes = spec.momenta_nms.iter().map(|&h| size(&spec, h)).collect();
        Ok(Self { spec, sizes })
    }
}

fn size(spec: &ComparisonStudySpec, momentum: f64) -> SizeComparison {
    let inertia =
        spec.radii.of(PyramidControl::Eigenaxis).momentum * momentum / spec.required_rate_rad_s;
    let agilities = PyramidControl::ALL.map(|control| {
        let radius = spec.radii.of(control);
        let momentum_nms = radius.momentum * momentum;
        let torque_nm = radius.torque * spec.laws.of(control).at(momentum);
        Agility {
            control,
            momentum_nms,
            torque_nm,
            rate_rad_s: momentum_nms / inertia,
            acceleration_rad_s2: torque_nm / inertia,
        }
    });
    let [wheels @ .., gyroscopes] = &agilities;
    let advantage = |wheels: &Agility| Advantage {
        control: wheels.control,
        angle_rad: wheels.advantage_over(gyroscopes, 0.0),
        with_cut_off_rad: wheels.advantage_over(gyroscopes, CUT_OFF),
    };
    let durations = |agility: &Agility| Durations {
        control: agility.control,
        durations_s: spec
            .angles_rad
            .iter()
            .map(|&a| agility.slew(a).duration())
            .collect(),
    };
    SizeComparison {
        momentum_nms: momentum,
        inertia_kg_m2: inertia,
        slews: agilities.iter().map(durations).collect(),
        advantages: wheels.iter().map(advantage).collect(),
        agilities: agilities.to_vec(),
    }
}

fn check_list(name: &str, values: &[f64], findings: &mut Findings) {
    let pointer = format!("/{name}");
    if values.is_empty() {
        findings.refuse(
            &pointer,
            Code::WrongLength,
            "the list is empty",
            "give at least one number",
        );
    }
    findings.at_most(&pointer, values.len(), MAX_ENTRIES);
    for (i, &value) in values.iter().enumerate() {
        findings.positive(&format!("{pointer}/{i}"), value);
    }
}

#[cfg(test)]
mod tests;
