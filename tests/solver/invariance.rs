//! Changes of a description that must not change the plan.

use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::{Flight, Plan};
use slewplan_solver::model::spec::{
    AttitudeSpec, BoresightChoice, PointingSpec, ScenarioSpec, StateSpec, WheelSpec,
};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::{self, Slew, SlewSpec};
use slewplan_solver::tour::legs::LegKind;
use slewplan_solver::tour::planner::{self, Shard};
use slewplan_tests::published_targets_spec;
use slewplan_tests::solving::{agree, on_threads, order_of, plan_of, planned, scenario_of};

/// Three published targets with stored momentum, a full inertia and no end.
fn lopsided_spec() -> ScenarioSpec {
    let mut spec = published_targets_spec(&["a", "d", "h"]);
    spec.spacecraft.inertia_kg_m2 = [[6.63, 0.4, -0.2], [0.4, 8.90, 0.3], [-0.2, 0.3, 9.63]];
    spec.start.wheel_speed_rad_s = Some(vec![60.0, -90.0, 40.0]);
    spec
}

fn quaternion_of(attitude: &Attitude) -> AttitudeSpec {
    AttitudeSpec::Quaternion(attitude.xyzw())
}

/// A plan without its statistics.
fn answer(plan: &Plan) -> impl PartialEq + std::fmt::Debug {
    let flight: Flight = plan.flight.clone();
    let figures = [plan.total_time_s, plan.lower_bound_s, plan.relative_gap];
    (
        flight,
        figures,
        plan.optimality,
        plan.alternatives.clone(),
        plan.legs.clone(),
        plan.states.clone(),
        plan.verification.clone(),
    )
}

