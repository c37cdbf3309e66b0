//! `slewplan verify`.

use crate::run::{fixture, slewplan, slewplan_fed};
use serde_json::{Value, json};

fn solved(name: &str) -> Value {
    slewplan(&["solve", &fixture(name)]).expect_code(0).json()
}

/// The list of torques.
fn controls(plan: &mut Value) -> &mut Vec<Value> {
    plan["trajectory"]["controls"]
        .as_array_mut()
        .expect("a list")
}

/// The plan with one torque changed by one per cent: that with the largest impulse, in the
/// direction that torque limits allow.
fn with_one_torque_changed(mut plan: Value) -> Value {
    let impulse = |control: &Value, wheel: usize| {
        let torque = control["wheel_torque_nm"][wheel]
            .as_f64()
            .expect("a number");
        (torque * control["duration_s"].as_f64().expect("a number")).abs()
    };
    let wheels = controls(&mut plan)[0]["wheel_torque_nm"]
        .as_array()
        .expect("a list")
        .len();
    let (_, index, wheel) = controls(&mut plan)
        .iter()
        .enumerate()
        .flat_map(|(index, control)| (0..wheels).map(move |w| (impulse(control, w), index, w)))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .expect("a torque");
    let torque = &mut controls(&mut plan)[index]["wheel_torque_nm"][wheel];
    *torque = json!(torque.as_f64().expect("a number") * 0.99);
    plan
}

fn verify(scenario: &str, plan: &Value) -> crate::run::Ended {
    slewplan_fed(
        &["verify", &fixture(scenario), "-"],
        plan.to_string().as_bytes(),
    )
}

#[test]
fn plans_pass_and_a_torque_changed_by_a_per_cent_does_not() {
    for name in [
        "two-targets.json",
        "pyramid.json",
        "pyramid-one-disabled.json",
        "pyramid-momentum-bias.json",
    ] {
        let plan = solved(name);
        let good = verify(name, &plan).expect_code(0).json();
        assert_eq!(good["passed"], true, "{name}");
        assert_eq!(good["failures"], json!([]), "{name}");
        let bad = verify(name, &with_one_torque_changed(plan))
            .expect_code(3)
            .json();
        assert_eq!(bad["passed"], false, "{name}");
        assert!(
            !bad["failures"].as_array().expect("a list").is_empty(),
            "{name}"
        );
    }
}

#[test]
fn a_foreign_plan_needs_only_its_controls_and_passages() {
    let plan = solved("two-targets.json");
    let passages: Vec<Value> = plan["passages"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|p| json!({"target": p["target"], "time_s": p["time_s"], "departure_s": p["departure_s"]}))
        .collect();
    let foreign = json!({
        "made_by": "another tool",
        "total_time_s": plan["total_time_s"],
        "sequence": plan["sequence"],
        "passages": passages,
        "trajectory": {"controls": plan["trajectory"]["controls"], "frame": "body"},
    });
    assert_eq!(
        verify("two-targets.json", &foreign).expect_code(0).json()["passed"],
        true
    );
}

#[test]
fn the_summary_lists_failed_tests() {
    let plan = with_one_torque_changed(solved("two-targets.json"));
    let ended = slewplan_fed(
        &["verify", &fixture("two-targets.json"), "-", "--summary"],
        plan.to_string().as_bytes(),
    )
    .expect_code(3);
    assert!(
        ended.stdout.contains("NOT PASSED") && ended.stdout.contains("failed: "),
        "{ended:?}"
    );
}

/// A plan for the two-target fixture with zero torques.
fn idle() -> Value {
    json!({
        "total_time_s": 10.0,
        "sequence": ["a", "b"],
        "passages": [
            {"target": "a", "time_s": 2.0, "departure_s": 2.0},
            {"target": "b", "time_s": 5.0, "departure_s": 8.0}
        ],
        "trajectory": {"controls": [
            {"start_s": 0.0, "duration_s": 10.0, "wheel_torque_nm": [0.0, 0.0, 0.0]}
        ]}
    })
}

#[test]
fn a_plan_with_zero_torques_does_not_pass() {
    let found = verify("two-targets.json", &idle()).expect_code(3).json();
    assert!(found["max_attitude_error_rad"].as_f64().expect("a number") > 0.1);
}

