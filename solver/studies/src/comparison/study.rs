//! The whole study of wheels against gyroscopes, with the tables of devices.

use super::{Comparison, ComparisonStudySpec, Laws, MassPoint, MassStudy, PyramidControl, Radii};
use crate::catalogue::{Device, GYROSCOPES, PowerLaw, WHEELS};
use crate::cmg::{CmgCluster, MAX_SURFACE_ROWS, SingularSurface};
use nalgebra::Vector3;
use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::wheels::array::{PolytopeSize, WheelArray, WheelRange};

/// Range of all positive numbers of a request; within it no result overflows.
const RANGE: (f64, f64) = (1e-9, 1e9);
/// Greatest exponent of a law.
const STEEPEST: f64 = 8.0;
/// Momenta per decade of the default curve of advantage angles, and its ends as powers of ten.
const PER_DECADE: i32 = 8;
const DECADES: (i32, i32) = (-3, 1);
/// Default number of rows of the singular surfaces.
pub(super) const SURFACE_ROWS: usize = 12;

/// Default momenta of a device (N m s) at which the advantage angle is computed.
pub(super) fn default_curve_momenta_nms() -> Vec<f64> {
    let (from, to) = DECADES;
    let power = |i| 10_f64.powf(f64::from(from) + f64::from(i) / f64::from(PER_DECADE));
    (0..=PER_DECADE * (to - from)).map(power).collect()
}

/// Default masses of a device (kg) at which arrays are compared.
pub(super) fn default_device_masses_kg() -> Vec<f64> {
    vec![0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]
}

/// The advantage angle of one control over the momentum of a device.
#[derive(Debug, Clone, PartialEq)]
pub struct AdvantageCurve {
    /// Control of the wheels.
    pub control: PyramidControl,
    /// Angle (rad) at each momentum of the request; `None` where wheels are never faster.
    pub angles_rad: Vec<Option<f64>>,
}

/// Envelopes of the thesis's pyramid of wheels, in units of a wheel's momentum or torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PyramidEnvelopes {
    /// The full envelope.
    pub full: PolytopeSize,
    /// The pseudo-inverse-limited envelope.
    pub pseudo_inverse: PolytopeSize,
}

/// Singular states of the thesis's pyramid of gyroscopes, in units of a rotor's momentum.
#[derive(Debug, Clone, PartialEq)]
pub struct SingularStates {
    /// The greatest momentum in any direction.
    pub greatest_momentum: f64,
    /// Radius of the sphere below all states with one rotor reversed ([`CmgCluster`]).
    pub least_with_one_reversed: f64,
    /// Radius of the sphere below all states that null motion cannot leave.
    pub least_elliptic: f64,
    /// One surface per pattern of signs, the outer one first.
    pub surfaces: Vec<SingularSurface>,
}

impl SingularStates {
    /// The radius of the sphere that the thesis takes from its grid.
    pub const PUBLISHED_SPHERE: f64 = 1.0069;
}

/// Laws of a kind of devices: torque (N m) over momentum (N m s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogueFit {
    /// As published.
    pub published: PowerLaw,
    /// Fitted to the table.
    pub of_the_table: PowerLaw,
}

/// The results of the study.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonStudy {
    /// The request.
    pub spec: ComparisonStudySpec,
    /// Rates, accelerations, slews and advantage angles.
    pub comparison: Comparison,
    /// One entry per control of wheels.
    pub advantage_curves: Vec<AdvantageCurve>,
    /// Radii computed from the envelopes, for comparison with those of the request.
    pub computed_radii: Radii,
    /// Envelopes of the pyramid of wheels.
    pub envelopes: PyramidEnvelopes,
    /// Singular states of the pyramid of gyroscopes.
    pub singular: SingularStates,
    /// Laws of wheels.
    pub wheel_fit: CatalogueFit,
    /// Laws of gyroscopes.
    pub gyroscope_fit: CatalogueFit,
    /// Momentum and torque over mass.
    pub mass: MassStudy,
    /// One entry per mass of the request.
    pub mass_points: Vec<MassPoint>,
}

