//! The published pyramid of four wheels: random slews against the published curve, and the path of a
//! slew within the envelopes.

use slewplan_solver::math::bang_coast_bang::BangCoastBang;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::spec::{AttitudeSpec, PairSpec, ScenarioSpec, StateSpec};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_studies::comparison::{PyramidControl, Radii};
use slewplan_studies::eigenaxis::Baselines;
use slewplan_studies::envelope_path::EnvelopePath;
use slewplan_studies::envelope_study::{EnvelopeOptionsSpec, EnvelopeStudy, EnvelopeStudySpec};
use slewplan_tests::pyramid_spec;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{agree, plan_of, scenario_of};

/// Inertia about every axis, kg m², and momentum of a wheel, N m s.
const INERTIA: f64 = 25.4;
const MOMENTUM: f64 = 1.0;
const SLEWS: usize = 100;

/// A random attitude as the RW/CMG thesis draws it (equation 175).
fn random_attitude(generator: &mut Generator) -> Attitude {
    let components = [(); 4].map(|()| generator.between(-1.0, 1.0));
    Attitude::from_xyzw(components).expect("not all components are zero")
}

/// Duration, s, on a published curve, which has the radii of a control in all directions.
fn on_curve(control: PyramidControl, angle: f64, torque: f64) -> f64 {
    let radius = Radii::PUBLISHED.of(control);
    let acceleration = radius.torque * torque / INERTIA;
    let rate = radius.momentum * MOMENTUM / INERTIA;
    BangCoastBang::fastest(angle, acceleration, rate).duration()
}

/// From a random attitude to the identity, at rest and with wheels at zero at both ends.
fn random_slew(generator: &mut Generator, torque: f64) -> (f64, ScenarioSpec) {
    let from = random_attitude(generator);
    let mut spec = pyramid_spec();
    spec.targets.clear();
    spec.start.attitude = AttitudeSpec::Quaternion(from.xyzw());
    spec.end = Some(StateSpec {
        wheel_speed_rad_s: Some(vec![0.0; 4]),
        ..StateSpec::default()
    });
    for wheel in &mut spec.spacecraft.wheels {
        wheel.max_torque_nm = torque;
    }
    (from.angle_to(&Attitude::identity()), spec)
}

/// The greatest ratio of a slew's duration to that on the curve.
fn worst_share(torque: f64) -> f64 {
    let mut generator = Generator::new(175);
    let shares = (0..SLEWS).map(|_| {
        let (angle, spec) = random_slew(&mut generator, torque);
        let curve = on_curve(PyramidControl::Optimal, angle, torque);
        let share = plan_of(&spec).total_time_s / curve;
        if share > 0.99 {
            println!(
                "{:.1} degrees: {share:.4} of {curve:.2} s",
                angle.to_degrees()
            );
        }
        share
    });
    let shares: Vec<f64> = shares.collect();
    let mean = shares.iter().sum::<f64>() / SLEWS as f64;
    let worst = shares.into_iter().fold(0.0, f64::max);
    println!("{torque} N m: {mean:.4} of the curve in the mean, {worst:.4} at most");
    worst
}

#[test]
fn random_slews_lie_on_or_below_the_published_curve() {
    assert!(worst_share(0.0857) <= 1.0);
}

#[test]
fn random_slews_with_the_torque_of_the_published_figure_lie_on_or_below_its_curve() {
    assert!(worst_share(0.1) <= 1.0);
}

#[test]
fn random_slews_by_the_pseudo_inverse_lie_near_the_published_curve() {
    let mut generator = Generator::new(175);
    let turns = [(); SLEWS / 2].map(|()| PairSpec {
        from: AttitudeSpec::Quaternion(random_attitude(&mut generator).xyzw()),
        to: AttitudeSpec::default(),
    });
    let spec = EnvelopeStudySpec {
        spacecraft: pyramid_spec().spacecraft,
        name: None,
        options: EnvelopeOptionsSpec::default(),
        turns: turns.into(),
        demands_nm: Vec::new(),
        time_optimal: true,
    };
    let (study, _) = EnvelopeStudy::try_new(&spec).expect("a valid study");
    let pool = SolverPool::new(None).expect("threads");
    let report = study.conduct(&pool, &StopSignal::new());
    let shares = report.turns.iter().map(|turn| {
        let [free, shared] = [0, 1].map(|i| {
            let found = turn.time_optimal[i].found.as_ref();
            found.expect("a slew").0
        });
        let about = turn.eigenaxis[1].0.course.duration();
        let slack = 1.0 + 1e-4;
        assert!(free <= shared * slack && shared <= about * slack);
        let curve = on_curve(PyramidControl::PseudoOptimal, turn.vector.norm(), 0.0857);
        shared / curve
    });
    let shares: Vec<f64> = shares.collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    let worst = shares.into_iter().fold(0.0, f64::max);
    println!("{mean:.4} of the curve in the mean, {worst:.4} at most");
    assert!(mean < 0.92 && worst < 1.01);
}

#[test]
fn a_time_optimal_slew_exceeds_the_pseudo_inverse_envelope() {
    let spec = pyramid_spec();
    let scenario = scenario_of(&spec);
    let spacecraft = scenario.spacecraft();
    let baselines = Baselines::of(spacecraft, 1.0, 1.0).expect("valid authorities");
    let envelopes = baselines.envelopes();
    let plan = plan_of(&spec);
    let (states, controls) = (&plan.states, &plan.flight.controls);
    let path = EnvelopePath::of_flight(envelopes, spacecraft, states, controls);
    let momentum = path.momentum.iter().map(|sample| sample.momentum);
    let torque = path.torque.iter().map(|step| step.torque);
    for (name, points) in [
        ("momentum", momentum.collect::<Vec<_>>()),
        ("torque", torque.collect()),
    ] {
        let most = |share: fn(&_) -> f64| points.iter().map(share).fold(0.0, f64::max);
        let full = most(|point: &slewplan_studies::envelope_path::EnvelopePoint| point.full_share);
        let simple = most(|point| point.pseudo_inverse_share);
        println!("{name}: {full:.4} of the full envelope, {simple:.4} of the pseudo-inverse's");
        assert!(full <= 1.0 + 1e-6 && full > 0.99);
        assert!(simple > 1.05);
    }
    // Torque at a minor vertex, twice a wheel's (figure 73, point 2).
    let torque = path.torque.iter().map(|step| step.torque.vector.norm());
    assert!(torque.fold(0.0, f64::max) > 0.99 * 2.0 * 0.0857);
    // The slew about the eigenaxis by the pseudo-inverse takes 51.6 s and uses two thirds of it.
    let turn = scenario
        .start()
        .attitude
        .signed_turn_to(&scenario.targets()[0].attitude);
    let [_, simple, _, full] = baselines.slews(&turn).expect("a turn");
    assert!((simple.course.duration() - 51.6).abs() < 0.05);
    // By the least load it is as fast as the time-optimal one, since the axis meets a vertex.
    let fastest = full.course.duration();
    println!(
        "{:.3} s, about the eigenaxis {fastest:.3} s",
        plan.total_time_s
    );
    assert!(agree(plan.total_time_s, fastest, 5e-4));
    let straight = EnvelopePath::of_eigenaxis_slew(envelopes, &simple);
    assert!((straight.momentum[1].momentum.full_share - 2.0 / 3.0).abs() < 1e-9);
}
