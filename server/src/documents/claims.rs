//! Reading what a plan made by anyone claims to be proved.
//!
//! Nothing else of it is looked at: whether it can be flown is not asked here.

use super::document;
use super::kind::Kind;
use super::reader::{Cursor, Fields, Sink};
use slewplan_solver::model::plan::LowerBoundKind;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::tour::planner::{LegCertificate, PlanCertificate};

/// Reads the claims of a plan for a scenario.
///
/// # Errors
///
/// Everything that is wrong with them, with pointers into the plan.
pub(crate) fn read(bytes: &[u8], scenario: &Scenario) -> Result<PlanCertificate, Vec<Problem>> {
    let node = document::parse(bytes).map_err(|problem| vec![problem])?;
    if let Some(other) = Kind::Plan.mismatch(&node) {
        return Err(vec![other]);
    }
    let sink = Sink::default();
    let claims = decode(&Cursor::root(&node, &sink), scenario);
    let problems = sink.into_problems();
    match claims {
        Some(claims) if problems.is_empty() => Ok(claims),
        _ => Err(problems),
    }
}

fn decode(root: &Cursor<'_>, scenario: &Scenario) -> Option<PlanCertificate> {
    let fields = root.open_object()?;
    let legs = fields
        .required("legs")
        .and_then(|list| list.all(|leg| read_leg(leg, scenario)));
    let proved = number(&fields, "certified_lower_bound_s");
    let kind = fields.optional("lower_bound_kind");
    let kind = kind.and_then(|kind| kind.text());
    let bound =
        number(&fields, "lower_bound_s").filter(|_| kind == Some(LowerBoundKind::Certified.into()));
    Some(PlanCertificate {
        legs: legs?,
        // Where both are claimed to be proved, so is the larger.
        lower_bound_s: proved.into_iter().chain(bound).reduce(f64::max),
        total_time_s: number(&fields, "total_time_s"),
    })
}

fn read_leg(cursor: &Cursor<'_>, scenario: &Scenario) -> Option<LegCertificate> {
    let fields = cursor.open_object()?;
    let from = place(&fields, "from", scenario);
    let to = place(&fields, "to", scenario);
    Some(LegCertificate {
        lower_bound_s: number(&fields, "certified_lower_bound_s"),
        duration_s: number(&fields, "duration_s"),
        from: from?,
        to: to?,
    })
}

fn number(fields: &Fields<'_>, name: &str) -> Option<f64> {
    fields.optional(name).and_then(|value| value.number())
}

/// The name of a place of the scenario.
fn place(fields: &Fields<'_>, name: &str, scenario: &Scenario) -> Option<String> {
    let cursor = fields.required(name)?;
    let text = cursor.text()?;
    let known = match text {
        "start" => true,
        "end" => scenario.end().is_some(),
        id => scenario.targets().iter().any(|target| target.id == id),
    };
    if !known {
        cursor.report(
            Code::UnknownReference,
            format!("{text:?} is no place of the scenario"),
            "name start, end or a target of the scenario",
        );
    }
    Some(text.to_owned())
}