impl ComparisonStudy {
    /// Compares wheels and gyroscopes; always `Some` for the tables and pyramids of the thesis.
    ///
    /// # Errors
    ///
    /// All problems of the request at once, with pointers as of [`Comparison::of`] and
    /// `/curve_momenta_nms`, `/device_masses_kg`, `/surface_rows`.
    pub fn of(spec: ComparisonStudySpec) -> Result<Option<Self>, Vec<Problem>> {
        let mut findings = Findings::default();
        check(&spec, &mut findings);
        let comparison = Comparison::of(spec.clone())
            .map_err(|problems| findings.include(problems))
            .ok();
        let (comparison, _) = findings.conclude(comparison)?;
        let curves = Comparison::of(ComparisonStudySpec {
            momenta_nms: spec.curve_momenta_nms.clone(),
            // Advantage angles do not depend on them, and a list must not be empty.
            angles_rad: vec![1.0],
            ..spec.clone()
        })?;
        Ok(Self::conduct(spec, comparison, &curves))
    }

    fn conduct(
        spec: ComparisonStudySpec,
        comparison: Comparison,
        curves: &Comparison,
    ) -> Option<Self> {
        let ComparisonStudySpec { radii, laws, .. } = spec;
        let mass = MassStudy::of(radii, laws)?;
        let table = Laws::of_the_tables()?;
        Some(Self {
            advantage_curves: advantage_curves(curves),
            computed_radii: Radii::of_the_pyramid()?,
            envelopes: pyramid_envelopes()?,
            singular: singular_states(spec.surface_rows),
            wheel_fit: CatalogueFit {
                published: Laws::PUBLISHED.wheel,
                of_the_table: table.wheel,
            },
            gyroscope_fit: CatalogueFit {
                published: Laws::PUBLISHED.gyroscope,
                of_the_table: table.gyroscope,
            },
            mass_points: spec.device_masses_kg.iter().map(|&m| mass.at(m)).collect(),
            mass,
            comparison,
            spec,
        })
    }

    /// The devices that the laws are fitted to: wheels, gyroscopes.
    #[must_use]
    pub const fn devices() -> (&'static [Device], &'static [Device]) {
        (&WHEELS, &GYROSCOPES)
    }
}

/// Envelopes of the thesis's pyramid of wheels; always `Some` for this pyramid.
pub(super) fn pyramid_envelopes() -> Option<PyramidEnvelopes> {
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let axes = [[s, 0.0, c], [0.0, s, c], [-s, 0.0, c], [0.0, -s, c]];
    let ranges = axes.map(|axis| WheelRange::symmetric(Vector3::from(axis), 1.0));
    let envelopes = WheelArray::try_new(&ranges, "").ok()?.envelopes();
    Some(PyramidEnvelopes {
        full: envelopes.full.size(),
        pseudo_inverse: envelopes.pseudo_inverse.size(),
    })
}

fn singular_states(rows: usize) -> SingularStates {
    let cluster = CmgCluster::thesis();
    let patterns = cluster.sign_patterns();
    SingularStates {
        greatest_momentum: cluster.greatest_momentum(),
        least_with_one_reversed: cluster.least_with_one_reversed(),
        least_elliptic: cluster.least_elliptic(),
        surfaces: patterns
            .iter()
            .map(|signs| cluster.singular_surface(signs, rows))
            .collect(),
    }
}

fn advantage_curves(curves: &Comparison) -> Vec<AdvantageCurve> {
    let wheels = &PyramidControl::ALL[..PyramidControl::ALL.len() - 1];
    let curve = |(index, &control): (usize, &PyramidControl)| AdvantageCurve {
        control,
        angles_rad: curves
            .sizes
            .iter()
            .map(|size| size.advantages[index].angle_rad)
            .collect(),
    };
    wheels.iter().enumerate().map(curve).collect()
}

fn check(spec: &ComparisonStudySpec, findings: &mut Findings) {
    super::check_list("curve_momenta_nms", &spec.curve_momenta_nms, findings);
    super::check_list("device_masses_kg", &spec.device_masses_kg, findings);

    for (name, values) in [
        ("momenta_nms", &spec.momenta_nms),
        ("angles_rad", &spec.angles_rad),
        ("curve_momenta_nms", &spec.curve_momenta_nms),
        ("device_masses_kg", &spec.device_masses_kg),
    ] {
        for (i, &value) in values.iter().enumerate() {
            within(&format!("/{name}/{i}"), value, findings);
        }
    }
    within("/required_rate_rad_s", spec.required_rate_rad_s, findings);
    for control in PyramidControl::ALL {
        let radius = spec.radii.of(control);
        within(
            &format!("/radii/{control}/momentum"),
            radius.momentum,
            findings,
        );
        within(&format!("/radii/{control}/torque"), radius.torque, findings);
    }
    for (name, law) in [
        ("wheel", spec.laws.wheel),
        ("gyroscope", spec.laws.gyroscope),
    ] {
        within(&format!("/laws/{name}/factor"), law.factor, findings);
        if law.exponent.abs() > STEEPEST {
            findings.refuse(
                format!("/laws/{name}/exponent"),
                Code::OutOfRange,
                format!("the exponent is {}", law.exponent),
                format!("give an exponent from -{STEEPEST} to {STEEPEST}"),
            );
        }
    }
    if !(1..=MAX_SURFACE_ROWS).contains(&spec.surface_rows) {
        findings.refuse(
            "/surface_rows",
            Code::OutOfRange,
            format!("there are {} rows", spec.surface_rows),
            format!("give 1 to {MAX_SURFACE_ROWS} rows"),
        );
    }
}