#[test]
fn the_sign_of_a_quaternion_does_not_change_a_plan() {
    let spec = lopsided_spec();
    let mut negated = spec.clone();
    let targets = scenario_of(&spec).targets().to_vec();
    for (spec, target) in negated.targets.iter_mut().zip(&targets) {
        spec.attitude = quaternion_of(&target.attitude.negated());
    }
    let (plan, other) = (plan_of(&spec), plan_of(&negated));
    assert_eq!(order_of(&plan), order_of(&other));
    assert!(agree(plan.total_time_s, other.total_time_s, 1e-9));
    assert_eq!(plan.flight.controls.len(), other.flight.controls.len());
    for (a, b) in plan.flight.controls.iter().zip(&other.flight.controls) {
        for (a, b) in a.wheel_torque_nm.iter().zip(&b.wheel_torque_nm) {
            assert!((a - b).abs() < 1e-9, "{a} and {b} N m");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit_of_the_plan() {
    let scenario = scenario_of(&published_targets_spec(&["a", "b", "e", "h"]));
    let [one, two, three] =
        [1, 2, 3].map(|count| planned(on_threads(count, |run| planner::solve(&scenario, run))));
    assert_eq!(answer(&one), answer(&two));
    assert_eq!(answer(&one), answer(&three));
}

#[test]
fn the_order_of_the_list_of_targets_does_not_change_the_duration() {
    let spec = lopsided_spec();
    let mut turned = spec.clone();
    turned.targets.rotate_left(1);
    let mut reversed = spec.clone();
    reversed.targets.reverse();
    let plan = plan_of(&spec);
    for other in [turned, reversed].iter().map(plan_of) {
        assert!(agree(plan.total_time_s, other.total_time_s, 1e-6));
        assert_eq!(order_of(&plan), order_of(&other));
    }
}

/// The same spacecraft with its body axes turned by 90 degrees about z: a vector with components
/// (x, y, z) now has (-y, x, z).
fn relabelled(spec: &ScenarioSpec) -> ScenarioSpec {
    let scenario = scenario_of(spec);
    let back = Attitude::from_rotation_vector([0.0, 0.0, -90.0_f64.to_radians()].into());
    let turn = |attitude: &Attitude| quaternion_of(&attitude.then_in_body(&back));
    let mut spec = spec.clone();
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = spec.spacecraft.inertia_kg_m2;
    spec.spacecraft.inertia_kg_m2 = [[yy, -xy, -yz], [-xy, xx, xz], [-yz, xz, zz]];
    spec.spacecraft.max_body_rate_rad_s.swap(0, 1);
    for wheel in &mut spec.spacecraft.wheels {
        let [x, y, z] = wheel.axis;
        wheel.axis = [-y, x, z];
    }
    spec.start.attitude = turn(&scenario.start().attitude);
    for (spec, target) in spec.targets.iter_mut().zip(scenario.targets()) {
        spec.attitude = turn(&target.attitude);
        if let Some(axes) = &mut spec.zero_rate_axes {
            axes.swap(0, 1);
        }
    }
    spec
}

#[test]
fn relabelled_body_axes_do_not_change_the_duration() {
    let mut spec = lopsided_spec();
    spec.spacecraft.max_body_rate_rad_s = [Some(0.03), Some(0.04), None];
    spec.targets[0].zero_rate_axes = Some([true, false, true]);
    let (plan, other) = (plan_of(&spec), plan_of(&relabelled(&spec)));
    let (a, b) = (plan.total_time_s, other.total_time_s);
    assert!(agree(a, b, 1e-4), "{a} and {b} s");
    assert_eq!(order_of(&plan), order_of(&other));
}

/// Two pointed targets and an end, all with free roll, seen from a reference frame that is turned.
fn pointed(frame: &Attitude) -> ScenarioSpec {
    let mut spec = published_targets_spec(&["a", "d"]);
    spec.start.attitude = quaternion_of(&frame.then_in_body(&Attitude::identity()));
    let pointing = |direction: [f64; 3]| PointingSpec {
        boresight: BoresightChoice::Axis([0.3, 0.0, 1.0]),
        direction: Some(<[f64; 3]>::from(frame.to_reference(direction.into())).into()),
        ..PointingSpec::default()
    };
    spec.targets[0].pointing = Some(pointing([0.2, 0.3, 0.9]));
    spec.targets[1].pointing = Some(pointing([-0.4, 0.1, 0.8]));
    spec.end = Some(StateSpec {
        pointing: Some(pointing([0.1, -0.3, 0.7])),
        ..StateSpec::default()
    });
    spec
}

#[test]
fn the_reference_frame_does_not_change_a_plan_of_free_rolls() {
    let turned = Attitude::from_rotation_vector([1.2, -0.7, 2.1].into());
    let (plan, other) = (
        plan_of(&pointed(&Attitude::identity())),
        plan_of(&pointed(&turned)),
    );
    let (a, b) = (plan.total_time_s, other.total_time_s);
    assert!(agree(a, b, 1e-4), "{a} and {b} s");
    assert_eq!(order_of(&plan), order_of(&other));
}

#[test]
fn a_leg_with_a_spinning_locked_wheel_has_different_durations_in_both_directions() {
    // The enabled x wheel holds the opposite of the locked one's momentum, so that the total is zero; in
    // one direction a tenth of its speed range is left.
    let mut spec = published_targets_spec(&["a", "b"]);
    let locked = WheelSpec {
        enabled: false,
        ..spec.spacecraft.wheels[0].clone()
    };
    spec.spacecraft.wheels.push(locked);
    spec.start.wheel_speed_rad_s = Some(vec![640.0, 0.0, 0.0, -640.0]);
    let attitudes = [[10.0, 0.0, 0.0], [130.0, 5.0, 0.0]].map(AttitudeSpec::RollPitchYawDeg);
    for (target, attitude) in spec.targets.iter_mut().zip(&attitudes) {
        target.attitude = attitude.clone();
        target.zero_rate_axes = None;
    }
    spec.end = None;
    let [forth, back] = [["a", "b"], ["b", "a"]].map(|[from, to]| {
        let (scenario, all) = (scenario_of(&spec), Shard { index: 0, of: 1 });
        let kind = LegKind::RestToRest;
        let (rows, _) = on_threads(1, |run| planner::leg_table(&scenario, kind, all, run));
        let row = rows.iter().find(|row| row.from == from && row.to == to);
        row.and_then(|row| row.duration_s).expect("a leg")
    });
    // By the solver of single slews, which has no canonical legs.
    let [slew_forth, slew_back] = [[0, 1], [1, 0]].map(|[from, to]| {
        let state = |attitude: &AttitudeSpec| StateSpec {
            attitude: attitude.clone(),
            ..spec.start.clone()
        };
        let slew = SlewSpec {
            spacecraft: spec.spacecraft.clone(),
            start: state(&attitudes[from]),
            end: state(&attitudes[to]),
            ..SlewSpec::default()
        };
        let slew = Slew::try_new(&slew).expect("valid").slew;
        let outcome = slew::solve(&slew, &StopSignal::new());
        assert!(outcome.solved, "{:?}", outcome.propagated.failures);
        outcome.time_s
    });
    assert!(agree(forth, slew_forth, 1e-3), "{forth} {slew_forth}");
    assert!(agree(back, slew_back, 1e-3), "{back} {slew_back}");
    let ratio = (forth / back).max(back / forth);
    assert!(ratio > 1.3, "{forth} forth and {back} back");
}
