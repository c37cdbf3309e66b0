//! Studies: what the choice of an option leads to, and what wheels can do together.

pub(crate) mod authority;
pub(crate) mod comparison;
pub(crate) mod envelopes;
pub(crate) mod flight;
mod simulation;
mod spread;

use slewplan_solver::plan::Optimality;

/// What is known about the optimality of a plan, in the words of a plan.
const fn plan_status(optimality: Optimality) -> &'static str {
    match optimality {
        Optimality::Optimal => "optimal",
        Optimality::Feasible => "feasible",
    }
}