/// Refuses a positive number out of range; other numbers are refused elsewhere.
fn within(pointer: &str, value: f64, findings: &mut Findings) {
    let (least, most) = RANGE;
    if value > 0.0 && value.is_finite() && !(least..=most).contains(&value) {
        findings.refuse(
            pointer,
            Code::OutOfRange,
            format!("the number is {value:e}"),
            format!("give a value from {least:e} to {most:e}"),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_study_has_the_published_numbers() {
        let study = ComparisonStudy::of(ComparisonStudySpec::default())
            .unwrap()
            .unwrap();
        let full = study.envelopes.full;
        assert!((full.volume - 128.0 / (3.0 * 3.0_f64.sqrt())).abs() < 1e-9);
        assert!((study.envelopes.pseudo_inverse.inscribed_radius - 4.0 / 3.0).abs() < 1e-9);
        assert!((study.singular.greatest_momentum - 3.266).abs() < 1e-3);
        assert_eq!(study.singular.surfaces.len(), 8);
        assert_eq!(study.singular.surfaces[0].states.len(), 2 * 12 * 12);
        let crossover = study.mass.crossover_kg().unwrap();
        assert!((crossover - 0.908).abs() < 1e-3, "{crossover}");
        // The curve is that of the sizes: 0.1 N m s is its seventeenth point.
        let curve = &study.advantage_curves[2];
        assert_eq!(curve.control, PyramidControl::Optimal);
        let of_size = study.comparison.sizes[1].advantages[2].angle_rad.unwrap();
        assert!((curve.angles_rad[16].unwrap() - of_size).abs() < 1e-9);
        let angles: Vec<f64> = curve.angles_rad.iter().map(|a| a.unwrap()).collect();
        assert!(angles.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn every_problem_is_found_once() {
        let mut spec = ComparisonStudySpec {
            curve_momenta_nms: Vec::new(),
            surface_rows: MAX_SURFACE_ROWS + 1,
            device_masses_kg: vec![1.0, 1e300],
            ..ComparisonStudySpec::default()
        };
        spec.laws.wheel.exponent = 9.0;
        spec.required_rate_rad_s = -1.0;
        spec.momenta_nms = vec![1e-300];
        let problems = ComparisonStudy::of(spec).unwrap_err();
        let mut places: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
        places.sort_unstable();
        assert_eq!(
            places,
            [
                "/curve_momenta_nms",
                "/device_masses_kg/1",
                "/laws/wheel/exponent",
                "/momenta_nms/0",
                "/required_rate_rad_s",
                "/surface_rows",
            ]
        );
    }

    #[test]
    fn requests_at_the_ends_of_the_range_have_finite_results() {
        let mut spec = ComparisonStudySpec {
            surface_rows: 1,
            ..ComparisonStudySpec::default()
        };
        spec.momenta_nms = vec![1e-9, 1e9];
        spec.angles_rad = vec![1e-9, 1e9];
        spec.laws.wheel = PowerLaw {
            factor: 1e9,
            exponent: 8.0,
        };
        let study = ComparisonStudy::of(spec).unwrap().unwrap();
        for size in &study.comparison.sizes {
            assert!(
                size.agilities
                    .iter()
                    .all(|a| a.acceleration_rad_s2.is_finite())
            );
            let durations = size.slews.iter().flat_map(|slew| &slew.durations_s);
            assert!(durations.into_iter().all(|t| t.is_finite() && *t > 0.0));
        }
        assert!(
            study
                .mass_points
                .iter()
                .all(|p| p.wheel_torque_nm.is_finite())
        );
    }
}
