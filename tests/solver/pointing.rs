//! Tours through directions whose roll is left to the plan.

use slewplan_solver::model::plan::Plan;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::model::spec::{
    AttitudeSpec, BoresightChoice, PointingSpec, ScenarioSpec, TargetSpec,
};
use slewplan_tests::solving::{on_threads, order_of, plan_of, planned, scenario_of};
use slewplan_tests::{experiment_a_spec, pyramid_spec};

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
    spec.targets = STARS
        .iter()
        .enumerate()
        .map(|(i, ra_dec_deg)| TargetSpec {
            id: format!("s{i}"),
            pointing: Some(PointingSpec {
                boresight: BoresightChoice::Axis(CAMERA),
                direction: None,
                ra_dec_deg: Some(*ra_dec_deg),
                roll_min_deg: roll_deg.map(|[least, _]| least),
                roll_max_deg: roll_deg.map(|[_, greatest]| greatest),
            }),
            ..TargetSpec::default()
        })
        .collect();
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
