//! A plan, or why there is none, as JSON.

use super::number::Number;
use super::problems::{ProblemDocument, documents};
use serde::Serialize;
use slewplan_solver::model::plan::{Alternative, Optimality, Outcome, Plan, State};
use slewplan_solver::model::problem::Problem;
use utoipa::ToSchema;

mod interruption;
mod parts;
mod schedule;
mod statistics;

pub(crate) use interruption::Interruption;
pub(crate) use parts::{
    ClearanceDocument, ControlDocument, IntrusionDocument, MarginsDocument, QuaternionDocument,
    StateDocument, VerificationDocument,
};
use parts::{EndDocument, LegDocument, PassageDocument};
use schedule::{SkippedDocument, WaitDocument};
use statistics::StatisticsDocument;

/// The answer of `solve`. All times are `null` and all lists empty when there is no plan.
#[derive(Debug, Default, Serialize, ToSchema)]
#[schema(as = Plan)]
pub(crate) struct PlanDocument<'a> {
    status: &'static str,
    total_time_s: Option<Number>,
    lower_bound_s: Option<Number>,
    relative_gap: Option<Number>,
    lower_bound_kind: Option<&'static str>,
    /// What was optimised, where the scenario has windows, values or a latest end: `value_then_time` is
    /// the greatest sum of values, and of the plans that have it the least total time.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    objective: Option<&'static str>,
    /// Sum of the values of the targets that are visited, where there is an `objective`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    value: Option<Number>,
    /// No plan has a greater sum, in the sense of the kind of the lower bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    value_bound: Option<Number>,
    /// The targets that are left out, where there is an `objective`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    skipped: Option<Vec<SkippedDocument<'a>>>,
    /// Every stay at rest outside a visit, in order of time, where there is an `objective`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    waits: Option<Vec<WaitDocument<'a>>>,
    /// No plan takes less, s, in any order that the targets' demands admit, proved: the shortest sum of the
    /// `certified_lower_bound_s` of legs through all targets, with settle and dwell. `null` where no
    /// leg has such a bound.
    certified_lower_bound_s: Option<Number>,
    /// The largest share of a leg's `duration_s` that lies above its `certified_lower_bound_s`, 1 where
    /// a leg has no such bound. `optimal` assumes that slews were solved globally: this is how much of
    /// a leg a better solution might save at most.
    largest_open_share: Option<Number>,
    sequence: Vec<&'a str>,
    alternatives: Vec<AlternativeDocument<'a>>,
    legs: Vec<LegDocument<'a>>,
    passages: Vec<PassageDocument<'a>>,
    /// Where the end points a boresight: how it is reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    end: Option<EndDocument>,
    trajectory: TrajectoryDocument,
    margins: Option<MarginsDocument>,
    verification: Option<VerificationDocument<'a>>,
    statistics: Option<StatisticsDocument>,
    reasons: Vec<ProblemDocument<'a>>,
    warnings: Vec<ProblemDocument<'a>>,
}

/// What is flown.
#[derive(Debug, Default, Serialize, ToSchema)]
#[schema(as = Trajectory)]
struct TrajectoryDocument {
    controls: Vec<ControlDocument>,
    states: Vec<StateDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Alternative)]
struct AlternativeDocument<'a> {
    sequence: Vec<&'a str>,
    total_time_s: Number,
}

impl<'a> From<&'a Alternative> for AlternativeDocument<'a> {
    fn from(other: &'a Alternative) -> Self {
        Self {
            sequence: other.sequence.iter().map(String::as_str).collect(),
            total_time_s: Number(other.total_time_s),
        }
    }
}

/// The document of an outcome, with the doubts about its scenario; `stopped` are the reasons of a
/// solve that was stopped before there was a plan.
pub(crate) fn document<'a>(
    outcome: &'a Outcome,
    stopped: &'a [Problem],
    doubts: &'a [Problem],
) -> PlanDocument<'a> {
    let mut document = match outcome {
        Outcome::Planned(found) => return plan(found, doubts),
        Outcome::Infeasible(reasons) => without_plan("infeasible", reasons),
        Outcome::Failed(reasons) => without_plan("failed", reasons),
        Outcome::StoppedEmpty => without_plan("failed", stopped),
    };
    document.warnings = documents(doubts);
    document
}

/// The document of a plan, with the doubts about its scenario.
pub(crate) fn plan<'a>(plan: &'a Plan, doubts: &'a [Problem]) -> PlanDocument<'a> {
    let mut document = planned(plan);
    document.warnings.splice(0..0, documents(doubts));
    document
}

