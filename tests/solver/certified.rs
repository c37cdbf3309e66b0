//! Certified bounds hold for every leg and plan, and bound the gap of a plan.

use nalgebra::Vector3;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::{LowerBoundKind, Optimality, Plan};
use slewplan_solver::model::spec::{AttitudeEquivalence, AttitudeSpec, ScenarioSpec};
use slewplan_solver::run::progress::{Observer, Progress, Stage};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{
    self, LegRow, ProofEffort, Run, Shard, leg_table, strongest_bounds,
};
use slewplan_tests::ordinary::conditioned;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, plan_of, planned, pool, scenario_of};
use slewplan_tests::{experiment_a_spec, experiment_c_spec, published_targets_spec, pyramid_spec};
use std::sync::Mutex;

/// Durations of legs are differences of times; bounds give the checker's tolerances away.
const ROUNDING: f64 = 1e-12;

fn table(spec: &ScenarioSpec, kind: LegKind) -> Vec<LegRow> {
    let (scenario, all) = (scenario_of(spec), Shard { index: 0, of: 1 });
    let (rows, complete) = on_threads(2, |run| leg_table(&scenario, kind, all, run));
    assert!(complete);
    rows
}

fn assert_legs_keep_their_bounds(plan: &Plan) {
    let mut sum = 0.0;
    for leg in &plan.legs {
        let bound = leg
            .certified_lower_bound_s
            .expect("a bound without momentum");
        assert!(bound <= leg.duration_s * (1.0 + ROUNDING), "{leg:?}");
        sum += bound;
    }
    let tour = plan.certified_lower_bound_s.expect("a bound of the tour");
    let service: f64 = plan
        .flight
        .passages
        .iter()
        .map(|p| p.departure_s - p.time_s)
        .sum();
    assert!(tour > 0.0 && tour <= sum + service, "{tour} against {sum}");
    assert!(tour <= plan.total_time_s);
    assert!(
        tour <= plan.lower_bound_s * (1.0 + ROUNDING),
        "{}",
        plan.lower_bound_s
    );
}

/// Proofs that are confirmed take seconds a leg: a few of them.
fn effort(seed: u64) -> ProofEffort {
    if seed.is_multiple_of(8) {
        ProofEffort::Confirmed
    } else {
        ProofEffort::Once
    }
}

/// Checks the strongest bounds that are known of the legs of a plan and of all tours.
fn assert_strongest_bounds_hold(spec: &ScenarioSpec, plan: &Plan, effort: ProofEffort) {
    let legs = plan.legs.iter();
    let names: Vec<_> = legs.map(|leg| (leg.from.clone(), leg.to.clone())).collect();
    let scenario = scenario_of(spec);
    let strongest = on_threads(2, |run| strongest_bounds(&scenario, &names, effort, run));
    for (leg, bound) in plan.legs.iter().zip(strongest.legs) {
        let bound = bound.map(|bound| bound.bound_s);
        assert!(bound >= leg.certified_lower_bound_s, "{bound:?} of {leg:?}");
        let bound = bound.unwrap_or(0.0);
        assert!(
            bound <= leg.duration_s * (1.0 + ROUNDING),
            "{bound} of {leg:?}"
        );
    }
    let tour = strongest.tour.map_or(0.0, |tour| tour.bound_s);
    assert!(tour <= plan.total_time_s, "{tour} of {}", plan.total_time_s);
}

#[test]
fn an_all_axes_plan_of_experiment_c_has_a_certified_gap_below_one_and_a_half_percent() {
    let mut spec = experiment_c_spec();
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    let plan = plan_of(&spec);
    assert_legs_keep_their_bounds(&plan);
    let bound = plan.certified_lower_bound_s.expect("a bound of the tour");
    let gap = 1.0 - bound / plan.total_time_s;
    println!("certified gap of the all-axes plan: {:.3} %", 100.0 * gap);
    assert!((0.0..=0.015).contains(&gap), "{gap}");
}

#[test]
fn tours_with_free_components_and_signed_quaternions_keep_their_bounds() {
    let spec = experiment_a_spec();
    let plan = plan_of(&spec);
    assert_legs_keep_their_bounds(&plan);
    assert_strongest_bounds_hold(&spec, &plan, ProofEffort::Confirmed);
    let bound = plan.certified_lower_bound_s.expect("a bound of the tour");
    assert!(bound > 0.85 * plan.total_time_s, "{bound}");
    assert_eq!(plan.lower_bound_kind, LowerBoundKind::NlpRelaxation);
    let mut signed = published_targets_spec(&["a", "e", "f"]);
    signed.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    signed.targets[1].dwell_s = 30.0;
    assert_legs_keep_their_bounds(&plan_of(&signed));
}

