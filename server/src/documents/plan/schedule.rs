//! What the clock adds to a plan document: targets left out, and waits.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::model::plan::{InclusionCost, SkippedTarget, Wait};
use utoipa::ToSchema;

/// A target that the plan leaves out.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SkippedTarget)]
pub(super) struct SkippedDocument<'a> {
    target: &'a str,
    /// `window_unreachable`: no plan visits it inside one of its windows. `value_too_small`: it would
    /// displace more than it is worth. `time_is_up`: every plan with it ends after the latest end.
    /// `not_tried`: not found out before the search was stopped.
    reason: &'static str,
    /// What it would cost to include it, where that was found out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    inclusion: Option<InclusionDocument>,
}

impl<'a> From<&'a SkippedTarget> for SkippedDocument<'a> {
    fn from(skipped: &'a SkippedTarget) -> Self {
        Self {
            target: &skipped.target,
            reason: skipped.reason.into(),
            inclusion: skipped.inclusion.map(InclusionDocument::from),
        }
    }
}

/// The best known plan with a target that is left out, compared with the plan.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = InclusionCost)]
struct InclusionDocument {
    /// By how much the sum of values changes, with the value of the target itself.
    value_change: Number,
    /// By how much the total time changes, s.
    time_change_s: Number,
}

impl From<InclusionCost> for InclusionDocument {
    fn from(cost: InclusionCost) -> Self {
        Self {
            value_change: Number(cost.value_change),
            time_change_s: Number(cost.time_change_s),
        }
    }
}

/// A stay at rest outside a visit: attitude and wheel momenta do not change.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Wait)]
pub(super) struct WaitDocument<'a> {
    /// In whose attitude: that of a target, or `start`.
    target: &'a str,
    from_s: Number,
    to_s: Number,
}

impl<'a> From<&'a Wait> for WaitDocument<'a> {
    fn from(wait: &'a Wait) -> Self {
        Self {
            target: &wait.target,
            from_s: Number(wait.from_s),
            to_s: Number(wait.to_s),
        }
    }
}
