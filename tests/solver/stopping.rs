//! Stop requests and limits: the best result so far is returned, after hardly any further work.

use slewplan_solver::model::plan::{Leg, Optimality, Outcome, Plan};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::run::progress::{Observer, Progress, Stage};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::planner::{self, Run};
use slewplan_tests::published_targets_spec;
use slewplan_tests::solving::{on_threads, planned, pool, scenario_of};
use std::sync::OnceLock;
use std::time::Duration;

/// Legs, and nodes of the search, that may be in progress when a stop is requested: one per thread, and
/// one round. Work is counted instead of time, since the machine may be busy.
const LEGS_UNDER_WAY: u64 = 2;
const NODES_UNDER_WAY: u64 = 32;

/// Seven targets with many orders of nearly equal durations: a long search with few legs.
fn long_spec() -> ScenarioSpec {
    published_targets_spec(&["a", "c", "e", "g", "i", "k", "m"])
}

/// Requests a stop at the first report that meets a condition.
struct StopsWhen<'a> {
    met: fn(&Progress) -> bool,
    stop: &'a StopSignal,
    requested: OnceLock<Progress>,
}

impl Observer for StopsWhen<'_> {
    fn progress(&self, progress: Progress) {
        if (self.met)(&progress) {
            self.requested.get_or_init(|| progress);
            self.stop.request();
        }
    }
}

/// The outcome, and the work done when the stop was requested.
fn stopped_when(scenario: &Scenario, met: fn(&Progress) -> bool) -> (Outcome, u64) {
    let (pool, stop) = (pool(2), StopSignal::new());
    let observer = StopsWhen {
        met,
        stop: &stop,
        requested: OnceLock::new(),
    };
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &observer,
        legs: &slewplan_solver::tour::legs::NoStore,
        segments: &slewplan_solver::tour::legs::NoStore,
    };
    let outcome = planner::solve(scenario, run);
    let requested = observer.requested.get().expect("a stop was requested");
    (outcome, requested.done)
}

fn assert_honest(plan: &Plan) {
    assert_eq!(plan.optimality, Optimality::Feasible);
    assert!(plan.lower_bound_s > 0.0 && plan.lower_bound_s < plan.total_time_s);
    let gap = (plan.total_time_s - plan.lower_bound_s) / plan.total_time_s;
    assert!((plan.relative_gap - gap).abs() < 1e-12);
}

#[test]
fn a_stop_before_any_work_ends_without_a_plan() {
    let (outcome, done) = stopped_when(&scenario_of(&long_spec()), |_| true);
    assert!(matches!(outcome, Outcome::StoppedEmpty));
    assert_eq!(done, 0);
}

#[test]
fn a_stop_among_the_first_legs_returns_a_first_plan_and_a_bound() {
    let (outcome, done) = stopped_when(&scenario_of(&long_spec()), |progress| {
        progress.stage == Stage::Legs && progress.done >= 3
    });
    let plan = planned(outcome);
    assert_honest(&plan);
    let solved = plan.statistics.legs_solved;
    assert!(solved <= done + LEGS_UNDER_WAY, "{solved} after {done}");
}

#[test]
fn a_stop_in_the_search_returns_the_best_plan_and_its_bound() {
    let (outcome, done) = stopped_when(&scenario_of(&long_spec()), |progress| {
        progress.stage == Stage::Search && progress.incumbent_s.is_some()
    });
    let plan = planned(outcome);
    let explored = plan.statistics.nodes_explored;
    assert!(
        explored <= done + NODES_UNDER_WAY,
        "{explored} after {done}"
    );
    assert_honest(&plan);
    // No leg is solved only for comparison after the stop.
    let compared = |leg: &Leg| leg.rest_to_rest_duration_s.is_some();
    assert!(!plan.legs.iter().any(compared));
}

#[test]
fn a_node_limit_stops_at_the_same_plan_for_any_number_of_threads() {
    let mut spec = long_spec();
    spec.options.node_limit = Some(5);
    let scenario = scenario_of(&spec);
    let [one, two] =
        [1, 2].map(|count| planned(on_threads(count, |run| planner::solve(&scenario, run))));
    assert_honest(&one);
    assert_eq!(one.flight, two.flight);
    assert_eq!(one.legs, two.legs);
    assert!(
        one.legs
            .iter()
            .all(|leg| leg.rest_to_rest_duration_s.is_some())
    );
    assert!((one.lower_bound_s - two.lower_bound_s).abs() <= 0.0);
    assert_eq!(one.statistics.nodes_explored, 5);
}

#[test]
fn a_time_limit_ends_the_solve() {
    let mut spec = long_spec();
    let limit = Duration::from_millis(50);
    spec.options.time_limit_s = Some(limit.as_secs_f64());
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let outcome = on_threads(2, |run| planner::solve(&scenario, run));
    match outcome {
        Outcome::StoppedEmpty => {}
        other => assert_honest(&planned(other)),
    }
}
