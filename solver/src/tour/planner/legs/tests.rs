//! What is kept of a leg, and what is not.

use super::*;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::run::pool::SolverPool;
use crate::run::progress::Observer;
use crate::tour::legs::NoStore;
use std::num::NonZeroUsize;

/// Counts contradictions.
#[derive(Default)]
struct Counter(AtomicU64);

impl Observer for Counter {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, _: &Contradiction) {
        self.0.fetch_add(1, Relaxed);
    }
}

/// Tries something with legs of experiment A; how often a flight contradicted a bound meanwhile.
fn contradictions(scene: impl FnOnce(&LegSolver<'_>)) -> u64 {
    let scenario = Scenario::try_new(&experiment_a()).expect("valid").scenario;
    let (counter, stop) = (Counter::default(), StopSignal::new());
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let run = Run {
        pool: &pool,
        stop: &stop,
        observer: &counter,
        legs: &NoStore,
        segments: &NoStore,
    };
    let places = Places::of(&scenario);
    scene(&LegSolver::new(&places, run, &stop));
    counter.0.load(Relaxed)
}

const ENDS: [Place; 2] = [Place::Start, Place::Target(0)];

#[test]
fn a_bound_above_a_fresh_flight_is_told_and_taken_from_it() {
    for (bound_s, is_false) in [(10.0, false), (1e4, true)] {
        let told = contradictions(|legs| {
            let leg = legs.canonical(LegKind::RestToRest, ENDS[0], ENDS[1]);
            let known = CertifiedLeg {
                lower_bound: Some(bound_s),
                solve_time: 0.0,
            };
            lock(&legs.certified).insert(leg.identity.clone(), known);
            let solved = legs.solve(LegKind::RestToRest, &leg);
            assert!(solved.flown.duration().is_some());
            assert_eq!(solved.certified.is_none(), is_false);
            assert_eq!(legs.bounds_are_trusted(), !is_false);
        });
        assert_eq!(told, u64::from(is_false));
    }
}

#[test]
fn a_leg_that_is_asked_for_again_is_not_solved_again() {
    contradictions(|legs| {
        let ask = || legs.leg(LegKind::LowerBound, ENDS[0], ENDS[1]).duration();
        let first = ask();
        let [solved, stored, programs] = legs.work();
        assert!(first.is_some() && programs > 0);
        assert_eq!((solved, stored), (1, 0));
        assert_eq!((ask(), legs.work()), (first, [1, 0, programs]));
    });
}
