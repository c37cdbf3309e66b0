//! `slewplan export` and `solve --format`.

use crate::run::{Ended, fixture, fixture_json, slewplan, slewplan_fed};
use serde_json::json;

/// The plan of a fixture and its export.
fn exported(name: &str, options: &[&str]) -> Ended {
    let scenario = fixture(name);
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    let mut line = vec!["export", &scenario, "-"];
    line.extend(options);
    slewplan_fed(&line, plan.as_bytes())
}

/// The lines without the creation date.
fn without_date(text: &str) -> String {
    let is_date = |line: &&str| line.contains("CREATION_DATE");
    text.lines().filter(|line| !is_date(line)).collect()
}

#[test]
fn export_and_solve_write_the_same_files() {
    let scenario = fixture("quarter-turn.json");
    for (format, begin) in [
        ("csv", "time_s,q_x,"),
        ("aem-kvn", "CCSDS_AEM_VERS = 2.0\n"),
        ("aem-xml", "<?xml "),
        ("basilisk", "0.000000000,"),
        ("open-mct", "{"),
        ("stk", "stk.v.8.0\n"),
        ("wheel-rpm", "0\t"),
    ] {
        let from_plan = exported("quarter-turn.json", &["--format", format]).expect_code(0);
        assert!(from_plan.stdout.starts_with(begin), "{format}");
        let solved = slewplan(&["solve", &scenario, "--format", format]).expect_code(0);
        assert_eq!(
            without_date(&solved.stdout),
            without_date(&from_plan.stdout)
        );
    }
}

#[test]
fn a_quarter_turn_about_z_ends_with_the_quaternion_of_the_standard() {
    let text = exported("quarter-turn.json", &["--format", "aem-kvn"])
        .expect_code(0)
        .stdout;
    let last = text.lines().rev().nth(1).expect("a data line");
    let values: Vec<f64> = last
        .split(' ')
        .skip(1)
        .map(|cell| cell.parse().expect("a number"))
        .collect();
    let root = 0.5_f64.sqrt();
    let expected = [0.0, 0.0, root, root, 0.0, 0.0, 0.0];
    for (found, expected) in values.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{last}");
    }
}

#[test]
fn a_plan_that_does_not_pass_is_not_exported() {
    let scenario = fixture("two-targets.json");
    let mut plan = slewplan(&["solve", &scenario]).expect_code(0).json();
    let torque = &mut plan["trajectory"]["controls"][0]["wheel_torque_nm"][0];
    *torque = json!(0.9 * torque.as_f64().expect("a number"));
    let line = ["export", &scenario, "-", "--format", "stk"];
    let ended = slewplan_fed(&line, plan.to_string().as_bytes()).expect_code(3);
    assert_eq!(ended.stdout, "");
    assert!(ended.stderr.contains("not exported"), "{}", ended.stderr);
}

#[test]
fn options_are_checked_against_the_format() {
    for choices in [
        &["--format", "csv", "--wheel", "0"][..],
        &["--format", "wheel-rpm", "--wheel", "7"],
        &["--format", "csv", "--step", "0"],
        &["--format", "csv", "--step", "1", "--tolerance", "1e-3"],
        &["--format", "json"],
        &["--format", "aem"],
    ] {
        exported("quarter-turn.json", choices).expect_code(2);
    }
    let scenario = fixture("quarter-turn.json");
    let refused = slewplan(&["solve", &scenario, "--step", "1"]).expect_code(2);
    assert!(
        refused.stderr.contains("json leaves no choice"),
        "{}",
        refused.stderr
    );
    let fed_twice = slewplan_fed(&["export", "-", "-", "--format", "csv"], b"{}");
    fed_twice.expect_code(2);
}

#[test]
fn labels_that_cannot_be_written_are_refused_before_the_solve() {
    let refused = |label: (&str, &str), choices: &[&str]| {
        let mut scenario = fixture_json("two-targets.json");
        scenario[label.0] = json!(label.1);
        // A solve would fail with this time limit.
        let line = ["solve", "-", "--time-limit", "1e-6", "--format"];
        let line = [&line, choices].concat();
        let ended = slewplan_fed(&line, scenario.to_string().as_bytes()).expect_code(2);
        assert_eq!(ended.stdout, "");
        ended.stderr
    };
    let plain = ("name", "two-targets");
    for choices in [&["csv", "--wheel", "1"][..], &["wheel-rpm", "--wheel", "3"]] {
        let told = refused(plain, choices);
        assert!(told.contains("wheel"), "{told}");
    }
    for (label, value, formats) in [
        (
            "epoch",
            "yesterday",
            &["aem-kvn", "aem-xml", "stk", "open-mct"][..],
        ),
        ("time_system", "TAI", &["stk", "open-mct"]),
        ("reference_frame", "LVLH", &["stk"]),
    ] {
        for format in formats {
            let told = refused((label, value), &[format]);
            assert!(told.contains(&format!("/{label}")), "{told}");
        }
    }
}

#[test]
fn wheel_commands_have_the_requested_period() {
    let choices = ["--format", "wheel-rpm", "--step", "0.5", "--wheel", "2"];
    let text = exported("quarter-turn.json", &choices)
        .expect_code(0)
        .stdout;
    let total = slewplan(&["solve", &fixture("quarter-turn.json")]).json()["total_time_s"].clone();
    let commands = (total.as_f64().expect("a number") / 0.5).ceil() + 1.0;
    assert!((text.lines().count() as f64 - commands).abs() < 0.5);
    assert!(text.lines().all(|line| line.split('\t').count() == 2));
}
