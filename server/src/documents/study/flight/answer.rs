//! One flight of a plan in closed loop: the answer.

use crate::documents::number::Number;
use crate::documents::plan::{self, ClearanceDocument, QuaternionDocument};
use crate::documents::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::plan::Passage;
use slewplan_solver::simulation::{PassageError, Saturation, SimulatedState, TrackingError};
use slewplan_studies::flight::{FlightStudy, FlightStudyOutcome, SimulatedPlan};
use utoipa::ToSchema;

/// A plan flown once with a truth that differs from what is believed.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = FlightStudyAnswer)]
pub(crate) struct FlightAnswerDocument<'a> {
    /// Of the scenario.
    name: Option<&'a str>,
    /// `flown`, `no_plan` with `reasons`, or `stopped` before there was a plan.
    status: &'static str,
    flight: Option<FlightDocument<'a>>,
    reasons: Vec<ProblemDocument<'a>>,
    warnings: Vec<ProblemDocument<'a>>,
}

/// Errors are against the plan; those that could not be computed are very large.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SimulatedFlight)]
struct FlightDocument<'a> {
    /// Which of the flights of the seed.
    number: u64,
    /// `optimal` or `feasible`; `null` for a plan that was given.
    plan_status: Option<&'static str>,
    /// Of the plan.
    total_time_s: Number,
    /// With the time to settle.
    flight_time_s: Number,
    tolerance_rad: Number,
    /// Whether the attitude at the end is within the tolerance.
    within_tolerance: bool,
    end: ErrorDocument,
    /// At the end of the plan, before the time to settle.
    plan_end: ErrorDocument,
    /// Largest at any sample, each by itself, against what the controller follows.
    peak: ErrorDocument,
    passages: Vec<PassageDocument<'a>>,
    /// Shares of the time that wheels were at a limit; one entry per wheel.
    saturation: Vec<SharesDocument>,
    /// The closest approach of the true attitude to every cone of the scenario, at the samples of the
    /// on-board computer and at the end.
    keep_out_clearance_deg: Vec<ClearanceDocument>,
    /// Time between two samples of the on-board computer.
    sample_period_s: Number,
    /// `samples` has one out of so many.
    keep_every: usize,
    samples: Vec<SampleDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = TrackingError)]
struct ErrorDocument {
    attitude_rad: Number,
    rate_rad_s: Number,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = FlownPassage)]
struct PassageDocument<'a> {
    target: &'a str,
    time_s: Number,
    departure_s: Number,
    error: ErrorDocument,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SaturationShares)]
struct SharesDocument {
    torque: Number,
    speed: Number,
}

/// The truth at a sample of the on-board computer. Lists have one entry per wheel.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = FlownSample)]
struct SampleDocument {
    time_s: Number,
    quaternion: QuaternionDocument,
    body_rate_rad_s: [Number; 3],
    wheel_speed_rad_s: Vec<Number>,
    /// Commanded from here on, before the limits.
    wheel_torque_nm: Vec<Number>,
    /// Whether the wheel met its limit of torque, or of speed, before the next entry.
    torque_limited: Vec<bool>,
    speed_limited: Vec<bool>,
    /// Against what the controller follows.
    error: ErrorDocument,
}

impl<'a> FlightAnswerDocument<'a> {
    /// The answer to a request.
    pub(crate) fn new(study: &'a FlightStudy, outcome: &'a FlightStudyOutcome) -> Self {
        let (status, flight, reasons) = match outcome {
            FlightStudyOutcome::Simulated(simulated) => (
                "flown",
                Some(FlightDocument::new(study, simulated)),
                Vec::new(),
            ),
            FlightStudyOutcome::NoPlan(reasons) => ("no_plan", None, documents(reasons)),
            FlightStudyOutcome::Stopped => ("stopped", None, Vec::new()),
        };
        Self {
            name: study.scenario.name(),
            status,
            flight,
            reasons,
            warnings: documents(&study.warnings),
        }
    }
}

impl<'a> FlightDocument<'a> {
    fn new(study: &FlightStudy, plan: &'a SimulatedPlan) -> Self {
        let simulated = &plan.simulated;
        let passages = simulated.passages.iter().zip(&plan.plan.passages);
        let passage = |(of, planned): (&'a PassageError, &Passage)| PassageDocument {
            target: &of.target,
            time_s: Number(of.time_s),
            departure_s: Number(planned.departure_s),
            error: of.error.into(),
        };
        Self {
            number: study.number,
            plan_status: plan.optimality.map(plan::status),
            total_time_s: Number(plan.plan.total_time_s),
            flight_time_s: Number(plan.flight_time_s),
            tolerance_rad: Number(plan.tolerance_rad),
            within_tolerance: simulated.end.attitude_rad <= plan.tolerance_rad,
            end: simulated.end.into(),
            plan_end: simulated.plan_end.into(),
            peak: simulated.peak.into(),
            passages: passages.map(passage).collect(),
            saturation: simulated
                .saturation
                .iter()
                .map(SharesDocument::from)
                .collect(),
            keep_out_clearance_deg: simulated
                .cones
                .iter()
                .map(ClearanceDocument::from)
                .collect(),
            sample_period_s: Number(plan.sample_s),
            keep_every: plan.keep_every,
            samples: simulated.states.iter().map(SampleDocument::from).collect(),
        }
    }
}

impl From<TrackingError> for ErrorDocument {
    fn from(error: TrackingError) -> Self {
        Self {
            attitude_rad: Number(error.attitude_rad),
            rate_rad_s: Number(error.rate_rad_s),
        }
    }
}

impl From<&Saturation> for SharesDocument {
    fn from(shares: &Saturation) -> Self {
        Self {
            torque: Number(shares.torque),
            speed: Number(shares.speed),
        }
    }
}

impl From<&SimulatedState> for SampleDocument {
    fn from(state: &SimulatedState) -> Self {
        Self {
            time_s: Number(state.time_s),
            quaternion: (&state.attitude).into(),
            body_rate_rad_s: <[f64; 3]>::from(state.body_rate_rad_s).map(Number),
            wheel_speed_rad_s: Number::all(&state.wheel_speed_rad_s),
            wheel_torque_nm: Number::all(&state.wheel_torque_nm),
            torque_limited: state.torque_limited.clone(),
            speed_limited: state.speed_limited.clone(),
            error: state.error.into(),
        }
    }
}
