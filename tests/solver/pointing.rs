//! Tours through directions whose roll is left to the plan.

use nalgebra::Vector3;
use slewplan_solver::model::plan::Plan;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    Applies, AttitudeSpec, BoresightChoice, BoresightSpec, ConeSpec, DirectionSpec, ScenarioSpec,
};
use slewplan_tests::solving::{on_threads, order_of, plan_of, planned, scenario_of};
use slewplan_tests::{experiment_a_spec, pointed_target, pyramid_spec};

/// Right ascensions and declinations, degrees.
const STARS: [[f64; 2]; 4] = [
    [101.287, -16.716],
    [279.235, 38.784],
    [213.915, 19.182],
    [344.413, -29.622],
];
/// A camera, not along a body axis.
const CAMERA: [f64; 3] = [0.1, -0.2, 1.0];

fn pointings(mut spec: ScenarioSpec, roll_deg: Option<[f64; 2]>) -> ScenarioSpec {
    let target = |(i, ra_dec_deg): (usize, &[f64; 2])| {
        pointed_target(&format!("s{i}"), CAMERA, *ra_dec_deg, roll_deg)
    };
    spec.targets = STARS.iter().enumerate().map(target).collect();
    spec
}

/// The same directions with a given roll.
fn given(spec: &ScenarioSpec, roll_deg: f64) -> ScenarioSpec {
    let mut spec = spec.clone();
    for (target, [ra, dec]) in spec.targets.iter_mut().zip(STARS) {
        target.pointing = None;
        target.attitude = AttitudeSpec::RaDecRollDeg {
            angles: [ra, dec, roll_deg],
            boresight: BoresightChoice::Axis(CAMERA),
        };
    }
    spec
}

/// Whether the bounds of a plan and of its legs hold, and the boresight passes every direction.
fn assert_sound(spec: &ScenarioSpec, plan: &Plan) {
    assert!(plan.verification.passed, "{:?}", plan.verification);
    assert!(plan.lower_bound_s <= plan.total_time_s);
    assert!(
        plan.certified_lower_bound_s
            .is_none_or(|bound| bound <= plan.total_time_s)
    );
    for leg in &plan.legs {
        let bound = leg.certified_lower_bound_s;
        assert!(
            bound.is_some_and(|bound| 0.0 <= bound && bound <= leg.duration_s),
            "{leg:?}"
        );
    }
    let scenario: Scenario = scenario_of(spec);
    for passage in &plan.flight.passages {
        let at = |state: &&slewplan_solver::model::plan::State| {
            (state.time_s - passage.time_s).abs() < 1e-6 * plan.total_time_s
        };
        let state = plan.states.iter().find(at).expect("states at passages");
        let target = scenario
            .targets()
            .iter()
            .find(|target| target.id == passage.target);
        let target = target.expect("a target of the scenario");
        let roll = target.roll.expect("a free roll");
        assert!(roll.off_boresight(&target.attitude, &state.attitude) < 1e-5);
        let turned = roll.between(&target.attitude, &state.attitude);
        assert!((roll.nearest(turned) - turned).abs() < 1e-5, "{turned}");
    }
}

#[test]
fn a_free_roll_makes_tours_shorter_and_a_limited_one_less_so() {
    for spec in [experiment_a_spec(), pyramid_spec()] {
        let free = pointings(spec.clone(), None);
        let limited = pointings(spec.clone(), Some([-30.0, 50.0]));
        let plans = [&free, &limited].map(plan_of);
        assert_sound(&free, &plans[0]);
        assert_sound(&limited, &plans[1]);
        let totals = plans.map(|plan| plan.total_time_s);
        let given = plan_of(&given(&free, 0.0)).total_time_s;
        assert!(
            totals[0] < totals[1] && totals[1] < given,
            "{totals:?} {given}"
        );
    }
}

