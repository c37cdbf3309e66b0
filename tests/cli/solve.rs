//! `slewplan solve`.

use crate::run::{fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::Value;

/// Asserts that a value is a list of finite numbers of this length.
fn assert_vector(value: &Value, length: usize) {
    let items = value.as_array().expect("a list");
    assert_eq!(items.len(), length);
    assert!(items.iter().all(Value::is_number), "{value}");
}

fn assert_verified(plan: &Value) {
    let found = &plan["verification"];
    let number = |name: &str| found[name].as_f64().expect("a number");
    assert_eq!(found["passed"], true, "{found}");
    assert!(number("max_attitude_error_rad") <= 1e-6, "{found}");
    assert!(number("max_rate_error_rad_s") <= 1e-7, "{found}");
    for excess in [
        "max_wheel_speed_excess",
        "max_torque_excess",
        "max_rate_excess",
    ] {
        assert!(number(excess) <= 1e-6, "{found}");
    }
}

#[test]
fn two_targets_are_solved_to_optimality_with_a_complete_document() {
    let plan = slewplan(&["solve", &fixture("two-targets.json")])
        .expect_code(0)
        .json();
    assert_eq!(plan["status"], "optimal");
    assert_verified(&plan);
    let total = plan["total_time_s"].as_f64().expect("a number");
    assert!(plan["lower_bound_s"].as_f64().expect("a number") <= total + 1e-9);
    let certified = plan["certified_lower_bound_s"].as_f64().expect("a number");
    assert!(certified > 0.8 * total && certified <= total);
    for leg in plan["legs"].as_array().expect("a list") {
        let number = |name: &str| leg[name].as_f64().expect("a number");
        let least = number("certified_lower_bound_s");
        let rest = number("rest_to_rest_duration_s");
        assert!(
            rest > 0.0 && rest <= number("eigenaxis_duration_s") * (1.0 + 1e-6),
            "{leg}"
        );
        assert!(
            least > 0.0 && least <= number("duration_s") * (1.0 + 1e-6),
            "{leg}"
        );
    }
    let work = &plan["statistics"];
    let by_kind = &work["nlp_solves_by_kind"];
    let count = |value: &Value| value.as_u64().expect("a count");
    assert_eq!(
        count(&work["nlp_solves"]),
        count(&by_kind["legs"]) + count(&by_kind["segments"])
    );
    let history = work["history"].as_array().expect("a list");
    let last = history.last().expect("the plan itself");
    assert_eq!(last["total_time_s"], plan["total_time_s"]);
    assert_eq!(last["lower_bound_s"], plan["lower_bound_s"]);
    assert_eq!(plan["sequence"].as_array().expect("a list").len(), 2);
    assert_eq!(plan["legs"].as_array().expect("a list").len(), 3);
    assert_eq!(plan["reasons"], serde_json::json!([]));
    for passage in plan["passages"].as_array().expect("a list") {
        assert_vector(&passage["body_rate_rad_s"], 3);
        assert_vector(&passage["wheel_speed_rad_s"], 3);
        assert!(passage["attitude"]["quaternion"]["w"].is_number());
        let stay = if passage["target"] == "b" { 3.0 } else { 0.0 };
        let time = |name: &str| passage[name].as_f64().expect("a number");
        assert!(
            (time("departure_s") - time("time_s") - stay).abs() < 1e-9,
            "{passage}"
        );
    }
}

#[test]
fn intervals_tile_the_plan_and_states_hold_every_boundary() {
    let plan = slewplan(&["solve", &fixture("two-targets.json")])
        .expect_code(0)
        .json();
    let total = plan["total_time_s"].as_f64().expect("a number");
    let times: Vec<f64> = plan["trajectory"]["states"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|state| state["time_s"].as_f64().expect("a number"))
        .collect();
    let mut end = 0.0;
    for control in plan["trajectory"]["controls"].as_array().expect("a list") {
        let start = control["start_s"].as_f64().expect("a number");
        assert!((start - end).abs() < 1e-9, "gap at {start} s");
        assert!(
            times.iter().any(|time| (time - start).abs() < 1e-9),
            "no state at {start} s"
        );
        assert_vector(&control["wheel_torque_nm"], 3);
        end = start + control["duration_s"].as_f64().expect("a number");
    }
    assert!((total - end).abs() < 1e-9);
    assert!(times.iter().any(|time| (time - total).abs() < 1e-9));
}

#[test]
fn redundant_failed_and_biased_wheels_are_solved_and_verified() {
    for name in [
        "pyramid.json",
        "pyramid-one-disabled.json",
        "pyramid-momentum-bias.json",
    ] {
        let plan = slewplan(&["solve", &fixture(name)]).expect_code(0).json();
        assert_verified(&plan);
        for control in plan["trajectory"]["controls"].as_array().expect("a list") {
            assert_vector(&control["wheel_torque_nm"], 4);
            if name == "pyramid-one-disabled.json" {
                assert_eq!(control["wheel_torque_nm"][3].as_f64(), Some(0.0));
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_only_the_statistics() {
    let plan_with = |threads: &str| {
        let path = fixture("two-targets.json");
        let mut plan = slewplan(&["solve", &path, "--threads", threads])
            .expect_code(0)
            .json();
        plan["statistics"] = Value::Null;
        plan
    };
    assert_eq!(plan_with("1"), plan_with("3"));
}

#[test]
fn a_scenario_is_read_from_standard_input() {
    let text = fixture_json("two-targets.json").to_string();
    let plan = slewplan_fed(&["solve", "-", "-o", "-"], text.as_bytes())
        .expect_code(0)
        .json();
    assert_eq!(plan["status"], "optimal");
}

#[test]
fn csv_has_units_in_its_header_and_a_row_for_every_switch() {
    let path = fixture("two-targets.json");
    let table = slewplan(&["solve", &path, "--format", "csv"])
        .expect_code(0)
        .stdout;
    let plan = slewplan(&["solve", &path]).json();
    let times: Vec<&str> = table
        .lines()
        .skip(1)
        .filter_map(|line| line.split(',').next())
        .collect();
    for control in plan["trajectory"]["controls"].as_array().expect("a list") {
        let start = format!("{:?}", control["start_s"].as_f64().expect("a number"));
        assert!(times.contains(&start.as_str()), "{start}");
    }
    let head = table.lines().next().expect("a head");
    for column in [
        "time_s",
        "q_w",
        "body_rate_x_rad_s",
        "wheel_2_speed_rad_s",
        "wheel_0_torque_nm",
    ] {
        assert!(
            head.split(',').any(|name| name == column),
            "{column} is not in {head}"
        );
    }
    for line in table.lines().skip(1) {
        let values: Vec<f64> = line
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        assert_eq!(values.len(), head.split(',').count());
        assert!(values.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn the_summary_has_its_lines() {
    let path = fixture("two-targets.json");
    let text = slewplan(&["solve", &path, "--summary"])
        .expect_code(0)
        .stdout;
    for part in [
        "two-targets: optimal, ",
        "start > ",
        "lower bound",
        "eigenaxis",
        "verification  passed",
        "margins",
        "work",
    ] {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
}

#[test]
fn progress_is_written_as_json_lines_on_standard_error() {
    let path = fixture("two-targets.json");
    let ended = slewplan(&["solve", &path, "--progress", "json"]).expect_code(0);
    let lines: Vec<Value> = ended
        .stderr
        .lines()
        .map(|line| serde_json::from_str(line).expect("one object per line"))
        .collect();
    assert!(!lines.is_empty());
    for line in &lines {
        for field in [
            "stage",
            "done",
            "total",
            "incumbent_s",
            "lower_bound_s",
            "relative_gap",
        ] {
            assert!(line.get(field).is_some(), "{field} is not in {line}");
        }
        assert!(line["elapsed_s"].is_number());
    }
    let silent = slewplan(&["solve", &path, "--progress", "none"]).expect_code(0);
    assert_eq!(silent.stderr, "");
}
