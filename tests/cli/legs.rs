//! `slewplan legs`.

use crate::run::{Ended, belt_of_cones, binary, fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};
use std::collections::BTreeSet;

fn rows(table: &Value) -> BTreeSet<(String, String)> {
    let end = |row: &Value, name: &str| row[name].as_str().expect("a text").to_owned();
    table["legs"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|row| (end(row, "from"), end(row, "to")))
        .collect()
}

fn duration(table: &Value, from: &str, to: &str) -> f64 {
    table["legs"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|row| row["from"] == from && row["to"] == to)
        .and_then(|row| row["duration_s"].as_f64())
        .expect("a solved leg")
}

#[test]
fn the_leg_between_the_first_two_published_targets_has_its_known_time() {
    let table = slewplan(&["legs", &fixture("two-targets.json")])
        .expect_code(0)
        .json();
    assert_eq!(table["kind"], "rest_to_rest");
    assert_eq!(table["complete"], true);
    let names = rows(&table);
    for (from, to) in [
        ("start", "a"),
        ("start", "b"),
        ("a", "b"),
        ("b", "a"),
        ("a", "end"),
        ("b", "end"),
    ] {
        assert!(
            names.contains(&(from.to_owned(), to.to_owned())),
            "{from} to {to}: {names:?}"
        );
    }
    for (from, to) in [("a", "b"), ("b", "a")] {
        let time = duration(&table, from, to);
        assert!((57.50..=57.60).contains(&time), "{from} to {to}: {time} s");
    }
    for row in table["legs"].as_array().expect("a list") {
        assert!(
            row["solve_time_s"].is_number() && row["status"].is_string(),
            "{row}"
        );
    }
}

#[test]
fn lower_bounds_are_below_the_rest_to_rest_times() {
    let path = fixture("two-targets.json");
    let rest = slewplan(&["legs", &path]).expect_code(0).json();
    let bound = slewplan(&["legs", &path, "--kind", "lower_bound"])
        .expect_code(0)
        .json();
    assert_eq!(bound["kind"], "lower_bound");
    for (from, to) in rows(&rest) {
        let (upper, lower) = (duration(&rest, &from, &to), duration(&bound, &from, &to));
        assert!(
            lower <= upper + 1e-6,
            "{from} to {to}: {lower} above {upper}"
        );
    }
}

#[test]
fn certified_bounds_are_below_the_leg_times() {
    let path = fixture("two-targets.json");
    let rest = slewplan(&["legs", &path]).expect_code(0).json();
    let table = slewplan(&["legs", &path, "--kind", "certified"])
        .expect_code(0)
        .json();
    assert_eq!(table["kind"], "certified");
    assert_eq!(rows(&table), rows(&rest));
    for row in table["legs"].as_array().expect("a list") {
        assert_eq!(row["status"], "proved", "{row}");
        assert!(row["duration_s"].is_null(), "{row}");
        let bound = row["certified_lower_bound_s"].as_f64().expect("a bound");
        let end = |name: &str| row[name].as_str().expect("a text");
        assert!(bound <= duration(&rest, end("from"), end("to")) * (1.0 + 1e-6));
    }
    let bounds = |table: &Value| -> Vec<Value> {
        let legs = table["legs"].as_array().expect("a list").iter();
        legs.map(|row| row["certified_lower_bound_s"].clone())
            .collect()
    };
    assert_eq!(bounds(&rest), bounds(&table));
    // Also with stored momentum, but not without wheel speed limits.
    let biased = slewplan(&[
        "legs",
        &fixture("pyramid-momentum-bias.json"),
        "--kind",
        "certified",
    ]);
    let biased = biased.expect_code(0).json();
    for row in biased["legs"].as_array().expect("a list") {
        // Start and end have the same attitude.
        let moves = row["from"] != "start" || row["to"] != "end";
        let moves = moves && (row["from"] != "end" || row["to"] != "start");
        let bound = row["certified_lower_bound_s"].as_f64();
        assert_eq!(bound > Some(0.0), moves, "{row}");
        assert_eq!(row["status"], "proved");
    }
    let mut unlimited = fixture_json("two-targets.json");
    let wheels = unlimited["spacecraft"]["wheels"].as_array_mut();
    for wheel in wheels.expect("a list") {
        wheel["max_speed_rad_s"] = Value::Null;
    }
    unlimited["spacecraft"]["max_body_rate_rad_s"] = Value::Null;
    let none = slewplan_fed(
        &["legs", "-", "--kind", "certified"],
        unlimited.to_string().as_bytes(),
    )
    .expect_code(0)
    .json();
    assert_eq!(none["legs"][0]["status"], "none");
    assert!(none["legs"][0]["certified_lower_bound_s"].is_null());
}

#[test]
fn all_shards_together_are_the_table() {
    let path = fixture("two-targets.json");
    let whole = rows(&slewplan(&["legs", &path]).expect_code(0).json());
    let first = rows(
        &slewplan(&["legs", &path, "--shard", "1/2"])
            .expect_code(0)
            .json(),
    );
    let second = rows(
        &slewplan(&["legs", &path, "--shard", "2/2"])
            .expect_code(0)
            .json(),
    );
    assert!(first.is_disjoint(&second));
    assert_eq!(
        first.union(&second).cloned().collect::<BTreeSet<_>>(),
        whole
    );
}

/// Two targets, between which a camera passes a bright body; where it applies.
pub(crate) fn past_a_bright_body(applies: &str) -> Value {
    let mut scenario = fixture_json("two-targets.json");
    scenario["spacecraft"]["boresights"][0]["axis"] = json!([1, 0, 0]);
    let attitudes = [[10, 0, 0], [0, 0, 90]];
    for (target, angles) in attitudes.iter().enumerate() {
        scenario["targets"][target]["attitude"] = json!({"roll_pitch_yaw_deg": angles});
    }
    scenario["keep_out"] = json!([{
        "boresight": "camera", "direction": [1, 1, 0.05], "half_angle_deg": 25, "applies": applies,
    }]);
    scenario
}