#[test]
fn a_roll_that_is_nearly_given_is_planned_as_a_given_one() {
    let spec = pointings(experiment_a_spec(), Some([9.999, 10.001]));
    let narrow = plan_of(&spec);
    assert_sound(&spec, &narrow);
    let given = plan_of(&given(&spec, 10.0));
    let difference = narrow.total_time_s / given.total_time_s - 1.0;
    assert!(difference.abs() < 1e-4, "{difference}");
    assert_eq!(order_of(&narrow), order_of(&given));
}

#[test]
fn plans_do_not_depend_on_the_number_of_threads() {
    let scenario = scenario_of(&pointings(experiment_a_spec(), None));
    let plan = |threads| {
        planned(on_threads(threads, |run| {
            slewplan_solver::tour::planner::solve(&scenario, run)
        }))
    };
    let (one, three) = (plan(1), plan(3));
    assert_eq!(one.flight, three.flight);
    assert_eq!(one.lower_bound_s.to_bits(), three.lower_bound_s.to_bits());
}

#[test]
fn rates_may_be_free_too_and_stored_momentum_is_held() {
    let mut spec = pointings(experiment_a_spec(), None);
    for target in &mut spec.targets {
        target.zero_rate_axes = Some([false, false, true]);
    }
    let moving = plan_of(&spec);
    assert_sound(&spec, &moving);
    let resting = plan_of(&pointings(experiment_a_spec(), None));
    assert!(moving.total_time_s < resting.total_time_s);

    let mut spec = pointings(pyramid_spec(), None);
    spec.start.wheel_speed_rad_s = Some(vec![60.0, -30.0, 20.0, 40.0]);
    assert_sound(&spec, &plan_of(&spec));
}

/// Body axes with names, and a cone of one of them around a direction.
const AXES: [(&str, [f64; 3]); 3] = [
    ("x", [1.0, 0.0, 0.0]),
    ("y", [0.0, 1.0, 0.0]),
    ("oblique", [-0.6, 0.8, 0.0]),
];

fn cone(boresight: &str, direction: [f64; 3], half_angle_deg: f64, applies: Applies) -> ConeSpec {
    ConeSpec {
        boresight: boresight.to_owned(),
        direction: DirectionSpec::Vector(direction),
        half_angle_deg,
        applies,
    }
}

/// Pointings of the published spacecraft, whose axes have names.
fn named(targets: usize) -> ScenarioSpec {
    let mut spec = pointings(experiment_a_spec(), None);
    spec.targets.truncate(targets);
    spec.spacecraft.boresights = AXES
        .map(|(name, axis)| BoresightSpec {
            name: name.to_owned(),
            axis,
        })
        .into();
    spec
}

#[test]
fn cones_choose_the_rolls_at_targets_whenever_they_hold() {
    // Of the rolls at a target the two leave several arcs.
    let cones = |applies| {
        [
            cone("x", [0.2, 1.0, 0.3], 50.0, applies),
            cone("oblique", [0.9, -0.1, 0.4], 55.0, applies),
        ]
    };
    let mut totals = Vec::new();
    for applies in [Applies::Report, Applies::AtTargets, Applies::Always] {
        let mut spec = named(STARS.len());
        spec.keep_out = cones(applies).into();
        spec.targets[1].dwell_s = 20.0;
        let plan = plan_of(&spec);
        assert_sound(&spec, &plan);
        totals.push(plan.total_time_s);
    }
    assert!(
        totals[0] < totals[1] && totals[1] <= totals[2] * (1.0 + 1e-6),
        "{totals:?}"
    );
}

#[test]
fn the_last_few_degrees_of_roll_that_cones_leave_are_found() {
    let mut spec = named(1);
    // Where body y looks at one roll; it turns by a degree or so less than the roll.
    let at_one_roll = scenario_of(&given(&spec, 37.5));
    let y = at_one_roll.targets()[0].attitude.to_reference(Vector3::y());
    spec.keep_in = vec![cone("y", y.into(), 3.5, Applies::AtTargets)];
    let plan = plan_of(&spec);
    assert_sound(&spec, &plan);
    let roll = plan.rolls.passages[0].expect("a pointing");
    assert!((33.0..42.0).contains(&roll), "{roll}");
}
