//! The answer to a study of envelopes.

use super::EnvelopeRequest;
use crate::documents::number::Number;
use crate::documents::problems::{ProblemDocument, documents};
use nalgebra::Vector3;
use serde::Serialize;
use slewplan_solver::wheels::allocation::DemandAllocation;
use slewplan_solver::wheels::array::{EnvelopedArray, Facet, Polytope};
use slewplan_studies::eigenaxis::EigenaxisBaseline;
use slewplan_studies::envelope_path::{EnvelopePath, MomentumSample, TorqueStep};
use slewplan_studies::envelope_study::{DemandReport, EnvelopeReport, TimeOptimalSlew, TurnReport};
use utoipa::ToSchema;

/// What the wheels can do together. Torques and momenta are sums over the enabled wheels of what they
/// take up and hold, in body axes; the body gets the opposite.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = EnvelopeStudyAnswer)]
pub(crate) struct EnvelopeAnswerDocument<'a> {
    /// Whether every slew is there: false when time ran out, or nobody waited any longer.
    complete: bool,
    torque: ArrayDocument,
    /// `null` with an enabled wheel without a speed limit: there is no end to it.
    momentum: Option<ArrayDocument>,
    /// In the order of the request.
    turns: Vec<TurnDocument<'a>>,
    /// In the order of the request.
    demands: Vec<DemandDocument>,
    warnings: Vec<ProblemDocument<'a>>,
}

/// The envelopes of an array of wheels, with the usable shares of its limits.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ArrayEnvelopes)]
struct ArrayDocument {
    /// Unit of radii, distances and vertices; volumes are in its cube.
    unit: &'static str,
    /// What the wheels can give.
    full: EnvelopeDocument,
    /// What they give when the pseudo-inverse of their axes shares it out.
    pseudo_inverse: EnvelopeDocument,
}

/// A convex polytope about the origin.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Envelope)]
struct EnvelopeDocument {
    /// Of the largest sphere inside: what is there in every direction.
    inscribed_radius: Number,
    /// Of the sphere of the same volume.
    equal_volume_radius: Number,
    /// Mean over all directions of what is there.
    mean_radius: Number,
    /// Distance of the farthest vertex.
    greatest_radius: Number,
    volume: Number,
    vertices: Vec<[Number; 3]>,
    facets: Vec<FacetDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = EnvelopeFacet)]
struct FacetDocument {
    /// Outward unit vector.
    normal: [Number; 3],
    /// Of its plane from the origin.
    distance: Number,
    /// Positions of its corners in `vertices`, counter-clockwise seen from outside.
    vertices: Vec<usize>,
}

/// A turn from rest to rest, without stored momentum, in all its ways.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = StudiedTurn)]
struct TurnDocument<'a> {
    angle_rad: Number,
    /// Unit vector, body axes.
    axis: [Number; 3],
    /// About the eigenaxis, by what limits the slew: `pseudo_inverse_sphere`, `pseudo_inverse`,
    /// `full_sphere`, `full`.
    eigenaxis: Vec<EigenaxisDocument>,
    /// In minimum time, where that was asked for: with torques free of each other (`free`), and with
    /// those that the pseudo-inverse shares out (`pseudo_inverse`).
    time_optimal: Vec<TimeOptimalDocument<'a>>,
}

/// Acceleration, coast and braking about a fixed axis.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = EigenaxisSlew)]
struct EigenaxisDocument {
    limit: &'static str,
    duration_s: Number,
    rate_rad_s: Number,
    acceleration_rad_s2: Number,
    /// Duration of the acceleration, and of the braking.
    ramp_s: Number,
    peak_momentum_nms: [Number; 3],
    /// While the body accelerates; the opposite while it brakes.
    ramp_torque_nm: [Number; 3],
    path: PathDocument,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = TimeOptimalSlew)]
struct TimeOptimalDocument<'a> {
    allocation: &'static str,
    /// Whether a local minimum was found and its flight keeps all limits and arrives.
    solved: bool,
    /// How the program ended: `converged`, or why not.
    status: &'a str,
    duration_s: Option<Number>,
    path: Option<PathDocument>,
}

/// The way of a slew through the envelopes. A share is 1 on the surface of an envelope and more
/// beyond it.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = EnvelopePath)]
struct PathDocument {
    /// Straight between the samples; empty where momentum has no envelope.
    momentum: Vec<MomentumDocument>,
    /// Constant on each interval.
    torque: Vec<TorqueDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = MomentumSample)]
struct MomentumDocument {
    time_s: Number,
    momentum_nms: [Number; 3],
    full_share: Number,
    pseudo_inverse_share: Number,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = TorqueStep)]
struct TorqueDocument {
    start_s: Number,
    duration_s: Number,
    torque_nm: [Number; 3],
    full_share: Number,
    pseudo_inverse_share: Number,
}

/// A torque shared out among the wheels.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = AllocatedDemand)]
struct DemandDocument {
    demand_nm: [Number; 3],
    /// With the least sum of squares.
    pseudo_inverse: AllocationDocument,
    /// With the least load, by a linear program; `null` when that could not be solved.
    least_load: Option<AllocationDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = WheelAllocation)]
struct AllocationDocument {
    /// One for each wheel; zero for disabled ones.
    wheel_torque_nm: Vec<Number>,
    /// Largest share of its usable limit that a wheel needs; beyond 1 the wheels cannot do it.
    load: Number,
}

