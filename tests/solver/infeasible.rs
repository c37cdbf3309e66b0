//! Infeasible scenarios, and the limits of feasible ones.

use slewplan_solver::model::plan::{Optimality, Outcome, Plan};
use slewplan_solver::model::problem::Code;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, StateSpec, TargetSpec};
use slewplan_tests::solving::{agree, outcome_of, plan_of};
use slewplan_tests::{experiment_a_spec, target};

/// The published spacecraft with these targets and no end.
fn visits(targets: impl IntoIterator<Item = TargetSpec>) -> ScenarioSpec {
    ScenarioSpec {
        targets: targets.into_iter().collect(),
        end: None,
        ..experiment_a_spec()
    }
}

/// A target at which only the z rate vanishes.
fn passing(id: &str, angles: [f64; 3]) -> TargetSpec {
    TargetSpec {
        zero_rate_axes: Some([false, false, true]),
        ..target(id, angles)
    }
}

fn optimal(spec: &ScenarioSpec) -> Plan {
    let plan = plan_of(spec);
    assert_eq!(plan.optimality, Optimality::Optimal);
    plan
}

/// Time, s, of the fastest turn about z alone by an angle in rad: full torque up to the rate that
/// the wheel's speed limit allows, and the same backwards.
fn turn_about_z(angle: f64) -> f64 {
    let (inertia, wheel): (f64, f64) = (9.63, 0.000_169);
    // The total momentum is zero: at the rate w the wheel has the speed J w / I relative to the body, and
    // its torque accelerates the inertia without its own.
    let acceleration = 0.0101 / (inertia - wheel);
    let fastest = (wheel * 710.0 / inertia).min(0.04);
    if angle < fastest * fastest / acceleration {
        2.0 * (angle / acceleration).sqrt()
    } else {
        angle / fastest + fastest / acceleration
    }
}

#[test]
fn a_target_whose_momentum_the_wheels_cannot_hold_is_reported() {
    let mut spec = visits([
        target("held", [10.0, 0.0, 0.0]),
        target("lost", [0.0, 0.0, 45.0]),
    ]);
    // Shared by two wheels at the start, all on one of them after a yaw of 45 degrees.
    spec.start.wheel_speed_rad_s = Some(vec![600.0, 600.0, 0.0]);
    let outcome = outcome_of(&spec);
    let Outcome::Infeasible(problems) = outcome else {
        panic!("{outcome:?}");
    };
    let named: Vec<_> = problems
        .iter()
        .map(|p| (p.code, p.pointer.as_str()))
        .collect();
    assert_eq!(named, [(Code::MomentumExceedsEnvelope, "/targets/1")]);
}

#[test]
fn two_targets_at_the_same_rest_take_no_longer_than_one() {
    let (a, again) = ([15.0, 0.0, 10.0], "again");
    let b = target("b", [25.0, 0.0, 50.0]);
    let once = optimal(&visits([target("a", a), b.clone()]));
    let twice = optimal(&visits([target("a", a), b, target(again, a)]));
    let (once, twice) = (once.total_time_s, twice.total_time_s);
    assert!(agree(once, twice, 1e-6), "{once} and {twice} s");
}

#[test]
fn two_targets_at_the_same_passage_take_no_longer_than_one() {
    let (a, again) = ([15.0, 0.0, 10.0], "again");
    let b = passing("b", [25.0, 0.0, 50.0]);
    let once = optimal(&visits([passing("a", a), b.clone()]));
    let twice = optimal(&visits([passing("a", a), b, passing(again, a)]));
    let (once, twice) = (once.total_time_s, twice.total_time_s);
    assert!(agree(once, twice, 1e-6), "{once} and {twice} s");
}

#[test]
fn a_target_at_the_start_takes_no_time() {
    let b = target("b", [25.0, 0.0, 50.0]);
    let here = target("here", [0.0; 3]);
    let direct = optimal(&visits([b.clone()]));
    let both = optimal(&visits([b, here.clone()]));
    let alone = optimal(&visits([here]));
    assert!(agree(direct.total_time_s, both.total_time_s, 1e-6));
    assert!(alone.total_time_s < 1e-6);
}

