//! Bounds that a solved leg contradicts, and legs that are kept.

use super::*;
use crate::model::scenario::Scenario;
use crate::model::scenario::reference::experiment_a;
use crate::model::spec::{Applies, BoresightSpec, ConeSpec};
use crate::run::progress::Observer;
use crate::tour::legs::NoStore;
use crate::tour::planner::places::MAX_TARGETS_ALL_LEGS;
use crate::tour::planner::tests::with_leg_solver;
use nalgebra::Vector3;

/// Counts contradictions.
#[derive(Default)]
struct Counter(AtomicU64);

impl Observer for Counter {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, _: &Contradiction) {
        self.0.fetch_add(1, Relaxed);
    }
}

/// Calls with a solver of the legs of experiment A; returns the number of contradictions reported.
fn contradictions(work: impl FnOnce(&LegSolver<'_>)) -> u64 {
    let scenario = Scenario::try_new(&experiment_a()).expect("valid").scenario;
    let (counter, stop) = (Counter::default(), StopSignal::new());
    with_leg_solver(&scenario, &counter, &NoStore, &stop, |legs, _| work(legs));
    counter.0.load(Relaxed)
}

const ENDS: [Place; 2] = [Place::Start, Place::Target(0)];

#[test]
fn a_bound_above_the_duration_of_a_solved_leg_is_reported_and_dropped() {
    for (bound_s, is_false) in [(10.0, false), (1e4, true)] {
        let reported = contradictions(|legs| {
            let leg = legs.canonical(LegKind::RestToRest, (ENDS[0], ENDS[1]), CanonicalLeg::of);
            let known = CertifiedLeg {
                lower_bound: Some(bound_s),
                solve_time: 0.0,
            };
            let forms = [Some(leg.clone())];
            let pool = legs.run.pool;
            legs.certified.of(&forms, pool, |_| (), |_, _| Some(known));
            let solved = legs.solve(LegKind::RestToRest, &leg);
            assert!(solved.solution.duration().is_some());
            assert_eq!(solved.certified.is_none(), is_false);
            assert_eq!(legs.bounds_are_trusted(), !is_false);
        });
        assert_eq!(reported, u64::from(is_false));
    }
}

#[test]
fn a_leg_is_solved_once_however_often_it_is_asked_for() {
    contradictions(|legs| {
        let ask = || legs.leg(LegKind::LowerBound, ENDS[0], ENDS[1]).duration();
        let first = ask();
        let [solved, stored, programs] = legs.work();
        assert!(first.is_some() && programs > 0);
        assert_eq!((solved, stored), (1, 0));
        assert_eq!((ask(), legs.work()), (first, [1, 0, programs]));
    });
}

/// Between free places among many only the ends of motions are kept, and the motion is the same when it
/// is asked for again.
#[test]
fn a_motion_that_is_not_kept_is_solved_again() {
    let mut spec = experiment_a();
    for i in 0..MAX_TARGETS_ALL_LEGS {
        let mut target = spec.targets[i % 6].clone();
        target.id = format!("{i}");
        spec.targets.push(target);
    }
    for target in &mut spec.targets {
        target.zero_rate_axes = Some([false, false, true]);
    }
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let (counter, stop) = (Counter::default(), StopSignal::new());
    with_leg_solver(&scenario, &counter, &NoStore, &stop, |legs, _| {
        let kept = |from, to| {
            let whole = legs.leg(LegKind::LowerBound, from, to);
            let known = legs.solved_legs(LegKind::LowerBound, &[(from, to)]);
            let known = known[0].clone().expect("solved");
            assert_eq!(
                legs.leg(LegKind::LowerBound, from, to).profile,
                whole.profile
            );
            let begin = legs.places().waypoint(from).attitude;
            let dynamics = &legs.places().dynamics;
            let rates = known.rates_at_ends(dynamics, &begin).expect("a motion");
            let motion = &whole.profile;
            for (rate, node) in rates.into_iter().zip([0, motion.intervals()]) {
                let exact = dynamics.rate(&motion.attitudes[node], &motion.wheels[node]);
                assert!((rate - exact).amax() <= 1e-15);
            }
            assert_eq!(known.leg.solution.duration(), whole.duration());
            assert_eq!(
                known.whole_beginning_at(&begin).is_some(),
                !known.leg.is_condensed
            );
            known.leg.solution.profile.intervals()
        };
        assert_eq!(kept(Place::Target(0), Place::Target(1)), 1);
        assert!(kept(Place::Start, Place::Target(1)) > 1);
    });
}

/// Experiment A with a cone on the way of the camera from the start to the first target.
fn with_a_cone_between() -> Scenario {
    let mut spec = experiment_a();
    let free = Scenario::try_new(&spec).expect("valid").scenario;
    let ends = [free.start().attitude, free.targets()[0].attitude];
    let [from, to] = ends.map(|attitude| attitude.to_reference(Vector3::x()));
    let halfway: [f64; 3] = (from + to).into();
    spec.spacecraft.boresights.push(BoresightSpec {
        name: "camera".into(),
        axis: [1.0, 0.0, 0.0],
    });
    spec.keep_out.push(ConeSpec {
        boresight: "camera".into(),
        direction: halfway.into(),
        half_angle_deg: 4.0,
        applies: Applies::Always,
    });
    Scenario::try_new(&spec).expect("valid").scenario
}

#[test]
fn a_stopped_solve_has_no_leg_rather_than_one_through_a_cone() {
    let scenario = with_a_cone_between();
    let (counter, stop) = (Counter::default(), StopSignal::new());
    with_leg_solver(&scenario, &counter, &NoStore, &stop, |legs, _| {
        let kind = LegKind::LowerBound;
        let free = legs.canonical(kind, (ENDS[0], ENDS[1]), CanonicalLeg::of);
        let free = legs.known_or_solved(kind, ENDS[0], &free);
        assert!(free.duration().is_some() && !is_clear(&legs.places.with_cones, &free.profile));
        stop.cancel();
        assert_eq!(legs.leg(kind, ENDS[0], ENDS[1]).duration(), None);
        assert!(legs.solved_legs(kind, &[(ENDS[0], ENDS[1])])[0].is_none());
    });
}
