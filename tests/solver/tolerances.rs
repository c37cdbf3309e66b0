//! No flight that the checker accepts is faster than its certified bound, even one that uses all that
//! the checker tolerates.
//!
//! Plans are made for scenarios whose attitudes, rates and limits are moved within the tolerances, and
//! verified against the scenarios as they were.

mod about_an_axis;

use nalgebra::Vector3;
use slewplan_solver::checker::{self, ATTITUDE_TOLERANCE, LIMIT_TOLERANCE, RATE_TOLERANCE};
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::{Flight, Outcome, Plan};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, StateSpec, TargetSpec};
use slewplan_solver::tour::planner::{BoundFrom, Run, solve_order};
use slewplan_tests::published_targets_spec;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::{on_threads, scenario_of};

/// Environment variable with the number of random plans.
const COUNT: &str = "SLEWPLAN_MOVED_PLANS";
/// Their number without it.
const USUAL: usize = 12;
/// Share of the tolerances that is used; the rest is the optimiser's own.
const USED: f64 = 0.97;
/// Share of moved plans that have to pass, so that the comparison means something.
const PASSING: f64 = 0.7;

/// The attitude that differs from the identity by a rotation vector, rad.
fn turned(vector: Vector3<f64>) -> AttitudeSpec {
    AttitudeSpec::Quaternion(Attitude::from_rotation_vector(vector).xyzw())
}

fn attitude(spec: &AttitudeSpec) -> Attitude {
    match spec {
        AttitudeSpec::Quaternion(xyzw) => Attitude::from_xyzw(*xyzw).expect("unit length"),
        other => panic!("{other:?} is not used here"),
    }
}

/// The plan for the targets in the order in which they are listed.
fn in_order(scenario: &Scenario, run: Run<'_>) -> Option<Plan> {
    let order: Vec<usize> = (0..scenario.targets().len()).collect();
    match solve_order(scenario, &order, BoundFrom::Certificates, run).expect("an order") {
        Outcome::Planned(plan) => Some(*plan),
        _ => None,
    }
}

/// Compares a flight that passes with the bounds of a plan for the same targets. Returns whether it
/// passes.
fn keeps_the_bounds(scenario: &Scenario, plan: &Plan, flight: &Flight) -> bool {
    if !checker::verify(scenario, flight).verification.passed {
        return false;
    }
    let total_s = flight.total_time_s;
    let Some(bound_s) = plan.certified_lower_bound_s else {
        return true;
    };
    assert!(bound_s >= 0.0, "{bound_s}");
    assert!(
        bound_s <= total_s,
        "{total_s} s is below the bound of {bound_s} s: {scenario:?}"
    );
    let mut departure_s = 0.0;
    let arrivals = flight.passages.iter().map(|p| (p.time_s, p.departure_s));
    for (leg, (arrival_s, next_s)) in plan.legs.iter().zip(arrivals.chain([(total_s, total_s)])) {
        let (flown_s, bound_s) = (arrival_s - departure_s, leg.certified_lower_bound_s);
        // Times of passages are differences of rounded numbers.
        let bound_s = bound_s.unwrap_or(0.0) - 1e-12 * total_s;
        assert!(bound_s <= flown_s, "{flown_s} s: {leg:?} of {scenario:?}");
        departure_s = next_s;
    }
    true
}

/// Six stops about the last axis of the published spacecraft that alternate between zero and an angle,
/// each moved towards the other by another angle, rad.
fn dither(angle: f64, moved: f64) -> ScenarioSpec {
    let stops = (0..6).map(|stop| TargetSpec {
        id: format!("t{stop}"),
        attitude: turned(Vector3::z() * if stop % 2 == 0 { angle - moved } else { moved }),
        position: Some(stop + 1),
        ..TargetSpec::default()
    });
    ScenarioSpec {
        targets: stops.collect(),
        end: None,
        ..published_targets_spec(&[])
    }
}

#[test]
fn a_dither_that_stays_inside_its_targets_is_not_faster_than_their_bound() {
    let scenario = scenario_of(&dither(4.85e-6, 0.0));
    let inside = scenario_of(&dither(4.85e-6, 0.95e-6));
    on_threads(1, |run| {
        let plan = in_order(&scenario, run).expect("a plan");
        let moved = in_order(&inside, run).expect("a plan");
        let (total_s, moved_s) = (plan.total_time_s, moved.total_time_s);
        assert!((total_s - 0.816).abs() < 0.001, "{total_s}");
        assert!((moved_s - 0.652).abs() < 0.001, "{moved_s}");
        let bound_s = plan.certified_lower_bound_s.expect("a bound");
        println!("{total_s} s, inside {moved_s} s, certified {bound_s} s");
        assert!(keeps_the_bounds(&scenario, &plan, &moved.flight));
        // Two tolerances of each turn are given away, and no more than that and the ramps.
        let least_s = 12.0 * (2.849e-6 / (0.0101 / 9.63_f64)).sqrt();
        assert!((0.99..1.0).contains(&(bound_s / least_s)), "{bound_s}");
    });
}

