//! What casts doubt on a plan, and what a plan no longer says then.

use super::*;
use crate::model::plan::LowerBoundKind;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::run::pool::SolverPool;
use crate::run::progress::Observer;
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegStore, NoStore, StoredLeg};
use crate::tour::order::TourEvaluation;
use crate::tour::order::TourModel;
use crate::tour::planner::legs::LegSolver;
use crate::tour::planner::places::Places;
use std::num::NonZeroUsize;

/// Keeps contradictions.
#[derive(Default)]
struct Listener(Mutex<Vec<Contradiction>>);

impl Observer for Listener {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, contradiction: &Contradiction) {
        self.0.lock().expect("no panic").push(contradiction.clone());
    }
}

/// Two targets at rest.
fn scenario() -> Scenario {
    let mut spec = experiment_a();
    spec.targets.truncate(2);
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    Scenario::try_new(&spec).expect("valid").scenario
}

/// The plan of an order with a certified bound of a share of what it takes, and what was contradicted.
fn plan_with_bound(share: f64) -> (Plan, Vec<Contradiction>) {
    let (scenario, listener) = (scenario(), Listener::default());
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let stop = StopSignal::new();
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &listener,
        legs: &NoStore,
        segments: &NoStore,
    };
    let places = Places::of(&scenario);
    let legs = LegSolver::new(&places, run, &stop);
    let tours = Tours::new(&places, &legs, &stop);
    let TourEvaluation::LegSolution(duration_s) = tours.tour(&[0, 1]) else {
        panic!("the order is flown");
    };
    let mut conclusions = PlanBuilder::new(&tours, run, Instant::now());
    conclusions.prove(Some(share * duration_s));
    let best = FlownOrder {
        order: vec![0, 1],
        duration_s,
    };
    let found = SearchResult {
        best: Some(best.clone()),
        alternatives: Vec::new(),
        lower_bound_s: duration_s,
        complete: true,
        end: crate::tour::order::SearchEnd::Exhausted,
        statistics: SearchStatistics::default(),
    };
    let Outcome::Planned(plan) = conclusions.outcome(&best, &found) else {
        panic!("the order flies");
    };
    (*plan, listener.0.into_inner().expect("no panic"))
}

#[test]
fn a_bound_above_the_flight_is_told_and_given_to_nobody() {
    let (plan, told) = plan_with_bound(0.98);
    assert_eq!((plan.optimality, told), (Optimality::Optimal, Vec::new()));
    assert!(plan.certified_lower_bound_s.is_some() && plan.warnings.is_empty());
    // The tolerances of a flight are no contradiction.
    assert_eq!(plan_with_bound(1.0 + 3e-6).1, []);
    let (plan, told) = plan_with_bound(1.001);
    let [
        Contradiction::Tour {
            route,
            leg,
            bound_s,
            duration_s: flown_s,
        },
    ] = &told[..]
    else {
        panic!("{told:?}");
    };
    assert_eq!((route.len(), leg), (4, &None));
    assert!(bound_s > flown_s);
    assert_eq!(plan.optimality, Optimality::Feasible);
    assert_eq!(plan.certified_lower_bound_s, None);
    assert_eq!(plan.lower_bound_kind, LowerBoundKind::NlpRelaxation);
    assert!(plan.lower_bound_s.abs() <= 0.0 && plan.relative_gap >= 1.0);
    assert!(
        plan.legs
            .iter()
            .all(|leg| leg.certified_lower_bound_s.is_none())
    );
    assert_eq!(plan.warnings[0].code, Code::BoundContradicted);
}

/// Gives every leg the motion of one that it has been given before, or a bound that is too large.
struct Wrong {
    first: Mutex<Option<StoredLeg>>,
    stretched: f64,
}

impl LegStore for Wrong {
    fn get(&self, _: &str) -> Option<StoredLeg> {
        let known = self.first.lock().expect("no panic").clone()?;
        Some(StoredLeg {
            certified_lower_bound_s: Some(self.stretched * known.duration_s),
            ..known
        })
    }

    fn put(&self, _: &str, leg: &StoredLeg) {
        self.first
            .lock()
            .expect("no panic")
            .get_or_insert_with(|| leg.clone());
    }
}

