//! `slewplan legs --merge`.

use crate::run::{Ended, fixture, fixture_json, slewplan};
use serde_json::{Value, json};
use std::path::Path;

/// The files of the shards of a table, in a folder.
fn parts(folder: &Path, scenario: &str, of: usize, options: &[&str]) -> Vec<String> {
    let part = |index: usize| {
        let path = folder.join(format!("part-{index}-of-{of}.json"));
        let path = path.to_str().expect("UTF-8").to_owned();
        let shard = format!("{index}/{of}");
        let arguments = ["legs", scenario, "--shard", &shard, "-o", &path];
        slewplan(&[&arguments, options].concat()).expect_code(0);
        path
    };
    (1..=of).map(part).collect()
}

fn merged(files: &[&str]) -> Ended {
    slewplan(&[&["legs", "--merge"], files].concat())
}

/// A table as text without measured times.
fn without_times(text: &str) -> String {
    let is_time = |line: &&str| !line.contains("\"solve_time_s\"");
    text.lines().filter(is_time).collect::<Vec<_>>().join("\n")
}

#[test]
fn merged_shards_are_the_unsharded_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = fixture("two-targets.json");
    for kind in ["rest_to_rest", "lower_bound", "certified"] {
        let options = ["--kind", kind];
        let whole = slewplan(&[&["legs", &*scenario], &options[..]].concat()).expect_code(0);
        let parts = parts(folder.path(), &scenario, 3, &options);
        // In any order; measured times differ from run to run.
        let merged = merged(&[&parts[2], &parts[0], &parts[1]]).expect_code(0);
        assert_eq!(without_times(&merged.stdout), without_times(&whole.stdout));
        assert_eq!(merged.json()["shard"], json!({"index": 1, "of": 1}));
    }
}

#[test]
fn merged_shards_of_known_legs_are_the_unsharded_file_byte_for_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("legs.db");
    let database = database.to_str().expect("UTF-8");
    let scenario = fixture("two-targets.json");
    // A cached leg keeps its solve time, so that no time is measured again.
    let options = ["--trajectories", "--database", database];
    let command = [&["legs", &*scenario], &options[..]].concat();
    slewplan(&command).expect_code(0);
    let whole = slewplan(&command).expect_code(0);
    let parts = parts(folder.path(), &scenario, 3, &options);
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    let joined = merged(&parts).expect_code(0);
    assert_eq!(joined.stdout, whole.stdout);
    let table = joined.json();
    assert_eq!(table["scenario"], fixture_json("two-targets.json"));
    let motions = table["trajectories"].as_array().expect("a list");
    // Equal pairs and reversed ones share a motion.
    assert!((3..6).contains(&motions.len()), "{}", motions.len());
}

#[test]
fn shards_that_are_not_one_table_are_refused_with_all_problems() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = fixture("two-targets.json");
    let files = parts(folder.path(), &scenario, 3, &["--kind", "certified"]);
    let mut other = fixture_json("two-targets.json");
    other["targets"][0]["attitude"] = json!({"roll_pitch_yaw_deg": [16, 0, 10]});
    let other_path = folder.path().join("other.json");
    std::fs::write(&other_path, other.to_string()).expect("written");
    let others = parts(
        folder.path(),
        other_path.to_str().expect("UTF-8"),
        4,
        &["--kind", "lower_bound"],
    );
    let told = merged(&[&files[0], &others[1], &files[0]]).expect_code(2);
    assert_eq!(told.stdout, "");
    for problem in [
        "/kind: this is \"lower_bound\", in the first file it is \"certified\" [shard_mismatch]",
        "/scenario_key: ",
        "/shard/of: this is \"4\", in the first file it is \"3\" [shard_mismatch]",
        "/shard/index: part 1 of 3 is there before [shard_repeated]",
        "(document): there is no part 2/3, 3/3 [shard_missing]",
        &format!("{} is not valid: 3 problems", others[1]),
    ] {
        assert!(told.stderr.contains(problem), "{problem}\n{}", told.stderr);
    }
    assert_eq!(told.stderr.matches("hint: ").count(), 5, "{}", told.stderr);

    // Shards that are marked as incomplete, or lack rows.
    let spoil = |name: &str, change: &dyn Fn(&mut Value)| {
        let text = std::fs::read_to_string(&files[1]).expect("the part");
        let mut part: Value = serde_json::from_str(&text).expect("JSON");
        change(&mut part);
        let path = folder.path().join(name);
        std::fs::write(&path, part.to_string()).expect("written");
        path.to_str().expect("UTF-8").to_owned()
    };
    let refused = |part: &str, problem: &str| {
        let told = merged(&[&files[0], part, &files[2]]).expect_code(2);
        assert!(told.stderr.contains(problem), "{problem}\n{}", told.stderr);
    };
    let unfinished = spoil("unfinished.json", &|part| part["complete"] = json!(false));
    refused(&unfinished, "/complete: ");
    let lost = |part: &mut Value| {
        part["legs"].as_array_mut().expect("a list").pop();
    };
    refused(&spoil("short.json", &lost), "[table_incomplete]");
    let old = spoil("old.json", &|part| part["version"] = json!("0.0.1"));
    refused(&old, "/version: this is \"0.0.1\"");
    let foreign = spoil("foreign.json", &|part| {
        part["shard"]["index"] = json!(9);
        part["surprise"] = json!(1);
        part["legs"][0]["duration_s"] = json!(-1);
    });
    for problem in ["/shard: ", "/surprise: ", "/legs/0/duration_s: "] {
        refused(&foreign, problem);
    }
}

#[test]
fn merging_takes_no_scenario() {
    for arguments in [
        &["legs"][..],
        &["legs", "--merge"],
        &["legs", "a.json", "--merge", "b.json", "--kind", "certified"],
    ] {
        slewplan(arguments).expect_code(2);
    }
}
