//! What a plan says of a scenario with windows, values or a latest end.

/// Values, targets left out and waits.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    /// What was optimised.
    pub objective: Objective,
    /// Sum of the values of the targets that are visited, added in the order of the scenario.
    pub value: f64,
    /// No plan has a greater sum, in the sense of the kind of the lower bound.
    pub value_bound: f64,
    /// The targets left out, in the order of the scenario.
    pub skipped: Vec<SkippedTarget>,
    /// Every stay at rest outside a visit, in order of time.
    pub waits: Vec<Wait>,
}

/// What a plan optimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Objective {
    /// The greatest sum of values, and of the plans that have it the least total time.
    ValueThenTime,
}

/// A target that a plan leaves out.
#[derive(Debug, Clone, PartialEq)]
pub struct SkippedTarget {
    /// Identifier of the target.
    pub target: String,
    /// Why.
    pub reason: SkipReason,
    /// What it would cost to include it, where that was found out.
    pub inclusion: Option<InclusionCost>,
}

/// Why a plan leaves a target out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum SkipReason {
    /// No plan visits it inside one of its windows.
    WindowUnreachable,
    /// Every plan with it has less value: it would displace more than it is worth.
    ValueTooSmall,
    /// Every plan with it ends after the latest end.
    TimeIsUp,
    /// It was not found out before the search was stopped.
    NotTried,
}

/// The best known plan with a target that is left out, compared with the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InclusionCost {
    /// By how much the sum of values changes, the target's own value included: not above zero where
    /// the plan is optimal.
    pub value_change: f64,
    /// By how much the total time changes, s.
    pub time_change_s: f64,
}

/// A stay at rest outside a visit: constant attitude and wheel momenta, no torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Wait {
    /// In whose attitude: a target's identifier, or `start`.
    pub target: String,
    /// Begin, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
}
