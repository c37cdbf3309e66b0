//! Studies of envelopes: the published pyramid, and what is refused.

use slewplan_solver::model::problem::Code;
use slewplan_solver::model::spec::{AttitudeSpec, PairSpec};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::WheelAllocation;
use slewplan_studies::eigenaxis::EnvelopeLimit;
use slewplan_studies::envelope_path::EnvelopePath;
use slewplan_studies::envelope_study::{
    EnvelopeOptionsSpec, EnvelopeReport, EnvelopeStudy, EnvelopeStudySpec, MAX_DEMANDS,
};
use slewplan_tests::pyramid_spec;

const S: f64 = 0.816_496_580_927_726;
const C: f64 = 0.577_350_269_189_625_8;

/// The thesis's pyramid and its turn by 120 degrees about the axis of the first wheel, with the
/// demand of its example (equation 90).
fn thesis() -> EnvelopeStudySpec {
    let sin_half = 60.0_f64.to_radians().sin();
    EnvelopeStudySpec {
        spacecraft: pyramid_spec().spacecraft,
        name: None,
        options: EnvelopeOptionsSpec::default(),
        turns: vec![PairSpec {
            from: AttitudeSpec::default(),
            // With the sign of the longer turn, which the study does not take.
            to: AttitudeSpec::Quaternion([-S * sin_half, 0.0, -C * sin_half, -0.5]),
        }],
        demands_nm: vec![[2.0 * S * 0.0857, 0.0, 2.0 * C * 0.0857]],
        time_optimal: true,
    }
}

fn report(spec: &EnvelopeStudySpec) -> EnvelopeReport {
    let (study, warnings) = EnvelopeStudy::try_new(spec).expect("a valid study");
    assert_eq!(warnings, []);
    study.conduct(&SolverPool::new(None).expect("threads"), &StopSignal::new())
}

#[test]
fn the_published_slew_has_its_durations_and_shares_of_the_envelopes() {
    let report = report(&thesis());
    assert!(report.complete);
    let [turn] = &report.turns[..] else {
        panic!("one turn");
    };
    assert!((turn.vector.norm() - 120.0_f64.to_radians()).abs() < 1e-12);
    let limits = turn.eigenaxis.iter().map(|(slew, _)| slew.limit);
    assert!(limits.eq(EnvelopeLimit::ALL));
    let about = |limit: usize| turn.eigenaxis[limit].0.course.duration();
    assert!((about(1) - 51.57).abs() < 0.01 && (about(3) - 38.27).abs() < 0.01);
    let [free, shared] = &turn.time_optimal[..] else {
        panic!("two slews: {:?}", turn.time_optimal);
    };
    assert_eq!(free.allocation, WheelAllocation::Free);
    let (free, beyond) = free.found.as_ref().expect("solved");
    let (shared, within) = shared.found.as_ref().expect("solved");
    println!("free {free} s, by the pseudo-inverse {shared} s");
    assert!((free - 38.27).abs() < 0.01);
    assert!(*shared < about(1) - 3.0 && *shared > free + 5.0);
    // The first exceeds the pseudo-inverse envelope, the second stays within it.
    let most = |path: &EnvelopePath| {
        let momentum = path.momentum.iter().map(|sample| sample.momentum);
        let torque = path.torque.iter().map(|step| step.torque);
        let points = momentum.chain(torque);
        let shares = points.map(|point| point.pseudo_inverse_share);
        shares.fold(0.0, f64::max)
    };
    assert!((most(beyond) - 1.5).abs() < 1e-3);
    let reached = most(within);
    assert!(reached <= 1.0 + 1e-6 && reached > 1.0 - 1e-4, "{reached}");
}

#[test]
fn the_demand_of_the_example_is_within_reach_of_the_least_load_only() {
    let report = report(&thesis());
    let demand = &report.demands[0];
    assert!((demand.pseudo_inverse.load - 1.5).abs() < 1e-12);
    let least = demand.least_load.as_ref().expect("solved");
    assert!((least.load - 1.0).abs() < 1e-6);
    let torque = &report.envelopes.torque.array;
    assert!((torque.sum(&least.wheels) - demand.torque).norm() < 1e-12);
}

#[test]
fn without_a_speed_limit_there_are_paths_of_torque_only() {
    let mut spec = thesis();
    spec.spacecraft.wheels[1].max_speed_rad_s = None;
    let report = report(&spec);
    assert!(report.envelopes.momentum.is_none());
    let turn = &report.turns[0];
    let optimal = turn.time_optimal[0].found.as_ref().expect("solved");
    for path in [&turn.eigenaxis[0].1, &optimal.1] {
        assert!(path.momentum.is_empty() && !path.torque.is_empty());
    }
}

#[test]
fn a_stop_leaves_out_the_optimised_slews() {
    let stop = StopSignal::new();
    stop.cancel();
    let (study, _) = EnvelopeStudy::try_new(&thesis()).expect("a valid study");
    let report = study.conduct(&SolverPool::new(None).expect("threads"), &stop);
    assert!(!report.complete && report.turns[0].time_optimal.is_empty());
    assert_eq!(report.turns[0].eigenaxis.len(), 4);
}

#[test]
fn all_problems_of_a_study_have_their_pointers() {
    let mut spec = thesis();
    spec.spacecraft.wheels[2].max_torque_nm = -1.0;
    spec.options.momentum_authority = 1.5;
    spec.turns.push(PairSpec::default());
    spec.turns.push(PairSpec {
        to: AttitudeSpec::Mrp([f64::NAN, 0.0, 0.0]),
        ..PairSpec::default()
    });
    spec.demands_nm = vec![[0.0, f64::INFINITY, 0.0]; MAX_DEMANDS + 1];
    let problems = EnvelopeStudy::try_new(&spec).expect_err("problems");
    let found: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
    for place in [
        "/spacecraft/wheels/2/max_torque_nm",
        "/options/momentum_authority",
        "/turns/1",
        "/turns/2/to/mrp/0",
        "/demands_nm",
        "/demands_nm/900/1",
    ] {
        assert!(
            found.contains(&place),
            "{place} is not in {:?}",
            &found[..6]
        );
    }
}

#[test]
fn requests_whose_results_overflow_are_refused() {
    let at = |change: fn(&mut EnvelopeStudySpec)| {
        let mut spec = thesis();
        change(&mut spec);
        let problems = EnvelopeStudy::try_new(&spec).expect_err("problems");
        assert_eq!(problems.len(), 1, "{problems:?}");
        assert_eq!(problems[0].code, Code::OutOfRange);
        problems[0].pointer.clone()
    };
    let immense = at(|spec| spec.spacecraft.wheels[0].max_torque_nm = 1e200);
    assert_eq!(immense, "/spacecraft/wheels");
    let minute = at(|spec| {
        let wheels = spec.spacecraft.wheels.iter_mut();
        wheels.for_each(|wheel| wheel.max_torque_nm = 1e-200);
    });
    assert_eq!(minute, "/spacecraft/wheels");
    let heavy = at(|spec| spec.demands_nm.push([1e308, 0.0, 0.0]));
    assert_eq!(heavy, "/demands_nm/1");
}
