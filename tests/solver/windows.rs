//! Schedules with windows and values against enumeration over subsets and orders; more cases are in the
//! example `clock_oracle`.

use slewplan_solver::model::plan::{Optimality, Outcome, SkipReason};
use slewplan_solver::model::problem::Code;
use slewplan_solver::model::spec::{AttitudeSpec, ScenarioSpec, TargetSpec, WindowSpec};
use slewplan_tests::experiment_a_spec;
use slewplan_tests::schedules::{Pass, RateConditions, pass};
use slewplan_tests::solving::outcome_of;
use slewplan_tests::windows::{Rates, best_by_enumeration, random_windows, standing};

#[test]
fn schedules_at_rest_are_those_of_enumeration() {
    let mut planned = 0;
    for (seed, targets) in (0..20).zip((4..8).cycle()) {
        planned += usize::from(agrees(seed, targets, Rates::Rest));
    }
    assert!(planned > 10, "{planned}");
}

#[test]
fn schedules_with_free_rates_are_those_of_enumeration() {
    let mut planned = 0;
    for seed in 100..104 {
        planned += usize::from(agrees(seed, 4, Rates::Any));
    }
    assert!(planned > 1, "{planned}");
}

#[test]
fn beginnings_that_end_too_late_do_not_leave_a_pass_without_proof() {
    // Most of the beginnings of this pass arrive at some target after its window.
    let spec = pass(Pass {
        rates: RateConditions::ZeroAboutZ,
        targets: 12,
        duration_s: 600.0,
        seed: 3,
    });
    let Outcome::Planned(plan) = outcome_of(&spec) else {
        panic!("no plan");
    };
    assert_eq!(plan.optimality, Optimality::Optimal);
    assert!(plan.lower_bound_s <= plan.total_time_s && plan.verification.passed);
}

/// Whether there is a schedule; it is compared with enumeration.
fn agrees(seed: u64, targets: usize, rates: Rates) -> bool {
    let spec = random_windows(seed, targets, rates);
    let expected = best_by_enumeration(&spec, rates);
    match (outcome_of(&spec), expected) {
        (Outcome::Planned(plan), Some((value, time_s))) => {
            let (got, got_s) = standing(&plan);
            assert_eq!(got.to_bits(), value.to_bits(), "seed {seed}");
            assert!(
                (got_s - time_s).abs() <= 1e-6 * time_s,
                "seed {seed}: {got_s} {time_s}"
            );
            assert_eq!(plan.optimality, Optimality::Optimal, "seed {seed}");
            true
        }
        (Outcome::Infeasible(_), None) => false,
        (other, expected) => panic!("seed {seed}: {other:?} {expected:?}"),
    }
}

fn at(id: &str, yaw: f64, windows: &[[f64; 2]]) -> TargetSpec {
    let windows = windows.iter().map(|[from, to]| WindowSpec {
        from_s: Some(*from),
        to_s: Some(*to),
        ..WindowSpec::default()
    });
    TargetSpec {
        id: id.into(),
        attitude: AttitudeSpec::RollPitchYawDeg([0.0, 0.0, yaw]),
        windows: Some(windows.collect()),
        ..TargetSpec::default()
    }
}

fn scenario(targets: Vec<TargetSpec>) -> ScenarioSpec {
    ScenarioSpec {
        end: None,
        targets,
        ..experiment_a_spec()
    }
}

#[test]
fn required_targets_that_exclude_each_other_are_named() {
    let spec = scenario(vec![
        at("free", 5.0, &[[0.0, 900.0]]),
        at("left", -60.0, &[[100.0, 101.0]]),
        at("right", 60.0, &[[102.0, 103.0]]),
    ]);
    let Outcome::Infeasible(problems) = outcome_of(&spec) else {
        panic!("there is no schedule");
    };
    assert_eq!(problems[0].code, Code::WindowsConflict);
    let message = &problems[0].message;
    assert!(
        message.contains("left") && message.contains("right"),
        "{message}"
    );
    assert!(!message.contains("free"), "{message}");
}

#[test]
fn a_required_target_out_of_reach_is_named() {
    let spec = scenario(vec![
        at("far", 170.0, &[[0.0, 2.0]]),
        at("near", 5.0, &[[0.0, 99.0]]),
    ]);
    let Outcome::Infeasible(problems) = outcome_of(&spec) else {
        panic!("there is no schedule");
    };
    assert_eq!(problems.len(), 1);
    assert_eq!(problems[0].code, Code::WindowUnreachable);
    assert_eq!(problems[0].pointer, "/targets/0/windows");
}

#[test]
fn a_start_that_moves_does_not_wait() {
    let mut spec = scenario(vec![at("late", 50.0, &[[140.0, 200.0]])]);
    spec.targets[0].zero_rate_axes = Some([false, false, true]);
    spec.targets.push(TargetSpec {
        windows: None,
        ..at("any time", 10.0, &[])
    });
    for rate in [0.002, 0.004, -0.003] {
        spec.start.body_rate_rad_s = Some([rate, 0.001, -0.002]);
        let Outcome::Planned(plan) = outcome_of(&spec) else {
            panic!("there is a schedule");
        };
        let schedule = plan.schedule.expect("a schedule");
        assert!(schedule.waits.iter().all(|wait| wait.target != "start"));
    }
}

#[test]
fn what_is_left_out_has_its_reason() {
    let valued = |target, value| TargetSpec {
        value: Some(value),
        ..target
    };
    let mut spec = scenario(vec![
        valued(at("never", 20.0, &[]), 9.0),
        valued(at("past", 170.0, &[[0.0, 2.0]]), 9.0),
        valued(at("late", 20.0, &[[250.0, 300.0]]), 9.0),
        valued(at("cheap", -60.0, &[[100.0, 101.0]]), 1.0),
        valued(at("dear", 60.0, &[[101.0, 102.0]]), 2.0),
    ]);
    spec.latest_end_s = Some(200.0);
    let Outcome::Planned(plan) = outcome_of(&spec) else {
        panic!("there is a schedule");
    };
    let schedule = plan.schedule.expect("a schedule");
    let reasons: Vec<_> = schedule
        .skipped
        .iter()
        .map(|s| (&*s.target, s.reason))
        .collect();
    assert_eq!(
        reasons,
        [
            ("never", SkipReason::WindowUnreachable),
            ("past", SkipReason::WindowUnreachable),
            ("late", SkipReason::TimeIsUp),
            ("cheap", SkipReason::ValueTooSmall),
        ]
    );
    let is = |number: f64, wanted: f64| (number - wanted).abs() < 1e-9;
    assert!(is(schedule.value, 2.0) && is(schedule.value_bound, 2.0));
    let cost = schedule.skipped[3].inclusion.expect("looked at");
    assert!(is(cost.value_change, -1.0));
    // It arrives early and waits.
    assert_eq!(schedule.waits.len(), 1);
    assert!(is(schedule.waits[0].to_s, 101.0));
    assert!(is(plan.flight.passages[0].time_s, 101.0));
}

#[test]
fn more_targets_than_programs_carry_are_refused_with_a_window() {
    let mut spec = pass(Pass {
        rates: RateConditions::ZeroAboutZ,
        targets: 61,
        duration_s: 600.0,
        seed: 1,
    });
    spec.options.time_limit_s = Some(30.0);
    let Outcome::Failed(problems) = outcome_of(&spec) else {
        panic!("it is not planned");
    };
    let codes: Vec<_> = problems.iter().map(|problem| problem.code).collect();
    assert_eq!(codes, [Code::ClockNotPlanned]);
}
