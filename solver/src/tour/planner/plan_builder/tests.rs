//! Contradicted bounds and unsolved orders: warnings of a plan, and bounds that it no longer gives.

use super::*;
use crate::model::plan::LowerBoundKind;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::run::contradiction::Contradiction;
use crate::run::progress::Observer;
use crate::run::stop::StopSignal;
use crate::tour::legs::{LegStore, NoStore, StoredLeg};
use crate::tour::order::TourEvaluation;
use crate::tour::order::TourModel;
use crate::tour::planner::tests::with_leg_solver;

/// Records contradictions.
#[derive(Default)]
struct Listener(Mutex<Vec<Contradiction>>);

impl Observer for Listener {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, contradiction: &Contradiction) {
        self.0.lock().expect("no panic").push(contradiction.clone());
    }
}

/// Two targets without rate conditions of single axes.
fn scenario() -> Scenario {
    let mut spec = experiment_a();
    spec.targets.truncate(2);
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    Scenario::try_new(&spec).expect("valid").scenario
}

/// The plan of an order whose certified bound is a multiple of its duration, and the contradictions
/// reported.
fn plan_with_bound(factor: f64) -> (Plan, Vec<Contradiction>) {
    let (scenario, listener) = (scenario(), Listener::default());
    let stop = StopSignal::new();
    let plan = with_leg_solver(&scenario, &listener, &NoStore, &stop, |legs, run| {
        let tours = Tours::new(legs.places(), legs, &stop);
        let TourEvaluation::Solved(duration_s) = tours.tour(&[0, 1]) else {
            panic!("the order has a tour");
        };
        let mut builder = PlanBuilder::new(&tours, run, Instant::now());
        builder.set_certified_bound(Some(factor * duration_s));
        let best = SolvedOrder {
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
        match builder.outcome(&best, &found) {
            Outcome::Planned(plan) => *plan,
            other => panic!("no plan: {other:?}"),
        }
    });
    (plan, listener.0.into_inner().expect("no panic"))
}

#[test]
fn a_certified_bound_above_the_duration_is_reported_and_not_in_the_plan() {
    let (plan, reported) = plan_with_bound(0.98);
    let expected = (Optimality::Optimal, Vec::new());
    assert_eq!((plan.optimality, reported), expected);
    assert!(plan.certified_lower_bound_s.is_some() && plan.warnings.is_empty());
    // A bound gives the tolerances of a flight away, so that only rounding remains.
    assert_eq!(plan_with_bound(1.0 + 1e-10).1, []);
    let (plan, reported) = plan_with_bound(1.0 + 3e-6);
    let [
        Contradiction::Tour {
            route,
            leg,
            bound_s,
            duration_s,
        },
    ] = &reported[..]
    else {
        panic!("{reported:?}");
    };
    assert_eq!((route.len(), leg), (4, &None));
    assert!(bound_s > duration_s);
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

/// A store that answers every identity with the first leg stored, its certified bound replaced by a
/// multiple of its duration.
struct FaultyStore {
    first: Mutex<Option<StoredLeg>>,
    bound_factor: f64,
}

impl FaultyStore {
    fn new(bound_factor: f64) -> Self {
        Self {
            first: Mutex::default(),
            bound_factor,
        }
    }
}

impl LegStore for FaultyStore {
    fn get(&self, _: &str) -> Option<StoredLeg> {
        let known = self.first.lock().expect("no panic").clone()?;
        Some(StoredLeg {
            certified_lower_bound_s: Some(self.bound_factor * known.duration_s),
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

/// Duration and certified bound, s, of the rest-to-rest leg to a target.
fn leg_from(store: &dyn LegStore, listener: &Listener, target: usize) -> (f64, Option<f64>) {
    let (scenario, stop) = (scenario(), StopSignal::new());
    with_leg_solver(&scenario, listener, store, &stop, |legs, _| {
        let pair = (Place::Start, Place::Target(target));
        let table = legs.table_without_cones(LegKind::RestToRest, &[pair]);
        let leg = &table.get(pair.0, pair.1).expect("a leg").leg;
        (leg.solution.duration().expect("converged"), leg.certified)
    })
}

#[test]
fn a_stored_leg_with_another_motion_or_a_false_bound_is_reported_and_not_used() {
    let (store, listener) = (FaultyStore::new(0.9), Listener::default());
    let (first, _) = leg_from(&store, &listener, 0);
    let (again, certified) = leg_from(&store, &listener, 0);
    assert!((again - first).abs() <= 0.0 && certified == Some(0.9 * first));
    assert_eq!(listener.0.lock().expect("no panic").len(), 0);
    // The motion to another target is refused, and the leg is solved instead.
    let (other, _) = leg_from(&store, &listener, 1);
    let (right, _) = leg_from(&FaultyStore::new(1.0), &listener, 1);
    assert!((other - right).abs() <= 0.0, "{other} {right}");
    let reported = std::mem::take(&mut *listener.0.lock().expect("no panic"));
    assert!(
        matches!(&reported[..], [Contradiction::StoredLeg { .. }]),
        "{reported:?}"
    );
    // A bound above the duration is dropped, and the motion is kept.
    let store = FaultyStore {
        bound_factor: 1.01,
        ..store
    };
    let (kept, certified) = leg_from(&store, &listener, 0);
    assert!((kept - first).abs() <= 0.0 && certified.is_none());
    let reported = listener.0.into_inner().expect("no panic");
    assert!(
        matches!(&reported[..], [Contradiction::Leg { .. }]),
        "{reported:?}"
    );
}

/// A store that has forgotten what was proved of its only leg.
#[derive(Default)]
struct UnprovedStore(Mutex<Vec<StoredLeg>>);

impl LegStore for UnprovedStore {
    fn get(&self, _: &str) -> Option<StoredLeg> {
        let known = self.0.lock().expect("no panic").first().cloned()?;
        Some(StoredLeg {
            certified_lower_bound_s: None,
            ..known
        })
    }

    fn put(&self, _: &str, leg: &StoredLeg) {
        self.0.lock().expect("no panic").push(leg.clone());
    }
}

#[test]
fn the_bound_of_a_stored_leg_is_computed_again_where_the_store_has_none() {
    let (store, listener) = (UnprovedStore::default(), Listener::default());
    let leg = || leg_from(&store, &listener, 0);
    let (duration_s, bound_s) = leg();
    assert!(bound_s > Some(0.9 * duration_s));
    assert_eq!(leg().1, bound_s);
    let stored = store.0.into_inner().expect("no panic");
    let [solved, proved] = &stored[..] else {
        panic!("{} legs", stored.len());
    };
    assert_eq!(proved, solved);
    assert_eq!(proved.certified_lower_bound_s, bound_s);
}

/// An empty store that records the identities it is asked for.
#[derive(Default)]
struct RecordingStore(Mutex<Vec<String>>);

impl LegStore for RecordingStore {
    fn get(&self, identity: &str) -> Option<StoredLeg> {
        self.0.lock().expect("no panic").push(identity.into());
        None
    }

    fn put(&self, _: &str, _: &StoredLeg) {}
}

/// Numbers of store look-ups, of legs in the table, and of legs solved.
fn lookups_and_solves(stop: &StopSignal) -> (usize, usize, u64) {
    let store = RecordingStore::default();
    let listener = Listener::default();
    let (start, first, second) = (Place::Start, Place::Target(0), Place::Target(1));
    // Two of the four are one problem: without momentum a leg is reversible.
    let pairs = [
        (start, first),
        (first, second),
        (second, first),
        (start, second),
    ];
    let (known, solved) = with_leg_solver(&scenario(), &listener, &store, stop, |legs, _| {
        let table = legs.table_without_cones(LegKind::RestToRest, &pairs);
        let known = pairs
            .iter()
            .filter(|(from, to)| table.get(*from, *to).is_some());
        (known.count(), legs.work()[0])
    });
    let lookups = store.0.lock().expect("no panic").len();
    (lookups, known, solved)
}

#[test]
fn a_request_to_stop_still_reads_the_store_and_a_cancellation_does_not() {
    assert_eq!(lookups_and_solves(&StopSignal::new()), (3, 4, 3));
    let stop = StopSignal::new();
    stop.request();
    assert_eq!(lookups_and_solves(&stop), (3, 0, 0));
    let stop = StopSignal::new();
    stop.cancel();
    assert_eq!(lookups_and_solves(&stop), (0, 0, 0));
}

#[test]
fn contradicted_bounds_and_orders_without_a_solution_give_warnings() {
    let best = SolvedOrder {
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
    let codes = |contradicted, unresolved, optimality| {
        let warnings = search_warnings(&with(contradicted, unresolved), optimality);
        warnings.map(|warning| warning.code).collect::<Vec<_>>()
    };
    assert_eq!(codes(0, 0, Optimality::Feasible), []);
    assert_eq!(codes(2, 3, Optimality::Optimal), [Code::BoundContradicted]);
    assert_eq!(codes(0, 3, Optimality::Feasible), [Code::SlewNotSolved]);
}
