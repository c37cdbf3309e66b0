//! What share of the wheels a plan should leave to feedback.
//!
//! The more torque and speed a plan uses, the shorter it is, and the less is left to compensate errors.
//! The study solves a scenario for each pair of shares and simulates every plan with the same errors.

use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::input::{UpTo, input_object, or, required, required_or};
use slewplan_solver::model::plan::{Optimality, Outcome, Plan};
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::simulation::{self, Simulation, SimulationSpec, Spread};
use slewplan_solver::tour::planner::{Run, solve};

/// Greatest number of pairs of shares of one study: each takes a plan and a Monte-Carlo run.
pub const MAX_AUTHORITIES: usize = 200;

input_object! {
    /// Shares of every torque and speed limit that a plan may use.
    #[derive(Copy)]
    pub struct Authorities as "Authorities" {
        /// Share of every torque limit.
        pub torque_authority: f64 = required().above(0.0).at_most(1.0),
        /// Share of every wheel speed limit.
        pub momentum_authority: f64 = required().above(0.0).at_most(1.0),
    }
}

input_object! {
    /// How much of the wheels a plan should leave to feedback.
    #[derive(Default)]
    pub struct AuthorityStudySpec as "AuthorityStudy" {
        /// What is planned; the shares in its options do not matter.
        pub scenario: ScenarioSpec = required_or(ScenarioSpec::default()),
        /// How every plan is simulated.
        pub simulation: SimulationSpec = or(SimulationSpec::default()),
        /// The pairs of shares to compare.
        pub authorities: Vec<Authorities> as UpTo<MAX_AUTHORITIES, Authorities>
            = required_or(Vec::new()).min_length(1),
    }
}

/// One line of the table.
#[derive(Debug, Clone)]
pub struct AuthorityRow {
    /// The shares.
    pub authorities: Authorities,
    /// The result with these shares.
    pub outcome: RowOutcome,
}

/// The result with a pair of shares.
#[derive(Debug, Clone)]
pub enum RowOutcome {
    /// A plan and its simulated flights.
    Simulated {
        /// Duration of the plan, s.
        total_time_s: f64,
        /// What is known about its optimality.
        optimality: Optimality,
        /// The visited targets in order.
        sequence: Vec<String>,
        /// Statistics over its simulated flights.
        spread: Box<Spread>,
    },
    /// The scenario is not valid with these shares, or has no plan, for these reasons.
    NoPlan(Vec<Problem>),
    /// Stopped before a first plan was found.
    Stopped,
}

/// Solves a scenario for each pair of shares and simulates the plans.
///
/// # Errors
///
/// All problems of the scenario as it is and of the study at once; pointers into the study begin
/// with `pointer`.
pub fn study(
    spec: &AuthorityStudySpec,
    pointer: &str,
    run: Run<'_>,
) -> Result<Vec<AuthorityRow>, Vec<Problem>> {
    let mut findings = Findings::default();
    let given = Scenario::try_new(&spec.scenario)
        .map_err(|problems| findings.include(problems))
        .ok();
    let at = format!("{pointer}/simulation");
    let problems = given
        .as_ref()
        .map(|given| simulation::check(&spec.simulation, given.scenario.spacecraft(), &at));
    let is_valid = problems.as_ref().is_some_and(Vec::is_empty);
    findings.include(problems.unwrap_or_default());
    let rows = check_shares(&spec.authorities, pointer, &mut findings);
    findings.conclude((rows && is_valid).then_some(()))?;
    let rows = spec.authorities.iter().map(|&authorities| AuthorityRow {
        authorities,
        outcome: row(spec, authorities, &at, run),
    });
    Ok(rows.collect())
}

fn check_shares(authorities: &[Authorities], pointer: &str, findings: &mut Findings) -> bool {
    let pointer = format!("{pointer}/authorities");
    let mut valid = findings.at_most(&pointer, authorities.len(), MAX_AUTHORITIES);
    if authorities.is_empty() {
        valid = false;
        findings.refuse(
            &pointer,
            Code::WrongLength,
            "the list is empty",
            "list the pairs of shares to compare",
        );
    }
    for (index, pair) in authorities.iter().enumerate() {
        for (name, share) in [
            ("torque_authority", pair.torque_authority),
            ("momentum_authority", pair.momentum_authority),
        ] {
            let at = format!("{pointer}/{index}/{name}");
            let share = findings.positive(&at, share);
            valid &= share.is_some_and(|share| share <= 1.0);
            if let Some(share) = share.filter(|&share| share > 1.0) {
                findings.refuse(
                    at,
                    Code::OutOfRange,
                    format!("the share is {share}, it must be at most 1"),
                    "give the share of the limit that the plan may use",
                );
            }
        }
    }
    valid
}

