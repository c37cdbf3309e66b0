//! Assertions on refusals of inputs.

use crate::run::slewplan_fed;
use serde_json::Value;

/// Asserts that every command that reads a scenario refuses this one with exit code 2 and names
/// exactly these problems, each with pointer, code and hint.
#[track_caller]
pub(crate) fn expect_refused(scenario: &[u8], expected: &[(&str, &str)]) {
    let found = slewplan_fed(&["validate", "-", "--format", "json"], scenario).expect_code(2);
    let document = found.json();
    assert_eq!(document["valid"], false);
    let errors = document["errors"].as_array().expect("a list of errors");
    let named: Vec<(&str, &str)> = errors
        .iter()
        .map(|error| (text(error, "pointer"), text(error, "code")))
        .collect();
    let sorted = |list: &[(&str, &str)]| {
        let mut list: Vec<(String, String)> = list
            .iter()
            .map(|(pointer, code)| ((*pointer).into(), (*code).into()))
            .collect();
        list.sort();
        list
    };
    assert_eq!(sorted(&named), sorted(expected), "{document:#}");
    for error in errors {
        assert!(
            !text(error, "message").is_empty() && !text(error, "hint").is_empty(),
            "{error}"
        );
    }
    expect_listed_as_text(scenario, expected);
}

#[track_caller]
fn expect_listed_as_text(scenario: &[u8], expected: &[(&str, &str)]) {
    let validated = slewplan_fed(&["validate", "-"], scenario)
        .expect_code(2)
        .stdout;
    let solved = slewplan_fed(&["solve", "-"], scenario).expect_code(2);
    let tabulated = slewplan_fed(&["legs", "-"], scenario).expect_code(2);
    assert_eq!(solved.stdout, "");
    assert_eq!(tabulated.stdout, "");
    for told in [validated, solved.stderr, tabulated.stderr] {
        for (pointer, code) in expected {
            let place = if pointer.is_empty() {
                "(document)"
            } else {
                pointer
            };
            assert!(
                told.contains(&format!("{place}: ")),
                "{pointer} is not in\n{told}"
            );
            assert!(
                told.contains(&format!("[{code}]")),
                "{code} is not in\n{told}"
            );
        }
        assert_eq!(told.matches("hint: ").count(), expected.len(), "{told}");
    }
}

fn text<'a>(error: &'a Value, field: &str) -> &'a str {
    error[field].as_str().expect("a text")
}
