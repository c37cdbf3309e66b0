//! `slewplan init`.

use crate::run::{binary, names_in, slewplan};
use serde_json::json;
use std::fs;
use std::path::Path;

fn init(folder: &Path, arguments: &[&str]) -> crate::run::Ended {
    let mut command = binary();
    command.arg("init").args(arguments).current_dir(folder);
    command.output().expect("the binary starts").into()
}

#[test]
fn the_scenario_is_valid_without_a_doubt_and_is_solved() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = init(folder.path(), &[]).expect_code(0).stdout;
    assert!(told.contains("slewplan solve scenario.json"), "{told}");
    assert_eq!(names_in(folder.path()), ["scenario.json", "scenario.md"]);
    let path = folder.path().join("scenario.json");
    let path = path.to_str().expect("UTF-8");
    let found = slewplan(&["validate", path, "--format", "json"]).expect_code(0);
    assert_eq!(
        found.json(),
        json!({"valid": true, "errors": [], "warnings": []})
    );
    let plan = slewplan(&["solve", path]).expect_code(0).json();
    assert_eq!(plan["status"], "optimal");
    assert_eq!(plan["warnings"], json!([]));
    assert_eq!(
        slewplan(&["init", "-"]).expect_code(0).stdout,
        fs::read_to_string(path).expect("there")
    );
}

#[test]
fn the_page_beside_it_says_what_its_fields_mean() {
    let folder = tempfile::tempdir().expect("a folder");
    init(folder.path(), &["first look.json"]).expect_code(0);
    let page = fs::read_to_string(folder.path().join("first look.md")).expect("the page");
    assert!(
        page.starts_with("# The fields of `first look.json`\n"),
        "{page}"
    );
    assert!(
        page.contains("| `dwell_s` | number, at least 0 | `0` | Time to stay at rest"),
        "{page}"
    );
    let printed = slewplan(&["init", "--explain"]).expect_code(0).stdout;
    assert_eq!(
        printed.lines().skip(1).collect::<Vec<_>>(),
        page.lines().skip(1).collect::<Vec<_>>()
    );
}

#[test]
fn the_version_is_that_of_the_program() {
    let told = slewplan(&["--version"]).expect_code(0).stdout;
    assert_eq!(told, format!("slewplan {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn nothing_is_replaced_without_force() {
    for there in ["scenario.json", "scenario.md"] {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(there), "mine").expect("written");
        let told = init(folder.path(), &[]).expect_code(2).stderr;
        assert!(told.contains(there) && told.contains("--force"), "{told}");
        assert_eq!(names_in(folder.path()), [there]);
        init(folder.path(), &["--force"]).expect_code(0);
        assert_eq!(names_in(folder.path()), ["scenario.json", "scenario.md"]);
        assert_ne!(
            fs::read_to_string(folder.path().join(there)).expect("there"),
            "mine"
        );
    }
    let folder = tempfile::tempdir().expect("a folder");
    init(folder.path(), &["fields.md"]).expect_code(2);
    assert!(names_in(folder.path()).is_empty());
}
