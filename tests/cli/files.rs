//! Output files appear complete or not at all.

use crate::run::{fixture, names_in, slewplan, slewplan_fed};
use serde_json::Value;
use std::fs;
use std::os::unix::fs::PermissionsExt;

#[test]
fn a_plan_replaces_the_file_and_leaves_no_temporary_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plan.json");
    fs::write(&path, "old").expect("written");
    let name = path.to_str().expect("UTF-8");
    let ended = slewplan(&["solve", &fixture("two-targets.json"), "-o", name]).expect_code(0);
    assert_eq!(ended.stdout, "");
    assert_eq!(names_in(folder.path()), ["plan.json"]);
    let text = fs::read_to_string(&path).expect("readable");
    assert_eq!(
        serde_json::from_str::<Value>(&text).expect("JSON")["status"],
        "optimal"
    );
}

#[test]
fn a_new_file_has_the_permissions_of_the_umask() {
    let folder = tempfile::tempdir().expect("a folder");
    let (plan, other) = (folder.path().join("plan.json"), folder.path().join("other"));
    fs::write(&other, "").expect("written");
    let name = plan.to_str().expect("UTF-8");
    slewplan(&["solve", &fixture("two-targets.json"), "-o", name]).expect_code(0);
    let mode = |path| fs::metadata(path).expect("there").permissions().mode();
    assert_eq!(mode(plan), mode(other));
}

#[test]
fn a_refused_scenario_does_not_touch_the_old_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plan.json");
    fs::write(&path, "old").expect("written");
    let name = path.to_str().expect("UTF-8");
    slewplan_fed(&["solve", "-", "-o", name], b"{}").expect_code(2);
    assert_eq!(fs::read_to_string(&path).expect("readable"), "old");
    assert_eq!(names_in(folder.path()), ["plan.json"]);
}

#[test]
fn an_unwritable_output_is_an_error_of_one_line() {
    let folder = tempfile::tempdir().expect("a folder");
    for path in [
        folder.path().join("none/plan.json"),
        folder.path().to_owned(),
    ] {
        let name = path.to_str().expect("UTF-8");
        let ended = slewplan(&["solve", &fixture("two-targets.json"), "-o", name]).expect_code(1);
        assert!(
            ended.stderr.contains(&format!("cannot write {name}: ")),
            "{ended:?}"
        );
        assert_eq!(ended.stderr.lines().count(), 1, "{ended:?}");
    }
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn a_device_is_written_to_and_not_replaced() {
    let scenario = fixture("two-targets.json");
    slewplan(&["solve", &scenario, "-o", "/dev/null"]).expect_code(0);
    assert!(!fs::metadata("/dev/null").expect("there").is_file());
}
