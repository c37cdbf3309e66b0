//! Which shares of torque and speed a plan should leave to feedback: the request and its answer.

use super::spread::SpreadDocument;
use crate::documents::document::{self, Node};
use crate::documents::number::Number;
use crate::documents::plan;
use crate::documents::problems::{ProblemDocument, documents};
use crate::documents::reader::{Cursor, Sink};
use serde::Serialize;
use slewplan_solver::model::input::InputForm;
use slewplan_solver::model::problem::Problem;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner::Run;
use slewplan_studies::authority::{AuthorityRow, AuthorityStudySpec, RowOutcome, study};
use utoipa::ToSchema;

/// Where the solver puts problems of the study, to be told from those of the scenario.
const STUDY: &str = "/study";

/// A study of the right shape.
#[derive(Debug)]
pub(crate) struct AuthorityStudy {
    spec: AuthorityStudySpec,
}

/// Reads a study.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read(bytes: &[u8]) -> Result<AuthorityStudy, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    read_node(&node)
}

/// Reads a study that has been parsed.
///
/// # Errors
///
/// Everything that is wrong with its shape.
pub(crate) fn read_node(node: &Node) -> Result<AuthorityStudy, Vec<Problem>> {
    let sink = Sink::default();
    let spec = AuthorityStudySpec::read(&Cursor::root(node, &sink));
    let problems = sink.into_problems();
    let spec = spec.filter(|_| problems.is_empty()).ok_or(problems)?;
    Ok(AuthorityStudy { spec })
}

impl AuthorityStudy {
    /// What is planned, with the shares of the request itself.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the scenario.
    pub(crate) fn scenario(&self) -> Result<Scenario, Vec<Problem>> {
        Scenario::try_new(&self.spec.scenario).map(|valid| valid.scenario)
    }

    /// Plans and simulates.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the scenario and with the study.
    pub(crate) fn conduct(&self, run: Run<'_>) -> Result<Vec<AuthorityRow>, Vec<Problem>> {
        let placed = |problem: Problem| match problem.pointer.strip_prefix(STUDY) {
            Some(pointer) => Problem {
                pointer: pointer.to_owned(),
                ..problem
            },
            None => problem.under("/scenario"),
        };
        study(&self.spec, STUDY, run).map_err(|problems| problems.into_iter().map(placed).collect())
    }
}

/// What every pair of shares leads to.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = AuthorityStudyAnswer)]
pub(crate) struct AuthorityAnswerDocument<'a> {
    /// Whether every plan was made and flown as often as asked for: false when time ran out.
    complete: bool,
    rows: Vec<RowDocument<'a>>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = AuthorityRow)]
struct RowDocument<'a> {
    torque_authority: Number,
    momentum_authority: Number,
    /// `flown`, `no_plan` with `reasons`, or `stopped` before there was a plan.
    status: &'static str,
    total_time_s: Option<Number>,
    /// `optimal` or `feasible`, as of a plan.
    plan_status: Option<&'static str>,
    sequence: &'a [String],
    flights: Option<SpreadDocument<'a>>,
    reasons: Vec<ProblemDocument<'a>>,
}

impl<'a> AuthorityAnswerDocument<'a> {
    /// The rows of a study.
    pub(crate) fn new(rows: &'a [AuthorityRow]) -> Self {
        Self {
            complete: is_complete(rows),
            rows: rows.iter().map(RowDocument::from).collect(),
        }
    }

    /// Whether nothing was cut short.
    pub(crate) fn is_complete(&self) -> bool {
        self.complete
    }
}

fn is_complete(rows: &[AuthorityRow]) -> bool {
    rows.iter().all(|row| match &row.outcome {
        RowOutcome::Simulated { spread, .. } => spread.runs == spread.runs_asked,
        RowOutcome::NoPlan(_) => true,
        RowOutcome::Stopped => false,
    })
}

impl<'a> From<&'a AuthorityRow> for RowDocument<'a> {
    fn from(row: &'a AuthorityRow) -> Self {
        let nothing = Self {
            torque_authority: Number(row.authorities.torque_authority),
            momentum_authority: Number(row.authorities.momentum_authority),
            status: "stopped",
            total_time_s: None,
            plan_status: None,
            sequence: &[],
            flights: None,
            reasons: Vec::new(),
        };
        match &row.outcome {
            RowOutcome::Simulated {
                total_time_s,
                optimality,
                sequence,
                spread,
            } => Self {
                status: "flown",
                total_time_s: Some(Number(*total_time_s)),
                plan_status: Some(plan::status(*optimality)),
                sequence,
                flights: Some((&**spread).into()),
                ..nothing
            },
            RowOutcome::NoPlan(problems) => Self {
                status: "no_plan",
                reasons: documents(problems),
                ..nothing
            },
            RowOutcome::Stopped => nothing,
        }
    }
}