#[test]
fn a_table_has_the_legs_around_cones() {
    let table = |applies, kind| {
        let scenario = past_a_bright_body(applies).to_string();
        let line = ["legs", "-", "--kind", kind];
        slewplan_fed(&line, scenario.as_bytes())
            .expect_code(0)
            .json()
    };
    for kind in ["rest_to_rest", "lower_bound"] {
        let (around, through) = (table("always", kind), table("report", kind));
        assert_eq!(rows(&around), rows(&through));
        for (from, to) in [("a", "b"), ("b", "a"), ("start", "b")] {
            let (with, without) = (duration(&around, from, to), duration(&through, from, to));
            assert!(with > 1.001 * without, "{from} to {to}: {with} {without}");
        }
        // Clear without doing anything about it.
        let same = |table| duration(table, "start", "a").to_bits();
        assert_eq!(same(&around), same(&through));
    }
}

/// Two targets on both sides of a belt of cones 30 degrees apart.
fn with_a_belt(half_angle_deg: f64) -> Value {
    let mut scenario = fixture_json("two-targets.json");
    scenario["targets"][1]["attitude"] = json!({"roll_pitch_yaw_deg": [180, 0, 0]});
    scenario["keep_out"] = belt_of_cones(half_angle_deg);
    scenario
}

#[test]
fn a_table_says_where_cones_leave_no_way() {
    // Closed, and closed by less than the search resolves.
    for (half_angle_deg, without) in [(20.0, "infeasible"), (15.0005, "no_clear_path")] {
        let scenario = with_a_belt(half_angle_deg).to_string();
        let ended = slewplan_fed(&["legs", "-"], scenario.as_bytes());
        let table = ended.expect_code(1).json();
        for row in table["legs"].as_array().expect("a list") {
            let parted = row["from"] == "b" || row["to"] == "b";
            let status = if parted { without } else { "converged" };
            assert_eq!(row["status"], status, "{row}");
            assert_eq!(row["duration_s"].is_null(), parted, "{row}");
        }
    }
}

#[test]
fn a_plan_whose_way_is_not_found_has_failed_and_says_what_was_searched() {
    let scenario = with_a_belt(15.0005).to_string();
    let ended = slewplan_fed(&["solve", "-"], scenario.as_bytes());
    let answer = ended.expect_code(1).json();
    assert_eq!(answer["status"], "failed");
    let reasons = answer["reasons"].as_array().expect("a list");
    let is_told = |reason: &Value| {
        let message = reason["message"].as_str().unwrap_or_default();
        reason["code"] == "no_clear_path"
            && message.contains("a clearance of")
            && message.contains("nearest point that was reached")
    };
    assert!(reasons.iter().any(is_told), "{reasons:?}");
}

#[test]
fn the_table_is_written_to_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("legs.json");
    let ended = slewplan(&[
        "legs",
        &fixture("two-targets.json"),
        "-o",
        path.to_str().expect("UTF-8"),
    ])
    .expect_code(0);
    assert_eq!(ended.stdout, "");
    let text = std::fs::read_to_string(path).expect("the table is there");
    assert!(serde_json::from_str::<Value>(&text).is_ok());
}

#[test]
fn a_pod_of_an_indexed_job_solves_the_shard_of_its_index() {
    let path = fixture("two-targets.json");
    let pod = |index: Option<&str>| -> Ended {
        let mut command = binary();
        command.args(["legs", &path, "--kind", "certified", "--shard", "indexed/2"]);
        match index {
            Some(index) => command.env("JOB_COMPLETION_INDEX", index),
            None => command.env_remove("JOB_COMPLETION_INDEX"),
        };
        command.output().expect("the binary starts").into()
    };
    for (index, part) in [("0", "1/2"), ("1", "2/2")] {
        let named = slewplan(&["legs", &path, "--kind", "certified", "--shard", part]);
        assert_eq!(
            rows(&pod(Some(index)).expect_code(0).json()),
            rows(&named.expect_code(0).json())
        );
    }
    for wrong in [None, Some("2"), Some("first")] {
        let refused = pod(wrong).expect_code(2);
        assert!(
            refused.stderr.contains("JOB_COMPLETION_INDEX"),
            "{refused:?}"
        );
        assert!(refused.stdout.is_empty());
    }
}

#[test]
fn a_table_is_written_as_lines_columns_and_parquet() {
    let scenario = fixture("two-targets.json");
    let table = slewplan(&["legs", &scenario]).expect_code(0).json();
    let lines = slewplan(&["legs", &scenario, "--format", "ndjson"]).expect_code(0);
    let lines: Vec<Value> = lines
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    let listed = table["legs"].as_array().expect("a list");
    assert_eq!(lines.len(), listed.len());
    for (line, row) in lines.iter().zip(listed) {
        for name in [
            "from",
            "to",
            "duration_s",
            "certified_lower_bound_s",
            "status",
        ] {
            assert_eq!(line[name], row[name]);
        }
        assert_eq!(line["source"], "computed");
    }
    let csv = slewplan(&["legs", &scenario, "--format", "csv"]).expect_code(0);
    let first = csv.stdout.lines().nth(1).expect("a row");
    assert!(first.starts_with("start,a,"), "{first}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("legs.parquet");
    let path = path.to_str().expect("text");
    slewplan(&["legs", &scenario, "--format", "parquet", "-o", path]).expect_code(0);
    assert!(std::fs::read(path).expect("a file").starts_with(b"PAR1"));
}
