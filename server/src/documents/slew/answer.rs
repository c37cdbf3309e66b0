//! The answer to a slew.

use super::SlewRequest;
use crate::documents::number::Number;
use crate::documents::plan::{ClearanceDocument, IntrusionDocument, StateDocument};
use crate::documents::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::slew::evidence::{Evidence, IntervalEvidence};
use slewplan_solver::slew::{
    MotorEnergies, Objective, PropagatedSlew, SlewOutcome, Sweep, TorquePiece, WheelAllocation,
};
use utoipa::ToSchema;

/// Solved slews: one, or one for every value of a sweep.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SlewAnswer)]
pub(crate) struct SlewAnswerDocument<'a> {
    /// As in the request.
    name: Option<&'a str>,
    /// The list that the sweep runs through: `weights`, `durations_s` or `energies_j`.
    sweep: Option<&'static str>,
    /// Whether all are there: false when time ran out, or nobody waited any longer.
    complete: bool,
    slews: Vec<SlewDocument<'a>>,
    warnings: Vec<ProblemDocument<'a>>,
}

/// A slew, flown by an integrator that shares nothing with the optimiser.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Slew)]
struct SlewDocument<'a> {
    /// The value of the sweep that it belongs to.
    swept: Option<Number>,
    /// Whether a local minimum was found and its flight keeps all limits and arrives.
    solved: bool,
    /// How the last program ended: `converged`, or why not. `no_clear_path` where no way around the cones
    /// was found, `infeasible` where it is proved that there is none.
    status: &'a str,
    /// Of `no_clear_path` and `infeasible`: what was searched.
    reasons: Vec<ProblemDocument<'a>>,
    /// The value of the objective, in `objective_unit`.
    objective: Number,
    objective_unit: &'static str,
    time_s: Number,
    /// Integral of the squared torques.
    effort_nm2_s: Number,
    /// Integral of the motors' power, braking counted against it; `null` without motors.
    energy_proxy_j: Option<Number>,
    /// What the supply gives: the integral of the power where it is positive, over the efficiency,
    /// and what the electronics take; `null` without motors.
    energy_bill_j: Option<Number>,
    /// Of a sampled slew the minimum in continuous time.
    continuous_time_s: Option<Number>,
    /// Where a boresight is pointed at the start: the roll about it, degrees, in the convention of
    /// `ra_dec_roll_deg`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    start_roll_deg: Option<Number>,
    /// The same at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    end_roll_deg: Option<Number>,
    flight: FlightDocument<'a>,
    trajectory: SlewTrajectoryDocument,
    evidence: Option<EvidenceDocument>,
    /// Guesses tried, and interior-point iterations of all programs together.
    starts: usize,
    iterations: usize,
}

/// What the independent integration found. Figures that could not be computed are very large.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SlewFlight)]
struct FlightDocument<'a> {
    attitude_error_rad: Number,
    rate_error_rad_s: Number,
    wheel_speed_error_rad_s: Number,
    torque_excess: Number,
    wheel_speed_excess: Number,
    rate_excess: Number,
    /// The closest approach to each cone of `keep_out` and `keep_in`.
    keep_out_clearance_deg: Vec<ClearanceDocument>,
    /// Every time span on the wrong side of a cone.
    keep_out_intrusions: Vec<IntrusionDocument>,
    /// Cones that are only reported, where they are violated.
    warnings: Vec<ProblemDocument<'a>>,
    failures: &'a [String],
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SlewTrajectory)]
struct SlewTrajectoryDocument {
    controls: Vec<RampDocument>,
    states: Vec<StateDocument>,
}

/// Motor torques, linear between the two ends.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SlewControl)]
struct RampDocument {
    start_s: Number,
    duration_s: Number,
    wheel_torque_begin_nm: Vec<Number>,
    wheel_torque_end_nm: Vec<Number>,
}

/// The conditions of the minimum principle along the slew.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = OptimalityEvidence)]
struct EvidenceDocument {
    /// What lists have an entry for: `wheels`, those that are commanded, or `body_axes`, where the
    /// pseudo-inverse shares out the torque on all wheels together.
    controls: &'static str,
    /// Mean of the Hamiltonian with the costate of time: zero when the duration is free.
    hamiltonian: Number,
    /// What its differences are measured by.
    scale: Number,
    /// Greatest difference of an interval's average from the mean, in the scale.
    average_spread: Number,
    /// Greatest difference at any moment, in the scale.
    pointwise_spread: Number,
    /// Greatest difference of the Hamiltonian alone from its mean, in the scale: more than the spread
    /// where a speed law moves a wheel.
    variation: Number,
    /// Mean by how much the torques could lower the Hamiltonian, in the scale.
    principle_gap: Number,
    /// Greatest jump of a costate where no limit is active, relative.
    costate_defect: Number,
    /// Greatest product of a limit's slack and its multiplier.
    complementarity: Number,
    /// Share of the switching functions of torques at their limits that have the sign asked for.
    switching_agreement: Number,
    intervals: Vec<IntervalDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = IntervalEvidence)]
struct IntervalDocument {
    start_s: Number,
    duration_s: Number,
    attitude_costate_begin: [Number; 3],
    attitude_costate_end: [Number; 3],
    momentum_costate_begin: Vec<Number>,
    momentum_costate_end: Vec<Number>,
    /// By how much the Hamiltonian alone has still to change; zero where no speed law moves a wheel.
    time_costate_begin: Number,
    time_costate_end: Number,
    switching_begin: Vec<Number>,
    switching_end: Vec<Number>,
    /// With the costate of time.
    hamiltonian_mean: Number,
    hamiltonian_min: Number,
    hamiltonian_max: Number,
}

