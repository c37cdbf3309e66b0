//! Random scenarios of a few targets: the search compared with the solution of all orders.

use crate::experiment_a_spec;
use crate::random::Generator;
use crate::solving::{agree, on_threads, plan_of, scenario_of};
use slewplan_solver::model::plan::Optimality;
use slewplan_solver::model::spec::{AttitudeEquivalence, AttitudeSpec, ScenarioSpec, StateSpec};
use slewplan_solver::tour::planner::every_order;

/// Properties of a random scenario; the seed determines the rest.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says whether a scenario has a trait"
)]
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Seed of the generator.
    pub seed: u64,
    /// Number of targets.
    pub targets: usize,
    /// Kind of rate condition of every target, or `None` for a mixture.
    pub rate_kind: Option<usize>,
    /// Wheels that turn at the start.
    pub momentum: bool,
    /// A prescribed end.
    pub end: bool,
    /// Settling and dwelling at the first target.
    pub dwell: bool,
    /// Quaternions with their signs.
    pub signed: bool,
}

/// Four targets with mixed conditions and an end, without momentum, dwell or signs.
pub const PLAIN: Case = Case {
    seed: 0,
    targets: 4,
    rate_kind: None,
    momentum: false,
    end: true,
    dwell: false,
    signed: false,
};

fn random_spec(case: &Case) -> ScenarioSpec {
    let mut generator = Generator::new(case.seed);
    let mut spec = experiment_a_spec();
    spec.targets = (0..case.targets)
        .map(|i| {
            let kind = case.rate_kind.unwrap_or(i % 4);
            generator.target(format!("t{i}"), kind)
        })
        .collect();
    if case.momentum {
        spec.start.wheel_speed_rad_s = Some(generator.vector(-150.0, 150.0).into());
    }
    spec.end = case.end.then(|| StateSpec {
        attitude: AttitudeSpec::Quaternion(generator.quaternion()),
        ..StateSpec::default()
    });
    if case.dwell {
        // The first kind of rate condition is rest, which dwelling is compatible with.
        spec.targets[0].dwell_s = 12.5;
        spec.targets[0].settle_s = 3.0;
    }
    if case.signed {
        spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    }
    spec
}

/// Whether the search finds the best of all orders of a case and proves it.
///
/// # Panics
///
/// When it does not, with the seed.
pub fn assert_search_finds_the_best_order(case: &Case) {
    assert_search_finds_the_best_of(&random_spec(case), &format!("seed {}", case.seed));
}

/// The same of a scenario.
///
/// # Panics
///
/// When it does not, with the name.
pub fn assert_search_finds_the_best_of(spec: &ScenarioSpec, name: &str) {
    let plan = plan_of(spec);
    let scenario = scenario_of(spec);
    let orders = on_threads(2, |run| every_order(&scenario, run));
    let all: usize = (1..=spec.targets.len()).product();
    assert_eq!(orders.len(), all, "{name}: orders left unsolved");
    let (found, best) = (plan.total_time_s, orders[0].duration_s);
    assert!(
        agree(found, best, 1e-6),
        "{name}: the search found {found} s, all orders {best} s"
    );
    assert_eq!(plan.optimality, Optimality::Optimal, "{name}");
    assert!(
        plan.lower_bound_s <= best * (1.0 + 1e-9),
        "{name}: bound {} s above the best order, {best} s",
        plan.lower_bound_s
    );
}