#[test]
fn a_stored_leg_that_its_flight_contradicts_is_told_and_not_used() {
    let scenario = scenario();
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let stop = StopSignal::new();
    let duration = |store: &Wrong, listener: &Listener, to: usize| {
        let run = Run {
            pool: &pool,
            stop: &stop,
            observer: listener,
            legs: store,
            segments: &NoStore,
        };
        let places = Places::of(&scenario);
        let legs = LegSolver::new(&places, run, &stop);
        let pair = (Place::Start, Place::Target(to));
        let table = legs.table(LegKind::RestToRest, &[pair]);
        let leg = &table.get(pair.0, pair.1).expect("a leg").leg;
        (leg.flown.duration().expect("converged"), leg.certified)
    };
    let store = Wrong {
        first: Mutex::default(),
        stretched: 0.9,
    };
    let listener = Listener::default();
    let (first, _) = duration(&store, &listener, 0);
    let (again, certified) = duration(&store, &listener, 0);
    assert!((again - first).abs() <= 0.0 && certified == Some(0.9 * first));
    assert_eq!(listener.0.lock().expect("no panic").len(), 0);
    let (other, _) = duration(&store, &listener, 1);
    let (right, _) = duration(
        &Wrong {
            first: Mutex::default(),
            stretched: 1.0,
        },
        &listener,
        1,
    );
    assert!((other - right).abs() <= 0.0, "{other} {right}");
    let told = std::mem::take(&mut *listener.0.lock().expect("no panic"));
    assert!(
        matches!(&told[..], [Contradiction::StoredLeg { .. }]),
        "{told:?}"
    );
    let store = Wrong {
        stretched: 1.01,
        ..store
    };
    let (kept, certified) = duration(&store, &listener, 0);
    assert!((kept - first).abs() <= 0.0 && certified.is_none());
    let told = listener.0.into_inner().expect("no panic");
    assert!(matches!(&told[..], [Contradiction::Leg { .. }]), "{told:?}");
}

/// Counts what is asked for.
#[derive(Default)]
struct Asked(Mutex<Vec<String>>);

impl LegStore for Asked {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        self.0.lock().expect("no panic").push(identity.into());
        None
    }

    fn put(&self, _: &str, _: &StoredLeg) {}
}

#[test]
fn whoever_wants_the_best_so_far_asks_the_store_and_whoever_cancels_does_not() {
    let scenario = scenario();
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let asked = |stop: &StopSignal| {
        let store = Asked::default();
        let run = Run {
            pool: &pool,
            stop,
            observer: &Listener::default(),
            legs: &store,
            segments: &NoStore,
        };
        let places = Places::of(&scenario);
        let legs = LegSolver::new(&places, run, stop);
        let (start, first, second) = (Place::Start, Place::Target(0), Place::Target(1));
        // Two of the four are one problem, as without momentum a slew may be flown backwards.
        let pairs = [
            (start, first),
            (first, second),
            (second, first),
            (start, second),
        ];
        let table = legs.table(LegKind::RestToRest, &pairs);
        let known = pairs
            .iter()
            .filter(|(from, to)| table.get(*from, *to).is_some())
            .count();
        (
            store.0.lock().expect("no panic").len(),
            known,
            legs.work()[0],
        )
    };
    assert_eq!(asked(&StopSignal::new()), (3, 4, 3));
    let stop = StopSignal::new();
    stop.request();
    assert_eq!(asked(&stop), (3, 0, 0));
    let stop = StopSignal::new();
    stop.cancel();
    assert_eq!(asked(&stop), (0, 0, 0));
}

#[test]
fn contradicted_bounds_and_orders_without_a_solution_cast_doubt() {
    let best = FlownOrder {
        order: vec![0],
        duration_s: 1.0,
    };
    let with = |bounds_contradicted, tours_unresolved| Incumbent {
        best: &best,
        alternatives: &[],
        lower_bound_s: 1.0,
        statistics: SearchStatistics {
            tours_unresolved,
            bounds_contradicted,
            ..SearchStatistics::default()
        },
    };
    let told = |contradicted, unresolved, optimality| {
        let doubts = doubts(&with(contradicted, unresolved), optimality);
        doubts.map(|doubt| doubt.code).collect::<Vec<_>>()
    };
    assert_eq!(told(0, 0, Optimality::Feasible), []);
    assert_eq!(told(2, 3, Optimality::Optimal), [Code::BoundContradicted]);
    assert_eq!(told(0, 3, Optimality::Feasible), [Code::SlewNotSolved]);
}