impl<'a> SlewAnswerDocument<'a> {
    /// The answer to a request: its outcomes with their evidence, in the order of the sweep.
    pub(crate) fn new(
        request: &'a SlewRequest,
        outcomes: &'a [(SlewOutcome, Option<Evidence>)],
        complete: bool,
    ) -> Self {
        let warnings: &[Problem] = &request.warnings;
        let values = request.sweep.as_ref().map(Sweep::values);
        let slews = outcomes.iter().enumerate().map(|(i, outcome)| {
            let swept = values.and_then(|values| values.get(i)).copied();
            SlewDocument::new(request, swept, outcome)
        });
        Self {
            name: request.name.as_deref(),
            sweep: request.sweep.as_ref().map(Sweep::name),
            complete,
            slews: slews.collect(),
            warnings: documents(warnings),
        }
    }
}

impl<'a> SlewDocument<'a> {
    fn new(
        request: &SlewRequest,
        swept: Option<f64>,
        (outcome, evidence): &'a (SlewOutcome, Option<Evidence>),
    ) -> Self {
        let propagated = &outcome.propagated;
        let motors = request.slew.all_drives().iter();
        let MotorEnergies { proxy_j, bill_j } = propagated.energies;
        let known = motors.clone().any(|drive| drive.motor.is_some());
        let roll = |angle: Option<f64>| angle.map(|angle| Number(angle.to_degrees()));
        let energy = |value: f64| known.then_some(Number(value));
        Self {
            swept: swept.map(Number),
            solved: outcome.solved,
            status: &outcome.status,
            reasons: documents(&outcome.reasons),
            objective: Number(outcome.objective),
            objective_unit: match request.slew.objective() {
                Objective::Energy { .. } => "J",
                Objective::MinimumTime
                | Objective::TimeAndEffort { .. }
                | Objective::MinimumTimeAtEnergy { .. } => "s",
            },
            time_s: Number(outcome.time_s),
            effort_nm2_s: Number(outcome.effort),
            energy_proxy_j: energy(proxy_j),
            energy_bill_j: energy(bill_j),
            continuous_time_s: outcome.continuous_time_s.map(Number),
            start_roll_deg: roll(propagated.start_roll_rad),
            end_roll_deg: roll(propagated.end_roll_rad),
            flight: propagated.into(),
            trajectory: SlewTrajectoryDocument {
                controls: propagated.pieces.iter().map(RampDocument::from).collect(),
                states: propagated.states.iter().map(StateDocument::from).collect(),
            },
            evidence: evidence.as_ref().map(EvidenceDocument::from),
            starts: outcome.starts,
            iterations: outcome.iterations,
        }
    }
}

impl<'a> From<&'a PropagatedSlew> for FlightDocument<'a> {
    fn from(propagated: &'a PropagatedSlew) -> Self {
        Self {
            attitude_error_rad: Number(propagated.attitude_error_rad),
            rate_error_rad_s: Number(propagated.rate_error_rad_s),
            wheel_speed_error_rad_s: Number(propagated.wheel_speed_error_rad_s),
            torque_excess: Number(propagated.torque_excess),
            wheel_speed_excess: Number(propagated.wheel_speed_excess),
            rate_excess: Number(propagated.rate_excess),
            keep_out_clearance_deg: propagated.clearances.iter().map(Into::into).collect(),
            keep_out_intrusions: propagated.intrusions.iter().map(Into::into).collect(),
            warnings: documents(&propagated.warnings),
            failures: &propagated.failures,
        }
    }
}

impl From<&TorquePiece> for RampDocument {
    fn from(piece: &TorquePiece) -> Self {
        Self {
            start_s: Number(piece.start_s),
            duration_s: Number(piece.duration_s),
            wheel_torque_begin_nm: Number::all(&piece.torque_begin_nm),
            wheel_torque_end_nm: Number::all(&piece.torque_end_nm),
        }
    }
}

impl From<&Evidence> for EvidenceDocument {
    fn from(evidence: &Evidence) -> Self {
        Self {
            controls: match evidence.controls {
                WheelAllocation::Free => "wheels",
                WheelAllocation::PseudoInverse => "body_axes",
            },
            hamiltonian: Number(evidence.hamiltonian),
            scale: Number(evidence.scale),
            average_spread: Number(evidence.average_spread),
            pointwise_spread: Number(evidence.pointwise_spread),
            variation: Number(evidence.variation),
            principle_gap: Number(evidence.principle_gap),
            costate_defect: Number(evidence.costate_defect),
            complementarity: Number(evidence.complementarity),
            switching_agreement: Number(evidence.switching_agreement),
            intervals: evidence
                .intervals
                .iter()
                .map(IntervalDocument::from)
                .collect(),
        }
    }
}

impl From<&IntervalEvidence> for IntervalDocument {
    fn from(interval: &IntervalEvidence) -> Self {
        let [attitude_begin, attitude_end] = interval.attitude_costate;
        let [momenta_begin, momenta_end] = &interval.momentum_costate;
        let [switching_begin, switching_end] = &interval.switching;
        let [time_begin, time_end] = interval.time_costate.map(Number);
        let [mean, min, max] = interval.hamiltonian.map(Number);
        Self {
            start_s: Number(interval.start_s),
            duration_s: Number(interval.duration_s),
            attitude_costate_begin: <[f64; 3]>::from(attitude_begin).map(Number),
            attitude_costate_end: <[f64; 3]>::from(attitude_end).map(Number),
            momentum_costate_begin: Number::all(momenta_begin),
            momentum_costate_end: Number::all(momenta_end),
            time_costate_begin: time_begin,
            time_costate_end: time_end,
            switching_begin: Number::all(switching_begin),
            switching_end: Number::all(switching_end),
            hamiltonian_mean: mean,
            hamiltonian_min: min,
            hamiltonian_max: max,
        }
    }
}