/// A random tour of few stops, most of them so close together that the tolerances matter.
fn random_tour(generator: &mut Generator) -> ScenarioSpec {
    let mut spec = ScenarioSpec {
        end: generator.coin().then(StateSpec::default),
        ..published_targets_spec(&[])
    };
    if generator.below(3) == 0 {
        (spec.spacecraft, spec.start) = generator.spacecraft();
        if generator.coin() {
            spec.start.wheel_speed_rad_s = None;
        }
    }
    let far = if generator.below(10) == 0 { 0.5 } else { 1e-4 };
    let size = generator.logarithmic(1e-7, far);
    let line = generator.coin().then(|| generator.direction());
    for stop in 0..=generator.below(5) {
        let direction = Vector3::from(line.unwrap_or_else(|| generator.direction()));
        let from = generator.between(-size, size);
        let kind = generator.below(4);
        let rests = generator.below(4) == 0;
        let mut target = generator.target(format!("t{stop}"), kind.min(1));
        target.attitude = turned(direction * from);
        target.position = Some(stop + 1);
        if rests {
            target.settle_s = generator.between(0.0, 2.0);
            target.dwell_s = generator.between(0.0, 3.0);
        }
        spec.targets.push(target);
    }
    spec
}

/// An attitude moved within the tolerance: towards the places before and after, or anywhere.
fn moved(generator: &mut Generator, own: &AttitudeSpec, neighbours: &[Attitude]) -> AttitudeSpec {
    let here = attitude(own);
    let least = ATTITUDE_TOLERANCE * USED;
    let pull: Vector3<f64> = neighbours
        .iter()
        .map(|other| here.signed_turn_to(&here.nearest_sign(other)))
        .sum();
    let step = if generator.below(8) == 0 || pull.norm() == 0.0 {
        Vector3::from(generator.direction()) * least
    } else {
        pull * (least / pull.norm()).min(0.5)
    };
    let turn = Attitude::from_rotation_vector(step);
    AttitudeSpec::Quaternion(here.then_in_body(&turn).xyzw())
}

/// The same tour with all that the checker tolerates: attitudes closer together, rates that need not
/// vanish, larger limits.
fn tolerated(generator: &mut Generator, spec: &ScenarioSpec) -> ScenarioSpec {
    let mut inside = spec.clone();
    let places: Vec<Attitude> = std::iter::once(&spec.start.attitude)
        .chain(spec.targets.iter().map(|target| &target.attitude))
        .chain(spec.end.iter().map(|end| &end.attitude))
        .map(attitude)
        .collect();
    for (index, target) in inside.targets.iter_mut().enumerate() {
        let neighbours: Vec<Attitude> = [Some(&places[index]), places.get(index + 2)]
            .into_iter()
            .flatten()
            .copied()
            .collect();
        target.attitude = moved(generator, &target.attitude, &neighbours);
        if target.settle_s + target.dwell_s == 0.0 {
            let zero = target.zero_rate_axes.take().unwrap_or([true; 3]);
            let rate = RATE_TOLERANCE * USED;
            target.rate_min_rad_s = Some(zero.map(|zero| zero.then_some(-rate)));
            target.rate_max_rad_s = Some(zero.map(|zero| zero.then_some(rate)));
        }
    }
    if let Some(end) = &mut inside.end {
        end.attitude = moved(generator, &end.attitude, &places[places.len() - 2..][..1]);
    }
    let most = 1.0 + LIMIT_TOLERANCE * USED;
    for wheel in &mut inside.spacecraft.wheels {
        wheel.max_torque_nm *= most;
        wheel.min_torque_nm = wheel.min_torque_nm.map(|torque| torque * most);
        wheel.max_speed_rad_s = wheel.max_speed_rad_s.map(|speed| speed * most);
    }
    let body = &mut inside.spacecraft;
    body.max_body_rate_rad_s = body.max_body_rate_rad_s.map(|rate| rate.map(|r| r * most));
    body.max_body_rate_norm_rad_s = body.max_body_rate_norm_rad_s.map(|rate| rate * most);
    inside
}

#[test]
fn no_plan_within_the_tolerances_is_faster_than_its_certified_bound() {
    let count: usize = std::env::var(COUNT).map_or(USUAL, |text| text.parse().expect("a number"));
    let mut generator = Generator::new(2026);
    let (mut solved, mut passed) = (0, 0);
    on_threads(1, |run| {
        for _ in 0..count {
            let spec = random_tour(&mut generator);
            let inside = scenario_of(&tolerated(&mut generator, &spec));
            let scenario = scenario_of(&spec);
            let (Some(plan), Some(faster)) = (in_order(&scenario, run), in_order(&inside, run))
            else {
                continue;
            };
            solved += 1;
            assert!(keeps_the_bounds(&scenario, &plan, &plan.flight), "{spec:?}");
            passed += usize::from(keeps_the_bounds(&scenario, &plan, &faster.flight));
        }
    });
    println!("{count} tours: {solved} solved twice, {passed} moved plans pass");
    assert!(
        passed as f64 >= PASSING * count as f64,
        "{passed} of {count}"
    );
}