#[test]
fn the_long_way_to_a_quaternion_with_a_sign_is_bounded_by_its_angle() {
    let mut spec = pyramid_spec();
    spec.options.attitude_equivalence = AttitudeEquivalence::Quaternion;
    let half = 20.0_f64.to_radians();
    // 40 degrees about the first wheel's axis, but 320 the other way round.
    let (s, c) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let there = [s * half.sin(), 0.0, c * half.sin(), half.cos()];
    spec.targets[0].attitude = AttitudeSpec::Quaternion(there.map(|component| -component));
    let plan = plan_of(&spec);
    assert_strongest_bounds_hold(&spec, &plan, ProofEffort::Confirmed);
    let legs = [("start".to_owned(), "turned".to_owned())];
    let found = on_threads(1, |run| {
        strongest_bounds(&scenario_of(&spec), &legs, ProofEffort::Once, run)
    });
    let bound = found.legs[0].expect("a bound").bound_s;
    let as_rotation = plan.legs[0].certified_lower_bound_s.expect("a bound");
    assert!(bound > 2.0 * as_rotation, "{bound}, {as_rotation}");
    assert!(bound > 0.6 * plan.total_time_s, "{bound}");
}

#[test]
fn a_plan_whose_certified_bound_is_within_the_gap_asked_for_is_proved() {
    let mut spec = published_targets_spec(&["a", "b"]);
    for target in &mut spec.targets {
        target.zero_rate_axes = None;
    }
    spec.options.relative_gap = 0.03;
    let plan = plan_of(&spec);
    assert_eq!(plan.optimality, Optimality::Optimal);
    assert_eq!(plan.lower_bound_kind, LowerBoundKind::Certified);
    assert!(plan.relative_gap <= 0.03);
    assert_eq!(Some(plan.lower_bound_s), plan.certified_lower_bound_s);
}

#[test]
fn stored_momentum_is_bounded_where_speeds_are_limited() {
    let mut spec = published_targets_spec(&["a", "h"]);
    spec.start.wheel_speed_rad_s = Some(vec![60.0, -40.0, 50.0]);
    let plan = plan_of(&spec);
    assert_legs_keep_their_bounds(&plan);
    for row in table(&spec, LegKind::RestToRest) {
        let bound = row.certified_lower_bound_s.expect("a bound");
        let duration = row.duration_s.expect("a slew");
        assert!(bound <= duration * (1.0 + ROUNDING), "{row:?}");
        assert!(bound > 0.8 * duration, "{row:?}");
    }
    for wheel in &mut spec.spacecraft.wheels {
        wheel.max_speed_rad_s = None;
    }
    spec.spacecraft.max_body_rate_rad_s = [None; 3];
    for row in table(&spec, LegKind::Certified) {
        assert_eq!(
            (row.certified_lower_bound_s, row.status.as_str()),
            (None, "none")
        );
    }
}

#[test]
fn bounds_with_stored_momentum_do_not_depend_on_the_reference_frame() {
    let mut spec = published_targets_spec(&["a", "d", "h"]);
    spec.start.wheel_speed_rad_s = Some(vec![60.0, -90.0, 40.0]);
    let scenario = scenario_of(&spec);
    let turn = Attitude::from_rotation_vector(Vector3::new(0.7, -1.4, 2.0));
    let turned = |attitude: &Attitude| AttitudeSpec::Quaternion(turn.then_in_body(attitude).xyzw());
    let mut other = spec.clone();
    other.start.attitude = turned(&scenario.start().attitude);
    for (target, known) in other.targets.iter_mut().zip(scenario.targets()) {
        target.attitude = turned(&known.attitude);
    }
    other.end = None;
    spec.end = None;
    let kind = LegKind::Certified;
    for (one, same) in table(&spec, kind).iter().zip(&table(&other, kind)) {
        let bounds = [one, same].map(|row| row.certified_lower_bound_s.expect("a bound"));
        // Least times are found to 1e-4.
        let difference = (bounds[0] - bounds[1]).abs();
        assert!(difference < 2e-4 * bounds[0], "{one:?} {same:?}");
    }
}

