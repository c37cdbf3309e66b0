//! Wheels against gyroscopes: the answer, with every table that it rests on.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::wheels::array::PolytopeSize;
use slewplan_studies::catalogue::{Device, PowerLaw};
use slewplan_studies::cmg::SingularSurface;
use slewplan_studies::comparison::{
    Advantage, AdvantageCurve, Agility, CUT_OFF, CatalogueFit, ComparisonStudy, Durations,
    MassPoint, MassStudy, PUBLISHED_ANGLES, PyramidControl, Radius, SingularStates, SizeComparison,
};
use utoipa::ToSchema;

/// Wheels against control moment gyroscopes. Controls are `rw_eigenaxis`, `rw_pseudo_optimal`,
/// `rw_optimal` and `cmg`.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonStudyAnswer)]
pub(crate) struct ComparisonAnswerDocument {
    required_rate_rad_s: Number,
    /// Angles of the slews whose durations are in `sizes`.
    angles_rad: Vec<Number>,
    radii: Vec<RadiusDocument>,
    envelopes: EnvelopesDocument,
    singular_states: SingularStatesDocument,
    market: CatalogueDocument,
    sizes: Vec<SizeDocument>,
    /// Share of the angle that slews leave out for `with_cut_off_rad`, as in the published study.
    cut_off: Number,
    advantage: AdvantageCurvesDocument,
    mass: MassDocument,
}

/// Body momentum and torque of a pyramid as multiples of a device's.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonRadius)]
struct RadiusDocument {
    control: &'static str,
    momentum: Number,
    torque: Number,
    /// What the envelopes and singular surfaces give, whatever was asked for.
    computed_momentum: Number,
    computed_torque: Number,
}

/// Envelopes of the pyramid of wheels, in units of a wheel's momentum or torque.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PyramidEnvelopes)]
struct EnvelopesDocument {
    full: FiguresDocument,
    /// Of what the pseudo-inverse shares out.
    pseudo_inverse: FiguresDocument,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PyramidFigures)]
struct FiguresDocument {
    inscribed_radius: Number,
    greatest_radius: Number,
    equal_volume_radius: Number,
    mean_radius: Number,
    volume: Number,
}

/// Singular states of the pyramid of gyroscopes, in units of a rotor's momentum.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SingularStates)]
struct SingularStatesDocument {
    greatest_momentum: Number,
    /// Radius of the sphere inside all states with one rotor reversed: what the published study
    /// counts on.
    least_with_one_reversed: Number,
    published_sphere: Number,
    /// Radius of the sphere inside all states that null motion cannot leave.
    least_elliptic: Number,
    /// One for each pattern of signs, the outer one first.
    surfaces: Vec<SurfaceDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SingularSurface)]
struct SurfaceDocument {
    /// Whether each rotor's momentum is along the direction or against it.
    signs: Vec<bool>,
    /// Circles of latitude, each with twice as many points; states are row by row.
    rows: usize,
    /// `null` where the direction is along a gimbal axis.
    states: Vec<Option<SingularStateDocument>>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SingularState)]
struct SingularStateDocument {
    /// In which no torque can be made, body axes.
    direction: [Number; 3],
    momentum: [Number; 3],
    /// `external`, `elliptic` (null motion cannot leave it) or `hyperbolic`.
    kind: &'static str,
}

/// Devices of the tables, and laws of torque (N m) over momentum (N m s) fitted to them.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonMarket)]
struct CatalogueDocument {
    wheel: FitDocument,
    gyroscope: FitDocument,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = MarketFit)]
struct FitDocument {
    /// The law that was asked for.
    used: LawDocument,
    published: LawDocument,
    of_the_table: LawDocument,
    devices: Vec<DeviceDocument>,
}

/// `y = factor x^exponent`.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonLaw)]
struct LawDocument {
    factor: Number,
    exponent: Number,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = MarketDevice)]
struct DeviceDocument {
    manufacturer: &'static str,
    model: &'static str,
    mass_kg: Number,
    momentum_nms: Number,
    torque_nm: Number,
}

/// Devices of one momentum.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonSize)]
struct SizeDocument {
    momentum_nms: Number,
    inertia_kg_m2: Number,
    controls: Vec<ControlDocument>,
    /// One for each control of wheels.
    advantages: Vec<AdvantageDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonControl)]
struct ControlDocument {
    control: &'static str,
    body_momentum_nms: Number,
    body_torque_nm: Number,
    rate_rad_s: Number,
    acceleration_rad_s2: Number,
    /// One for each of `angles_rad`.
    durations_s: Vec<Number>,
}