#[test]
fn plans_that_cannot_be_propagated_are_refused_with_pointers() {
    let cases = [
        (
            "/total_time_s",
            json!("long"),
            "/total_time_s",
            "wrong_type",
        ),
        (
            "/sequence",
            json!(["b", "a"]),
            "/passages",
            "conflicting_fields",
        ),
        (
            "/passages/0/target",
            json!("x"),
            "/passages/0",
            "unknown_reference",
        ),
        (
            "/passages/1/target",
            json!("a"),
            "/passages/1",
            "duplicate_id",
        ),
        (
            "/passages/0/time_s",
            json!(null),
            "/passages/0/time_s",
            "wrong_type",
        ),
        (
            "/trajectory/controls/0/wheel_torque_nm",
            json!([0.0]),
            "/trajectory/controls/0/wheel_torque_nm",
            "wrong_length",
        ),
    ];
    for (place, value, pointer, code) in cases {
        let mut plan = idle();
        *plan.pointer_mut(place).expect("the place exists") = value;
        let ended = verify("two-targets.json", &plan).expect_code(2);
        assert!(
            ended.stderr.contains(&format!("\n{pointer}: ")),
            "{pointer}: {ended:?}"
        );
        assert!(
            ended.stderr.contains(&format!("[{code}]")),
            "{code}: {ended:?}"
        );
        assert!(ended.stderr.contains("hint: "), "{ended:?}");
    }
}

#[test]
fn inconsistent_times_do_not_pass() {
    let cases = [
        ("/trajectory/controls/0/duration_s", json!(-1.0)),
        ("/trajectory/controls/0/start_s", json!(0.5)),
        ("/total_time_s", json!(11.0)),
        ("/total_time_s", json!(-1.0)),
        ("/passages/0/time_s", json!(6.0)),
        ("/trajectory/controls", json!([])),
        ("/trajectory/controls/0/wheel_torque_nm/0", json!(1e300)),
    ];
    for (place, value) in cases {
        let mut plan = idle();
        *plan.pointer_mut(place).expect("the place exists") = value;
        let found = verify("two-targets.json", &plan).expect_code(3).json();
        assert_eq!(found["passed"], false);
        assert!(
            !found["failures"].as_array().expect("a list").is_empty(),
            "{place}: {found}"
        );
    }
}

#[test]
fn what_cannot_be_computed_is_no_number() {
    let mut plan = solved("two-targets.json");
    plan["total_time_s"] = json!(100.0);
    let ended = verify("two-targets.json", &plan).expect_code(3);
    assert!(!ended.stdout.contains("e308"), "{}", ended.stdout);
    let found = ended.json();
    let figures = [
        "/max_attitude_error_rad",
        "/max_rate_error_rad_s",
        "/max_wheel_speed_excess",
        "/max_torque_excess",
        "/max_rate_excess",
        "/margins/torque",
        "/margins/wheel_speed",
        "/margins/body_rate",
    ];
    for pointer in figures {
        assert_eq!(found.pointer(pointer), Some(&Value::Null), "{pointer}");
    }
    let text = slewplan_fed(
        &["verify", &fixture("two-targets.json"), "-", "--summary"],
        plan.to_string().as_bytes(),
    );
    let text = text.expect_code(3).stdout;
    assert!(text.contains("torque not computed"), "{text}");
    let longest = text
        .split(|c: char| !c.is_ascii_digit())
        .map(str::len)
        .max();
    assert!(longest < Some(20), "{text}");
}

#[test]
fn a_plan_below_its_own_bounds_does_not_pass() {
    let plan = solved("two-targets.json");
    let total_s = plan["total_time_s"].as_f64().expect("a number");
    for pointer in [
        "/lower_bound_s",
        "/certified_lower_bound_s",
        "/legs/1/certified_lower_bound_s",
    ] {
        let mut claimed = plan.clone();
        *claimed.pointer_mut(pointer).expect("a bound") = json!(total_s * 1.01);
        let found = verify("two-targets.json", &claimed).expect_code(3).json();
        assert_eq!(found["passed"], false);
        let warning = &found["warnings"][0];
        assert_eq!(warning["pointer"], pointer);
        assert_eq!(warning["code"], "bound_above_time");
        assert_eq!(found["failures"], json!([warning["message"]]), "{pointer}");
    }
}

#[test]
fn every_missing_field_of_an_empty_plan_is_named() {
    let ended = verify("two-targets.json", &json!({})).expect_code(2);
    for field in ["/total_time_s", "/sequence", "/passages", "/trajectory"] {
        assert!(
            ended.stderr.contains(&format!("{field}: ")),
            "{field}: {ended:?}"
        );
    }
}

#[test]
fn two_inputs_from_standard_input_are_refused() {
    let ended = slewplan(&["verify", "-", "-"]).expect_code(2);
    assert!(ended.stderr.contains("standard input"), "{ended:?}");
}
