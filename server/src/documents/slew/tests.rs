//! What is read of a slew, and what is refused.

use super::*;
use slewplan_solver::slew::{DEFAULT_INTERVALS, TorqueCommand};

const CRAFT: &str = r#""spacecraft": {"inertia_kg_m2": [[6.63, 0, 0], [0, 8.9, 0], [0, 0, 9.63]],
    "wheels": [
        {"axis": [1, 0, 0], "inertia_kg_m2": 0.000169, "max_torque_nm": 0.0101},
        {"axis": [0, 1, 0], "inertia_kg_m2": 0.000169, "max_torque_nm": 0.0101},
        {"axis": [0, 0, 1], "inertia_kg_m2": 0.000169, "max_torque_nm": 0.0101}]},
    "start": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 0]}},
    "end": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 90]}}"#;

fn reading(rest: &str) -> Result<SlewRequest, Vec<(String, Code)>> {
    let text = format!("{{{CRAFT}{rest}}}");
    let places = |problems: Vec<Problem>| {
        let places = problems.into_iter().map(|p| (p.pointer, p.code));
        places.collect()
    };
    read(text.as_bytes()).map_err(places)
}

#[test]
fn what_is_left_out_has_its_usual_value() {
    let request = reading("").unwrap();
    assert_eq!(request.slew.objective(), Objective::MinimumTime);
    let free = TorqueCommand::Free {
        intervals: DEFAULT_INTERVALS,
    };
    assert_eq!(request.slew.command(), free);
    assert_eq!(request.time_limit_s, Some(60.0));
    assert!(!request.evidence && request.sweep.is_none());
    let without = reading(r#", "options": {"time_limit_s": null}"#).unwrap();
    assert_eq!(without.time_limit_s, None);
}

#[test]
fn a_sweep_brings_the_value_of_the_objective() {
    let rest = r#", "objective": {"kind": "time_and_effort"}, "sweep": {"weights": [0.1, 1]}"#;
    let request = reading(rest).unwrap();
    let first = Objective::TimeAndEffort { weight: 0.1 };
    assert_eq!(request.slew.objective(), first);
    assert_eq!(request.sweep, Some(Sweep::Weights(vec![0.1, 1.0])));
}

#[test]
fn every_problem_has_its_place() {
    let rest = r#", "objective": {"kind": "minimum_time", "weight": 1},
        "command": {"kind": "sampled", "hold": "cubic"}, "sweep": {"weights": [], "durations_s": [1]},
        "drives": [{"motor": {"resistance_ohm": "1"}}], "colour": 1"#;
    let found = reading(rest).unwrap_err();
    for expected in [
        ("/colour", Code::UnknownField),
        ("/objective/weight", Code::UnknownField),
        ("/command/period_s", Code::MissingField),
        ("/command/hold", Code::UnknownChoice),
        ("/sweep", Code::ConflictingFields),
        ("/drives/0/motor/resistance_ohm", Code::WrongType),
        ("/drives/0/motor/torque_constant_nm_a", Code::MissingField),
    ] {
        let expected = (expected.0.to_owned(), expected.1);
        assert!(found.contains(&expected), "{expected:?} in {found:?}");
    }
}

#[test]
fn evidence_is_for_a_single_slew() {
    let rest = r#", "objective": {"kind": "time_and_effort"}, "sweep": {"weights": [1]},
        "evidence": true"#;
    let found = reading(rest).unwrap_err();
    assert_eq!(found, [("/evidence".to_owned(), Code::ConflictingFields)]);
}