/// The stable text of a plan's status.
pub(crate) const fn status(optimality: Optimality) -> &'static str {
    match optimality {
        Optimality::Optimal => "optimal",
        Optimality::Feasible => "feasible",
    }
}

fn without_plan<'a>(status: &'static str, reasons: &'a [Problem]) -> PlanDocument<'a> {
    PlanDocument {
        status,
        reasons: documents(reasons),
        ..PlanDocument::default()
    }
}

fn planned(plan: &Plan) -> PlanDocument<'_> {
    let flight = &plan.flight;
    let schedule = plan.schedule.as_ref();
    PlanDocument {
        status: status(plan.optimality),
        total_time_s: Some(Number(plan.total_time_s)),
        lower_bound_s: Some(Number(plan.lower_bound_s)),
        relative_gap: Some(Number(plan.relative_gap)),
        lower_bound_kind: Some(plan.lower_bound_kind.into()),
        objective: schedule.map(|it| it.objective.into()),
        value: schedule.map(|it| Number(it.value)),
        value_bound: schedule.map(|it| Number(it.value_bound)),
        skipped: schedule.map(|it| it.skipped.iter().map(SkippedDocument::from).collect()),
        waits: schedule.map(|it| it.waits.iter().map(WaitDocument::from).collect()),
        certified_lower_bound_s: plan.certified_lower_bound_s.map(Number),
        largest_open_share: plan.largest_open_share().map(Number),
        sequence: flight
            .passages
            .iter()
            .map(|passage| passage.target.as_str())
            .collect(),
        alternatives: plan
            .alternatives
            .iter()
            .map(AlternativeDocument::from)
            .collect(),
        legs: plan.legs.iter().map(LegDocument::from).collect(),
        passages: passages(plan),
        end: plan.rolls.end.and_then(|roll| {
            let state = plan.states.last()?;
            Some(EndDocument::new(state, roll))
        }),
        trajectory: TrajectoryDocument {
            controls: flight.controls.iter().map(ControlDocument::from).collect(),
            states: plan.states.iter().map(StateDocument::from).collect(),
        },
        margins: Some(MarginsDocument::from(&plan.margins)),
        verification: Some(VerificationDocument::from(&plan.verification)),
        statistics: Some(StatisticsDocument::from(&plan.statistics)),
        reasons: Vec::new(),
        warnings: documents(&plan.warnings),
    }
}