#[test]
fn a_certified_table_is_that_of_the_solved_legs() {
    let spec = published_targets_spec(&["a", "b", "h"]);
    let (solved, certified) = (
        table(&spec, LegKind::RestToRest),
        table(&spec, LegKind::Certified),
    );
    assert_eq!(solved.len(), certified.len());
    for (solved, certified) in solved.iter().zip(&certified) {
        assert_eq!((&solved.from, &solved.to), (&certified.from, &certified.to));
        assert_eq!(certified.duration_s, None);
        assert_eq!(certified.status, "proved");
        assert!(certified.certified_lower_bound_s.is_some());
        assert_eq!(
            solved.certified_lower_bound_s,
            certified.certified_lower_bound_s
        );
    }
}

/// Wheels on any axes, any inertia, limits of the norm, locked wheels at rest, prescribed and bounded
/// and free rates at the target.
#[test]
fn random_legs_are_not_faster_than_their_bounds() {
    let mut bounded = 0;
    for seed in 0..24 {
        let mut generator = Generator::new(500 + seed);
        let (spacecraft, _) = generator.spacecraft();
        let kind = generator.below(4);
        let spec = ScenarioSpec {
            targets: vec![generator.target("there".to_owned(), kind)],
            spacecraft,
            ..ScenarioSpec::default()
        };
        let plan = plan_of(&spec);
        assert_strongest_bounds_hold(&spec, &plan, effort(seed));
        // Without limits of wheel speeds and body rates there is no box of rates.
        let body = &spec.spacecraft;
        let limited = body
            .wheels
            .iter()
            .all(|w| !w.enabled || w.max_speed_rad_s.is_some())
            || body.max_body_rate_rad_s.iter().all(Option::is_some)
            || body.max_body_rate_norm_rad_s.is_some();
        let bound = plan.legs[0].certified_lower_bound_s;
        assert_eq!(bound.is_some(), limited, "seed {seed}");
        if let Some(bound) = bound {
            let duration = plan.legs[0].duration_s;
            assert!(
                bound <= duration * (1.0 + ROUNDING),
                "seed {seed}: {bound} {duration}"
            );
            // The bound is weak for wheels on arbitrary axes, but positive.
            assert!(bound >= 0.25 * duration, "seed {seed}: {bound} {duration}");
            bounded += 1;
        }
    }
    assert!(bounded > 12, "{bounded} of 24 legs are bounded");
}

/// Momentum, locked wheels that turn, limits of the norm, asymmetric torques, windows of rates.
#[test]
fn plans_of_ordinary_spacecraft_are_not_faster_than_their_bounds() {
    for seed in 0..60 {
        let targets = 1 + usize::try_from(seed % 3).expect("few");
        let spec = conditioned(4000 + seed, targets, 3.0);
        let plan = plan_of(&spec);
        assert_legs_keep_their_bounds(&plan);
        assert_strongest_bounds_hold(&spec, &plan, effort(seed));
    }
}

/// Records the progress reports while legs are solved.
#[derive(Default)]
struct ProgressRecord(Mutex<Vec<Progress>>);

impl Observer for ProgressRecord {
    fn progress(&self, progress: Progress) {
        self.0.lock().expect("no panic").push(progress);
    }
}

#[test]
fn a_bound_is_reported_before_any_leg_is_solved_whatever_the_number_of_threads() {
    let scenario = scenario_of(&published_targets_spec(&["a", "c", "g"]));
    let told = [1, 2].map(|threads| {
        let (pool, observer) = (pool(threads), ProgressRecord::default());
        let run = Run {
            pool: &pool,
            stop: &StopSignal::new(),
            observer: &observer,
            legs: &slewplan_solver::tour::legs::NoStore,
            segments: &slewplan_solver::tour::legs::NoStore,
        };
        let plan = planned(planner::solve(&scenario, run));
        let told = observer.0.into_inner().expect("no panic");
        assert_eq!((told[0].stage, told[0].done), (Stage::Legs, 0));
        // The first report has no bound yet.
        assert_eq!(told[0].lower_bound_s, None);
        assert_eq!((told[1].stage, told[1].done), (Stage::Legs, 0));
        let bounds = told[1..].iter().map(|progress| progress.lower_bound_s);
        let bounds: Vec<_> = bounds.collect();
        assert!(bounds.iter().all(Option::is_some), "{bounds:?}");
        assert_eq!(bounds[0], plan.certified_lower_bound_s);
        assert!(
            bounds.windows(2).all(|pair| pair[0] <= pair[1]),
            "{bounds:?}"
        );
        bounds[0]
    });
    assert_eq!(told[0], told[1]);
}
