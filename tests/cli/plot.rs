//! `slewplan plot`.

use crate::run::{fixture, slewplan, slewplan_fed};

#[test]
fn a_plan_is_drawn_alone_or_with_its_scenario() {
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    let alone = slewplan_fed(&["plot", "-"], plan.as_bytes())
        .expect_code(0)
        .stdout;
    assert!(alone.starts_with("<svg ") && !alone.contains("limit"));
    let line = ["plot", "-", "--scenario", &scenario];
    let whole = slewplan_fed(&line, plan.as_bytes()).expect_code(0).stdout;
    assert!(whole.contains("two-targets") && whole.contains("Where camera points"));
    assert!(whole.contains("red: keep-out") && whole.contains("limit \u{b1}710"));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let scenario = fixture("two-targets.json");
    let plan = slewplan(&["solve", &scenario]).expect_code(0).stdout;
    let unknown = slewplan_fed(&["plot", "-", "--boresight", "nose"], plan.as_bytes());
    assert!(unknown.expect_code(2).stderr.contains("none of x, y, z"));
    let pyramid = fixture("pyramid.json");
    let other = slewplan_fed(&["plot", "-", "--scenario", &pyramid], plan.as_bytes());
    assert!(other.expect_code(2).stderr.contains("wheels"));
    slewplan_fed(&["plot", "-"], b"{}").expect_code(2);
    slewplan(&["plot", "-", "--scenario", "-"]).expect_code(2);
}