/// From which angle on wheels are faster; `null` when never.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ComparisonAdvantage)]
struct AdvantageDocument {
    control: &'static str,
    angle_rad: Option<Number>,
    with_cut_off_rad: Option<Number>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = AdvantageCurves)]
struct AdvantageCurvesDocument {
    momenta_nms: Vec<Number>,
    curves: Vec<CurveDocument>,
    published: Vec<PublishedDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = AdvantageCurve)]
struct CurveDocument {
    control: &'static str,
    /// One for each of `momenta_nms`; `null` where wheels never win.
    angles_rad: Vec<Option<Number>>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PublishedAdvantage)]
struct PublishedDocument {
    control: &'static str,
    momentum_nms: Number,
    angle_rad: Number,
}

/// Arrays of four devices over the mass of a device.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = MassStudy)]
struct MassDocument {
    /// Momentum (N m s) of a device over its mass (kg).
    wheel_momentum: LawDocument,
    gyroscope_momentum: LawDocument,
    /// Body torque (N m) over the mass of a device (kg).
    wheel_torque: LawDocument,
    gyroscope_torque: LawDocument,
    /// Mass of a device below which wheels give more torque.
    crossover_kg: Option<Number>,
    published_crossover_kg: Number,
    points: Vec<MassPointDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = MassPoint)]
struct MassPointDocument {
    device_mass_kg: Number,
    array_mass_kg: Number,
    wheel_momentum_nms: Number,
    gyroscope_momentum_nms: Number,
    wheel_torque_nm: Number,
    gyroscope_torque_nm: Number,
}

impl ComparisonAnswerDocument {
    /// The answer to a study.
    pub(crate) fn new(study: &ComparisonStudy) -> Self {
        let of = &study.spec;
        let (wheels, gyroscopes) = ComparisonStudy::devices();
        let radius = |control: PyramidControl| {
            let Radius { momentum, torque } = of.radii.of(control);
            let computed = study.computed_radii.of(control);
            RadiusDocument {
                control: control.into(),
                momentum: Number(momentum),
                torque: Number(torque),
                computed_momentum: Number(computed.momentum),
                computed_torque: Number(computed.torque),
            }
        };
        Self {
            required_rate_rad_s: Number(of.required_rate_rad_s),
            angles_rad: Number::all(&of.angles_rad),
            radii: PyramidControl::ALL.map(radius).into(),
            envelopes: EnvelopesDocument {
                full: study.envelopes.full.into(),
                pseudo_inverse: study.envelopes.pseudo_inverse.into(),
            },
            singular_states: (&study.singular).into(),
            market: CatalogueDocument {
                wheel: FitDocument::new(of.laws.wheel, study.wheel_fit, wheels),
                gyroscope: FitDocument::new(of.laws.gyroscope, study.gyroscope_fit, gyroscopes),
            },
            sizes: study
                .comparison
                .sizes
                .iter()
                .map(SizeDocument::from)
                .collect(),
            cut_off: Number(CUT_OFF),
            advantage: AdvantageCurvesDocument::new(study),
            mass: MassDocument::new(&study.mass, &study.mass_points),
        }
    }
}

impl From<PolytopeSize> for FiguresDocument {
    fn from(figures: PolytopeSize) -> Self {
        Self {
            inscribed_radius: Number(figures.inscribed_radius),
            greatest_radius: Number(figures.greatest_radius),
            equal_volume_radius: Number(figures.equal_volume_radius),
            mean_radius: Number(figures.mean_radius),
            volume: Number(figures.volume),
        }
    }
}

impl From<&SingularStates> for SingularStatesDocument {
    fn from(states: &SingularStates) -> Self {
        Self {
            greatest_momentum: Number(states.greatest_momentum),
            least_with_one_reversed: Number(states.least_with_one_reversed),
            published_sphere: Number(SingularStates::PUBLISHED_SPHERE),
            least_elliptic: Number(states.least_elliptic),
            surfaces: states.surfaces.iter().map(SurfaceDocument::from).collect(),
        }
    }
}

impl From<&SingularSurface> for SurfaceDocument {
    fn from(surface: &SingularSurface) -> Self {
        let states = surface.states.iter().map(|state| {
            state.as_ref().map(|state| SingularStateDocument {
                direction: <[f64; 3]>::from(state.direction).map(Number),
                momentum: <[f64; 3]>::from(state.momentum).map(Number),
                kind: state.passability.into(),
            })
        });
        Self {
            signs: surface.signs.clone(),
            rows: surface.rows,
            states: states.collect(),
        }
    }
}