fn row(
    study: &AuthorityStudySpec,
    authorities: Authorities,
    pointer: &str,
    run: Run<'_>,
) -> RowOutcome {
    if run.stop.is_set() {
        return RowOutcome::Stopped;
    }
    let mut spec = study.scenario.clone();
    spec.options.torque_authority = authorities.torque_authority;
    spec.options.momentum_authority = authorities.momentum_authority;
    let scenario = match Scenario::try_new(&spec) {
        Ok(validated) => validated.scenario,
        Err(problems) => return RowOutcome::NoPlan(problems),
    };
    match solve(&scenario, run) {
        Outcome::Planned(plan) => simulate(&scenario, *plan, &study.simulation, pointer, run),
        Outcome::Infeasible(problems) | Outcome::Failed(problems) => RowOutcome::NoPlan(problems),
        Outcome::StoppedEmpty => RowOutcome::Stopped,
    }
}

fn simulate(
    scenario: &Scenario,
    plan: Plan,
    simulation: &SimulationSpec,
    pointer: &str,
    run: Run<'_>,
) -> RowOutcome {
    match Simulation::try_new(scenario, &plan.flight, simulation, pointer) {
        Ok(simulation) => RowOutcome::Simulated {
            total_time_s: plan.total_time_s,
            optimality: plan.optimality,
            spread: Box::new(simulation.monte_carlo(run.pool, run.stop)),
            sequence: plan
                .flight
                .passages
                .into_iter()
                .map(|passage| passage.target)
                .collect(),
        },
        Err(problems) => RowOutcome::NoPlan(problems),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::spec::{SpacecraftSpec, TargetSpec, WheelSpec};
    use slewplan_solver::run::pool::SolverPool;
    use slewplan_solver::run::progress::Silent;
    use slewplan_solver::run::stop::StopSignal;
    use slewplan_solver::tour::legs::NoStore;

    fn spec() -> ScenarioSpec {
        let wheel = |axis| WheelSpec {
            axis,
            normalize_axis: true,
            inertia_kg_m2: 2e-3,
            max_torque_nm: 0.05,
            min_torque_nm: None,
            max_speed_rad_s: Some(400.0),
            enabled: true,
        };
        ScenarioSpec {
            spacecraft: SpacecraftSpec {
                inertia_kg_m2: [[4.0, 0.2, -0.1], [0.2, 5.0, 0.3], [-0.1, 0.3, 6.0]],
                wheels: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                    .map(wheel)
                    .into(),
                ..SpacecraftSpec::default()
            },
            targets: vec![TargetSpec {
                id: "t".into(),
                ..TargetSpec::default()
            }],
            ..ScenarioSpec::default()
        }
    }

    #[test]
    fn all_problems_of_a_study_are_found() {
        let mut scenario = spec();
        scenario.targets[0].id = String::new();
        let shares = |torque_authority, momentum_authority| Authorities {
            torque_authority,
            momentum_authority,
        };
        let bad = AuthorityStudySpec {
            scenario,
            simulation: SimulationSpec::default(),
            authorities: vec![shares(1.1, 0.9), shares(0.9, 0.0)],
        };
        let pool = SolverPool::new(None).unwrap();
        let stop = StopSignal::new();
        let run = Run {
            pool: &pool,
            stop: &stop,
            observer: &Silent,
            legs: &NoStore,
            segments: &NoStore,
        };
        let problems = study(&bad, "", run).unwrap_err();
        let found: Vec<_> = problems.into_iter().map(|p| p.pointer).collect();
        let expected = [
            "/targets/0/id",
            "/authorities/0/torque_authority",
            "/authorities/1/momentum_authority",
        ];
        assert_eq!(found, expected);
        let mut runs = AuthorityStudySpec {
            scenario: spec(),
            ..AuthorityStudySpec::default()
        };
        runs.simulation.runs = Some(0);
        let problems = study(&runs, "/study", run).unwrap_err();
        let found: Vec<_> = problems.into_iter().map(|p| p.pointer).collect();
        assert_eq!(found, ["/study/simulation/runs", "/study/authorities"]);
    }
}