impl<'a> EnvelopeAnswerDocument<'a> {
    /// The answer to a request.
    pub(crate) fn new(request: &'a EnvelopeRequest, report: &'a EnvelopeReport) -> Self {
        let envelopes = &report.envelopes;
        let momentum = envelopes.momentum.as_ref();
        Self {
            complete: report.complete,
            torque: ArrayDocument::new("N m", &envelopes.torque),
            momentum: momentum.map(|array| ArrayDocument::new("N m s", array)),
            turns: report.turns.iter().map(TurnDocument::from).collect(),
            demands: report.demands.iter().map(DemandDocument::from).collect(),
            warnings: documents(&request.warnings),
        }
    }
}

/// Components without the sign of a zero.
fn vector(of: &Vector3<f64>) -> [Number; 3] {
    <[f64; 3]>::from(*of).map(|component| Number(component + 0.0))
}

impl ArrayDocument {
    fn new(unit: &'static str, array: &EnvelopedArray) -> Self {
        Self {
            unit,
            full: (&array.envelopes.full).into(),
            pseudo_inverse: (&array.envelopes.pseudo_inverse).into(),
        }
    }
}

impl From<&Polytope> for EnvelopeDocument {
    fn from(polytope: &Polytope) -> Self {
        let figures = polytope.size();
        Self {
            inscribed_radius: Number(figures.inscribed_radius),
            equal_volume_radius: Number(figures.equal_volume_radius),
            mean_radius: Number(figures.mean_radius),
            greatest_radius: Number(figures.greatest_radius),
            volume: Number(figures.volume),
            vertices: polytope.vertices().iter().map(vector).collect(),
            facets: polytope.facets().iter().map(FacetDocument::from).collect(),
        }
    }
}

impl From<&Facet> for FacetDocument {
    fn from(facet: &Facet) -> Self {
        Self {
            normal: vector(&facet.normal),
            distance: Number(facet.distance),
            vertices: facet.vertices.clone(),
        }
    }
}

impl<'a> From<&'a TurnReport> for TurnDocument<'a> {
    fn from(turn: &'a TurnReport) -> Self {
        let angle = turn.vector.norm();
        Self {
            angle_rad: Number(angle),
            axis: vector(&(turn.vector / angle)),
            eigenaxis: turn.eigenaxis.iter().map(EigenaxisDocument::from).collect(),
            time_optimal: turn
                .time_optimal
                .iter()
                .map(TimeOptimalDocument::from)
                .collect(),
        }
    }
}

impl From<&(EigenaxisBaseline, EnvelopePath)> for EigenaxisDocument {
    fn from((slew, path): &(EigenaxisBaseline, EnvelopePath)) -> Self {
        let course = &slew.course;
        Self {
            limit: slew.limit.into(),
            duration_s: Number(course.duration()),
            rate_rad_s: Number(course.rate()),
            acceleration_rad_s2: Number(course.acceleration()),
            ramp_s: Number(course.ramp()),
            peak_momentum_nms: vector(&slew.peak_momentum),
            ramp_torque_nm: vector(&slew.ramp_torque),
            path: path.into(),
        }
    }
}

impl<'a> From<&'a TimeOptimalSlew> for TimeOptimalDocument<'a> {
    fn from(slew: &'a TimeOptimalSlew) -> Self {
        let found = slew.found.as_ref();
        Self {
            allocation: slew.allocation.into(),
            solved: found.is_some(),
            status: &slew.status,
            duration_s: found.map(|(duration, _)| Number(*duration)),
            path: found.map(|(_, path)| path.into()),
        }
    }
}

impl From<&EnvelopePath> for PathDocument {
    fn from(path: &EnvelopePath) -> Self {
        Self {
            momentum: path.momentum.iter().map(MomentumDocument::from).collect(),
            torque: path.torque.iter().map(TorqueDocument::from).collect(),
        }
    }
}

impl From<&MomentumSample> for MomentumDocument {
    fn from(sample: &MomentumSample) -> Self {
        let point = &sample.momentum;
        Self {
            time_s: Number(sample.time_s),
            momentum_nms: vector(&point.vector),
            full_share: Number(point.full_share),
            pseudo_inverse_share: Number(point.pseudo_inverse_share),
        }
    }
}

impl From<&TorqueStep> for TorqueDocument {
    fn from(step: &TorqueStep) -> Self {
        let point = &step.torque;
        Self {
            start_s: Number(step.start_s),
            duration_s: Number(step.duration_s),
            torque_nm: vector(&point.vector),
            full_share: Number(point.full_share),
            pseudo_inverse_share: Number(point.pseudo_inverse_share),
        }
    }
}

impl From<&DemandReport> for DemandDocument {
    fn from(demand: &DemandReport) -> Self {
        let least = demand.least_load.as_ref();
        Self {
            demand_nm: vector(&demand.torque),
            pseudo_inverse: (&demand.pseudo_inverse).into(),
            least_load: least.map(AllocationDocument::from),
        }
    }
}

impl From<&DemandAllocation> for AllocationDocument {
    fn from(allocation: &DemandAllocation) -> Self {
        Self {
            wheel_torque_nm: Number::all(&allocation.wheels),
            load: Number(allocation.load),
        }
    }
}