#[test]
fn a_single_target_needs_no_end() {
    let plan = optimal(&visits([target("only", [0.0, 0.0, 30.0])]));
    assert_eq!(plan.legs.len(), 1);
    assert_eq!(plan.flight.passages.len(), 1);
    assert!(plan.total_time_s <= turn_about_z(30.0_f64.to_radians()) * 1.001);
}

#[test]
fn an_end_needs_no_target() {
    let mut spec = visits([]);
    spec.end = Some(StateSpec {
        attitude: AttitudeSpec::RollPitchYawDeg([15.0, 0.0, 10.0]),
        ..StateSpec::default()
    });
    let plan = optimal(&spec);
    let with_target = optimal(&visits([target("a", [15.0, 0.0, 10.0])]));
    assert!(plan.flight.passages.is_empty());
    assert!(agree(plan.total_time_s, with_target.total_time_s, 1e-6));
}

#[test]
fn a_half_turn_takes_the_same_time_in_either_direction() {
    let half = |z: f64| TargetSpec {
        attitude: AttitudeSpec::Quaternion([0.0, 0.0, z, 0.0]),
        ..target("half", [0.0; 3])
    };
    let [one, other] = [1.0, -1.0].map(|z| optimal(&visits([half(z)])).total_time_s);
    assert!(agree(one, other, 1e-6), "{one} and {other} s");
    assert!(one <= turn_about_z(std::f64::consts::PI) * 1.001);
}

#[test]
fn a_tiny_turn_takes_its_analytic_time() {
    let angle: f64 = 1e-5;
    let time = optimal(&visits([target("near", [0.0, 0.0, angle.to_degrees()])])).total_time_s;
    // For so small an angle rotation about other axes saves no time.
    assert!(agree(time, turn_about_z(angle), 1e-3), "{time} s");
}

#[test]
fn a_leg_without_a_solution_is_reported_with_its_pointer() {
    // All wheels are at their limits in one direction, so that no turn is possible.
    let mut spec = visits([
        passing("near", [15.0, 0.0, 10.0]),
        passing("far", [25.0, 0.0, 50.0]),
    ]);
    for target in &mut spec.targets {
        target.zero_rate_axes = Some([true, false, false]);
    }
    spec.start.wheel_speed_rad_s = Some(vec![709.9; 3]);
    let outcome = outcome_of(&spec);
    let Outcome::Failed(problems) = outcome else {
        panic!("{outcome:?}");
    };
    assert!(!problems.is_empty());
    for problem in problems {
        assert_eq!(problem.code, Code::SlewNotSolved);
        assert!(problem.pointer.starts_with("/targets"), "{problem:?}");
        assert!(problem.message.contains("iterations"), "{problem:?}");
    }
}

#[test]
fn attitudes_between_targets_that_the_wheels_cannot_hold_are_reported() {
    let mut spec = visits([target("beyond", [90.0, 0.0, 0.0])]);
    spec.start.wheel_speed_rad_s = Some(vec![650.0; 3]);
    // At so low a rate the body carries little of the momentum that two wheels had to share half way.
    spec.spacecraft.max_body_rate_rad_s = [Some(0.002); 3];
    let outcome = outcome_of(&spec);
    let Outcome::Failed(problems) = outcome else {
        panic!("{outcome:?}");
    };
    let [problem] = &problems[..] else {
        panic!("{problems:?}");
    };
    assert_eq!(problem.code, Code::SlewNotSolved);
    assert_eq!(problem.pointer, "/targets/0");
    // One wheel's share is 650 (sin + cos): above 710 from 5.57 to 84.43 degrees; steps are half a degree.
    let told = "the wheels cannot hold the momentum from 6.0 to 84.0 of 90.0 degrees";
    assert!(problem.message.contains(told), "{}", problem.message);
}
