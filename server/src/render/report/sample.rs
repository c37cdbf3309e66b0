//! A small invented plan for the tests of reports and pictures.

use nalgebra::Vector3;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::plan::{
    Alternative, Control, Flight, InclusionCost, Leg, LowerBoundKind, Margins, Milestone,
    NlpSolves, Objective, Optimality, Passage, Plan, Rolls, Schedule, SearchWork, SkipReason,
    SkippedTarget, State, Statistics, Verification, Wait,
};

/// What the plan would say of a scenario with values, in which it leaves two targets out.
pub(crate) fn schedule() -> Schedule {
    let skipped = |target: &str, reason, inclusion| SkippedTarget {
        target: target.into(),
        reason,
        inclusion,
    };
    let cost = InclusionCost {
        value_change: -1.5,
        time_change_s: 2.0,
    };
    Schedule {
        objective: Objective::ValueThenTime,
        value: 3.0,
        value_bound: 4.5,
        skipped: vec![
            skipped("c", SkipReason::ValueTooSmall, Some(cost)),
            skipped("d", SkipReason::NotTried, None),
        ],
        waits: vec![Wait {
            target: "a".into(),
            from_s: 10.0,
            to_s: 12.0,
        }],
    }
}

/// Two targets, 30 s, three wheels; `b` has 5 s of dwell.
pub(crate) fn plan() -> Plan {
    Plan {
        optimality: Optimality::Optimal,
        total_time_s: 30.0,
        lower_bound_s: 30.0,
        relative_gap: 0.0,
        lower_bound_kind: LowerBoundKind::NlpRelaxation,
        certified_lower_bound_s: Some(29.5),
        alternatives: vec![Alternative {
            sequence: vec!["b".into(), "a".into()],
            total_time_s: 31.0,
        }],
        legs: vec![
            leg("start", "a", 0.0, 10.0),
            leg("a", "b", 10.0, 10.0),
            leg("b", "end", 25.0, 5.0),
        ],
        flight: flight(),
        rolls: Rolls {
            passages: vec![None, Some(-12.5)],
            end: None,
        },
        schedule: None,
        states: [(0.0, 0.0), (10.0, 0.5), (20.0, 0.25), (30.0, 0.0)]
            .map(state)
            .into(),
        margins: Margins {
            torque: 0.0,
            body_rate: Some(0.3),
            ..Margins::default()
        },
        verification: verification(),
        statistics: Statistics {
            threads: 2,
            nlp_solves: 7,
            nlp_solves_by_kind: NlpSolves {
                legs: 4,
                segments: 3,
            },
            search: SearchWork {
                pruned_by_table: 5,
                dropped_for_memory: 1,
                ..SearchWork::default()
            },
            history: vec![milestone(0.5, 31.0, 28.0), milestone(2.0, 30.0, 30.0)],
            ..Statistics::default()
        },
        warnings: Vec::new(),
    }
}

fn milestone(time_s: f64, total_time_s: f64, lower_bound_s: f64) -> Milestone {
    Milestone {
        time_s,
        total_time_s,
        lower_bound_s,
    }
}

fn flight() -> Flight {
    let passage = |target: &str, time_s, departure_s| Passage {
        target: target.into(),
        time_s,
        departure_s,
    };
    let control = |start_s, torque| Control {
        start_s,
        duration_s: 10.0,
        wheel_torque_nm: vec![torque, 0.0, 0.0],
    };
    Flight {
        total_time_s: 30.0,
        passages: vec![passage("a", 10.0, 10.0), passage("b", 20.0, 25.0)],
        controls: vec![control(0.0, 0.5), control(10.0, -0.5), control(20.0, 0.25)],
    }
}

fn leg(from: &str, to: &str, start_s: f64, duration_s: f64) -> Leg {
    Leg {
        from: from.into(),
        to: to.into(),
        start_s,
        duration_s,
        certified_lower_bound_s: Some(duration_s),
        eigenaxis_duration_s: Some(12.0),
        rest_to_rest_duration_s: Some(11.0),
        solver_status: "converged".into(),
    }
}

fn state((time_s, rate): (f64, f64)) -> State {
    State {
        time_s,
        attitude: Attitude::identity(),
        body_rate_rad_s: Vector3::new(rate, 0.0, 0.0),
        wheel_speed_rad_s: vec![1.0, 2.0, 3.0],
    }
}

fn verification() -> Verification {
    Verification {
        passed: true,
        max_attitude_error_rad: 1e-9,
        max_rate_error_rad_s: 1e-10,
        max_wheel_speed_excess: 0.0,
        max_torque_excess: 0.0,
        max_rate_excess: 0.0,
        integrator: "none".into(),
        failures: Vec::new(),
    }
}