impl FitDocument {
    fn new(used: PowerLaw, fit: CatalogueFit, devices: &[Device]) -> Self {
        Self {
            used: used.into(),
            published: fit.published.into(),
            of_the_table: fit.of_the_table.into(),
            devices: devices.iter().map(DeviceDocument::from).collect(),
        }
    }
}

impl From<PowerLaw> for LawDocument {
    fn from(law: PowerLaw) -> Self {
        Self {
            factor: Number(law.factor),
            exponent: Number(law.exponent),
        }
    }
}

impl From<&Device> for DeviceDocument {
    fn from(device: &Device) -> Self {
        Self {
            manufacturer: device.manufacturer,
            model: device.model,
            mass_kg: Number(device.mass_kg),
            momentum_nms: Number(device.momentum_nms),
            torque_nm: Number(device.torque_nm),
        }
    }
}

impl From<&SizeComparison> for SizeDocument {
    fn from(size: &SizeComparison) -> Self {
        let controls = size.agilities.iter().zip(&size.slews);
        Self {
            momentum_nms: Number(size.momentum_nms),
            inertia_kg_m2: Number(size.inertia_kg_m2),
            controls: controls.map(ControlDocument::from).collect(),
            advantages: size
                .advantages
                .iter()
                .map(AdvantageDocument::from)
                .collect(),
        }
    }
}

impl From<(&Agility, &Durations)> for ControlDocument {
    fn from((agility, slews): (&Agility, &Durations)) -> Self {
        Self {
            control: agility.control.into(),
            body_momentum_nms: Number(agility.momentum_nms),
            body_torque_nm: Number(agility.torque_nm),
            rate_rad_s: Number(agility.rate_rad_s),
            acceleration_rad_s2: Number(agility.acceleration_rad_s2),
            durations_s: Number::all(&slews.durations_s),
        }
    }
}

impl From<&Advantage> for AdvantageDocument {
    fn from(advantage: &Advantage) -> Self {
        Self {
            control: advantage.control.into(),
            angle_rad: advantage.angle_rad.map(Number),
            with_cut_off_rad: advantage.with_cut_off_rad.map(Number),
        }
    }
}

impl AdvantageCurvesDocument {
    fn new(study: &ComparisonStudy) -> Self {
        let published = PUBLISHED_ANGLES.iter().map(|angle| PublishedDocument {
            control: angle.control.into(),
            momentum_nms: Number(angle.momentum_nms),
            angle_rad: Number(angle.angle_deg.to_radians()),
        });
        Self {
            momenta_nms: Number::all(&study.spec.curve_momenta_nms),
            curves: study
                .advantage_curves
                .iter()
                .map(CurveDocument::from)
                .collect(),
            published: published.collect(),
        }
    }
}

impl From<&AdvantageCurve> for CurveDocument {
    fn from(curve: &AdvantageCurve) -> Self {
        let angles = curve.angles_rad.iter();
        Self {
            control: curve.control.into(),
            angles_rad: angles.map(|angle| angle.map(Number)).collect(),
        }
    }
}

impl MassDocument {
    fn new(study: &MassStudy, points: &[MassPoint]) -> Self {
        Self {
            wheel_momentum: study.wheel_momentum.into(),
            gyroscope_momentum: study.gyroscope_momentum.into(),
            wheel_torque: study.wheel_torque().into(),
            gyroscope_torque: study.gyroscope_torque().into(),
            // Laws that are almost parallel cross beyond all numbers.
            crossover_kg: study.crossover_kg().filter(|kg| kg.is_finite()).map(Number),
            published_crossover_kg: Number(MassStudy::PUBLISHED_CROSSOVER_KG),
            points: points.iter().map(MassPointDocument::from).collect(),
        }
    }
}

impl From<&MassPoint> for MassPointDocument {
    fn from(point: &MassPoint) -> Self {
        Self {
            device_mass_kg: Number(point.device_mass_kg),
            array_mass_kg: Number(point.array_mass_kg),
            wheel_momentum_nms: Number(point.wheel_momentum_nms),
            gyroscope_momentum_nms: Number(point.gyroscope_momentum_nms),
            wheel_torque_nm: Number(point.wheel_torque_nm),
            gyroscope_torque_nm: Number(point.gyroscope_torque_nm),
        }
    }
}