fn passages(plan: &Plan) -> Vec<PassageDocument<'_>> {
    let passages = plan.flight.passages.iter().enumerate();
    let passages = passages.filter_map(|(index, passage)| {
        let state = State::nearest(&plan.states, passage.time_s)?;
        let roll = plan.rolls.passages.get(index).copied().flatten();
        Some(PassageDocument::new(passage, state, roll))
    });
    passages.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::report::sample;
    use serde_json::Value;

    fn written(outcome: &Outcome) -> Value {
        serde_json::to_value(document(outcome, &[], &[])).unwrap()
    }

    #[test]
    fn a_plan_has_the_fields_of_the_contract() {
        let value = written(&Outcome::Planned(Box::new(sample::plan())));
        assert_eq!(value["status"], "optimal");
        assert_eq!(value["sequence"], serde_json::json!(["a", "b"]));
        assert_eq!(value["lower_bound_kind"], "nlp_relaxation");
        assert_eq!(value["passages"][1]["attitude"]["quaternion"]["w"], 1.0);
        assert_eq!(value["passages"][1]["body_rate_rad_s"][0], 0.25);
        assert_eq!(value["passages"][1]["departure_s"], 25.0);
        assert_eq!(value["trajectory"]["states"][1]["quaternion"]["x"], 0.0);
        assert_eq!(value["statistics"]["version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(value["verification"]["passed"], true);
        assert_eq!(value["legs"][2]["rest_to_rest_duration_s"], 11.0);
        let work = &value["statistics"];
        let by_kind = serde_json::json!({"legs": 4, "segments": 3});
        assert_eq!(work["nlp_solves_by_kind"], by_kind);
        assert_eq!(
            (&work["pruned_by_table"], &work["dropped_for_memory"]),
            (&5.into(), &1.into())
        );
        let last = serde_json::json!({"time_s": 2.0, "total_time_s": 30.0, "lower_bound_s": 30.0});
        assert_eq!(
            (
                work["history"].as_array().map(Vec::len),
                &work["history"][1]
            ),
            (Some(2), &last)
        );
        assert_eq!(value["margins"]["wheel_speed"], Value::Null);
    }

    #[test]
    fn reasons_come_with_null_times() {
        let reason = Problem::new(
            "/targets/0",
            slewplan_solver::model::problem::Code::MomentumExceedsEnvelope,
            "too much",
            "unload the wheels",
        );
        let value = written(&Outcome::Infeasible(vec![reason]));
        assert_eq!(value["status"], "infeasible");
        assert_eq!(value["total_time_s"], Value::Null);
        assert_eq!(value["reasons"][0]["code"], "momentum_exceeds_envelope");
        assert_eq!(value["reasons"][0]["hint"], "unload the wheels");
    }

    #[test]
    fn a_solve_that_was_stopped_without_a_plan_says_what_stopped_it() {
        let limit = 64 << 20;
        for (interruption, code, pointer) in [
            (
                Interruption::TimeLimit,
                "stopped_without_plan",
                "/options/time_limit_s",
            ),
            (Interruption::Request, "stopped_without_plan", ""),
            (Interruption::Memory { limit }, "memory_limit", "/targets"),
        ] {
            let reasons = [interruption.reason()];
            let document = document(&Outcome::StoppedEmpty, &reasons, &[]);
            let value = serde_json::to_value(document).unwrap();
            assert_eq!(value["status"], "failed");
            let reason = &value["reasons"][0];
            assert_eq!(
                (&reason["code"], &reason["pointer"]),
                (&code.into(), &pointer.into())
            );
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_never_written() {
        let mut plan = sample::plan();
        plan.states[0].body_rate_rad_s.x = f64::NAN;
        let outcome = Outcome::Planned(Box::new(plan));
        assert!(serde_json::to_string(&document(&outcome, &[], &[])).is_err());
    }

    #[test]
    fn doubts_about_the_scenario_come_before_those_about_the_plan() {
        let at = |pointer: &str| {
            Problem::new(
                pointer,
                slewplan_solver::model::problem::Code::KeepOutViolated,
                "",
                "",
            )
        };
        let mut plan = sample::plan();
        plan.warnings = vec![at("/keep_out/0")];
        let doubts = [at("/start")];
        let outcome = Outcome::Planned(Box::new(plan));
        let value = serde_json::to_value(document(&outcome, &[], &doubts)).unwrap();
        assert_eq!(value["warnings"][0]["pointer"], "/start");
        assert_eq!(value["warnings"][1]["pointer"], "/keep_out/0");
    }

    #[test]
    fn what_the_clock_adds_is_written_where_it_matters() {
        let mut plan = sample::plan();
        let written = |plan: &Plan| serde_json::to_value(super::plan(plan, &[])).unwrap();
        for name in ["objective", "value", "value_bound", "skipped", "waits"] {
            assert!(written(&plan).get(name).is_none(), "{name}");
        }
        plan.schedule = Some(sample::schedule());
        let value = written(&plan);
        assert_eq!(value["objective"], "value_then_time");
        assert_eq!(
            (&value["value"], &value["value_bound"]),
            (&3.0.into(), &4.5.into())
        );
        let skipped = serde_json::json!([
            {"target": "c", "reason": "value_too_small", "inclusion": {"value_change": -1.5, "time_change_s": 2.0}},
            {"target": "d", "reason": "not_tried"}
        ]);
        assert_eq!(value["skipped"], skipped);
        let waits = serde_json::json!([{"target": "a", "from_s": 10.0, "to_s": 12.0}]);
        assert_eq!(value["waits"], waits);
    }

    #[test]
    fn rolls_are_written_where_there_are_any() {
        let mut plan = sample::plan();
        let written = |plan: &Plan| serde_json::to_value(super::plan(plan, &[])).unwrap();
        let value = written(&plan);
        assert_eq!(value["passages"][1]["roll_deg"], -12.5);
        assert!(value["passages"][0].get("roll_deg").is_none());
        assert!(value.get("end").is_none());
        plan.rolls.end = Some(7.0);
        let end = &written(&plan)["end"];
        assert_eq!(
            (&end["roll_deg"], &end["time_s"]),
            (&7.0.into(), &30.0.into())
        );
        assert_eq!(end["attitude"]["quaternion"]["w"], 1.0);
    }
}
