//! Invalid inputs: all problems at once, with pointer, code and hint, and exit code 2.

use crate::refusals::expect_refused;
use crate::run::{fixture_json, slewplan, slewplan_fed};
use serde_json::{Value, json};

/// The two-target fixture with some values replaced, each named by its pointer.
fn with(changes: &[(&str, Value)]) -> Vec<u8> {
    let mut scenario = fixture_json("two-targets.json");
    for (pointer, value) in changes {
        let (parent, name) = pointer
            .rsplit_once('/')
            .expect("a pointer below the document");
        let parent = scenario.pointer_mut(parent).expect("the parent exists");
        match parent {
            Value::Array(items) => items[name.parse::<usize>().expect("an index")] = value.clone(),
            _ => parent[name] = value.clone(),
        }
    }
    scenario.to_string().into_bytes()
}

/// The two-target fixture without a member.
fn without(pointer: &str) -> Vec<u8> {
    let mut scenario = fixture_json("two-targets.json");
    let (parent, name) = pointer
        .rsplit_once('/')
        .expect("a pointer below the document");
    let parent = scenario.pointer_mut(parent).expect("the parent exists");
    parent
        .as_object_mut()
        .expect("an object")
        .remove(name)
        .expect("the member exists");
    scenario.to_string().into_bytes()
}

/// The text of the two-target fixture with a number replaced by other text.
fn with_text(number: &str, replacement: &str) -> Vec<u8> {
    let text = fixture_json("two-targets.json").to_string();
    assert!(text.contains(number));
    text.replacen(number, replacement, 1).into_bytes()
}

#[test]
fn documents_that_are_not_json_are_refused() {
    let nested = "[".repeat(100_000);
    for text in [
        "",
        "  ",
        "{",
        "nonsense",
        "{\"name\": \"x\",}",
        "[1 2]",
        "{} {}",
        &nested,
    ] {
        expect_refused(text.as_bytes(), &[("", "malformed_json")]);
    }
    expect_refused(b"\xff\xfe{}", &[("", "malformed_json")]);
    expect_refused(b"{\"name\": \"\xff\"}", &[("", "malformed_json")]);
}

#[test]
fn malformed_json_names_line_and_column() {
    let ended = slewplan_fed(&["solve", "-"], b"{\n  \"name\": NaN\n}").expect_code(2);
    assert!(
        ended.stderr.contains("line 2, column 11"),
        "{}",
        ended.stderr
    );
    assert!(ended.stderr.contains("JSON has no NaN"), "{}", ended.stderr);
}

#[test]
fn numbers_that_json_does_not_have_are_refused() {
    for number in [
        "NaN",
        "Infinity",
        "-Infinity",
        "1e400",
        "-1e400",
        "0x10",
        "+1",
    ] {
        expect_refused(&with_text("6.63", number), &[("", "malformed_json")]);
    }
}

#[test]
fn documents_of_another_kind_are_refused() {
    for text in ["[]", "null", "3", "\"text\""] {
        expect_refused(text.as_bytes(), &[("", "wrong_type")]);
    }
    expect_refused(
        b"{}",
        &[
            ("/spacecraft", "missing_field"),
            ("/start", "missing_field"),
            ("/targets", "missing_field"),
        ],
    );
}

#[test]
fn text_in_place_of_a_number_is_refused() {
    let place = "/spacecraft/inertia_kg_m2/0/0";
    expect_refused(&with(&[(place, json!("NaN"))]), &[(place, "wrong_type")]);
    let place = "/targets/0/attitude/roll_pitch_yaw_deg/2";
    expect_refused(&with(&[(place, json!(null))]), &[(place, "wrong_type")]);
}

#[test]
fn missing_fields_are_named() {
    for place in [
        "/spacecraft",
        "/spacecraft/inertia_kg_m2",
        "/spacecraft/wheels",
        "/start",
        "/start/attitude",
        "/targets",
        "/targets/0/id",
        "/targets/1/attitude",
        "/keep_out/0/half_angle_deg",
    ] {
        let expected: &[(&str, &str)] = &[(place, "missing_field")];
        expect_refused(&without(place), expected);
    }
}

#[test]
fn missing_wheel_fields_are_named() {
    for name in ["axis", "inertia_kg_m2", "max_torque_nm"] {
        let place = format!("/spacecraft/wheels/1/{name}");
        expect_refused(&without(&place), &[(&place, "missing_field")]);
    }
}

#[test]
fn unknown_fields_have_a_suggestion() {
    let scenario = with(&[("/spacecraft/wheels/0/max_sped_rad_s", json!(1.0))]);
    expect_refused(
        &scenario,
        &[("/spacecraft/wheels/0/max_sped_rad_s", "unknown_field")],
    );
    let told = slewplan_fed(&["validate", "-"], &scenario).stdout;
    assert!(told.contains("did you mean \"max_speed_rad_s\"?"), "{told}");
}

#[test]
fn pointers_of_unknown_fields_are_escaped() {
    let scenario = fixture_json("two-targets.json").to_string();
    let scenario = scenario.replacen('{', r#"{"a/b~c": 1, "#, 1);
    expect_refused(scenario.as_bytes(), &[("/a~1b~0c", "unknown_field")]);
}

#[test]
fn duplicate_keys_are_refused() {
    let scenario = fixture_json("two-targets.json").to_string();
    let scenario = scenario.replacen('{', r#"{"name": "first", "#, 1);
    expect_refused(scenario.as_bytes(), &[("/name", "duplicate_field")]);
}

#[test]
fn unknown_choices_and_wrong_lengths_are_refused() {
    let cases = [
        (
            "/options",
            json!({"attitude_equivalence": "both"}),
            "/attitude_equivalence",
            "unknown_choice",
        ),
        (
            "/options",
            json!({"node_limit": -1}),
            "/node_limit",
            "wrong_type",
        ),
        (
            "/options",
            json!({"node_limit": 1.5}),
            "/node_limit",
            "wrong_type",
        ),
        (
            "/targets/0/zero_rate_axes",
            json!(["z", "w"]),
            "/1",
            "unknown_choice",
        ),
        (
            "/targets/0/attitude/roll_pitch_yaw_deg",
            json!([1, 2]),
            "",
            "wrong_length",
        ),
        (
            "/spacecraft/inertia_kg_m2",
            json!([[1, 0, 0], [0, 1, 0]]),
            "",
            "wrong_length",
        ),
        (
            "/start/wheel_speed_rad_s",
            json!([0, 0]),
            "",
            "wrong_length",
        ),
    ];
    for (place, value, below, code) in cases {
        expect_refused(
            &with(&[(place, value)]),
            &[(&format!("{place}{below}"), code)],
        );
    }
}

#[test]
fn impossible_inertias_are_refused() {
    let place = "/spacecraft/inertia_kg_m2";
    let cases = [
        (
            json!([[-6.63, 0, 0], [0, 8.9, 0], [0, 0, 9.63]]),
            "inertia_not_positive",
        ),
        (json!([[1, 0, 0], [0, 1, 0], [0, 0, 3]]), "inertia_triangle"),
        (
            json!([[6.63, 1, 0], [0, 8.9, 0], [0, 0, 9.63]]),
            "inertia_not_symmetric",
        ),
    ];
    for (value, code) in cases {
        expect_refused(&with(&[(place, value)]), &[(place, code)]);
    }
}

#[test]
fn impossible_wheels_are_refused() {
    let wheels = "/spacecraft/wheels";
    let mut two = fixture_json("two-targets.json");
    two["spacecraft"]["wheels"]
        .as_array_mut()
        .expect("a list")
        .pop();
    two["start"]["wheel_speed_rad_s"] = json!([0, 0]);
    expect_refused(two.to_string().as_bytes(), &[(wheels, "too_few_wheels")]);

    let disabled = with(&[("/spacecraft/wheels/2/enabled", json!(false))]);
    expect_refused(&disabled, &[(wheels, "too_few_wheels")]);

    // The solver's tests show that seventeen wheels can be planned.
    let mut many = fixture_json("two-targets.json");
    let list = many["spacecraft"]["wheels"].as_array_mut().expect("a list");
    list.extend(vec![list[2].clone(); 15]);
    many["start"]["wheel_speed_rad_s"] = json!(vec![0; 18]);
    expect_refused(many.to_string().as_bytes(), &[(wheels, "too_many_wheels")]);
    many["spacecraft"]["wheels"][17]["enabled"] = json!(false);
    slewplan_fed(&["validate", "-"], many.to_string().as_bytes()).expect_code(0);

    let coplanar = with(&[("/spacecraft/wheels/2/axis", json!([1, 1, 0]))]);
    expect_refused(&coplanar, &[(wheels, "wheel_axes_coplanar")]);

    let zero = with(&[("/spacecraft/wheels/2/axis", json!([0, 0, 0]))]);
    expect_refused(&zero, &[("/spacecraft/wheels/2/axis", "zero_direction")]);

    let place = "/spacecraft/wheels/0/max_torque_nm";
    expect_refused(&with(&[(place, json!(-0.01))]), &[(place, "torque_limits")]);
}

#[test]
fn a_wheel_speed_beyond_its_limit_is_refused() {
    let place = "/start/wheel_speed_rad_s/1";
    expect_refused(
        &with(&[(place, json!(-710.5))]),
        &[(place, "wheel_speed_limit")],
    );
}

#[test]
fn impossible_attitudes_are_refused() {
    let place = "/targets/0/attitude";
    let zero = json!({"quaternion": {"x": 0, "y": 0, "z": 0, "w": 0}});
    let long = json!({"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1.1}});
    let both = json!({"mrp": [0, 0, 0], "roll_pitch_yaw_deg": [0, 0, 0]});
    let sheared = json!({"matrix": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]});
    let cases = [
        (zero, "/quaternion", "quaternion_norm"),
        (long, "/quaternion", "quaternion_norm"),
        (both, "", "attitude_form"),
        (json!({}), "", "attitude_form"),
        (sheared, "/matrix", "matrix_not_rotation"),
    ];
    for (attitude, below, code) in cases {
        expect_refused(
            &with(&[(place, attitude)]),
            &[(&format!("{place}{below}"), code)],
        );
    }
}

#[test]
fn duplicate_and_unknown_names_are_refused() {
    expect_refused(
        &with(&[("/targets/1/id", json!("a"))]),
        &[("/targets/1/id", "duplicate_id")],
    );
    expect_refused(
        &with(&[("/keep_out/0/boresight", json!("radar"))]),
        &[("/keep_out/0/boresight", "unknown_reference")],
    );
    expect_refused(
        &with(&[("/spacecraft", json!({"ref": "stored"}))]),
        &[("/spacecraft/ref", "unknown_reference")],
    );
}

#[test]
fn directions_have_one_form_of_three() {
    let place = "/keep_out/0/direction";
    let cases = [
        (json!(5), "", "wrong_type"),
        (json!({}), "", "wrong_type"),
        (json!([1, 0]), "", "wrong_length"),
        (
            json!({"ra_dec_deg": [1, 2, 3]}),
            "/ra_dec_deg",
            "wrong_length",
        ),
        (
            json!({"ra_dec_deg": [1, -91]}),
            "/ra_dec_deg/1",
            "out_of_range",
        ),
        (json!({"body": "moon"}), "/body", "unknown_choice"),
        (
            json!({"body": "sun", "ra_dec_deg": [1, 2]}),
            "",
            "conflicting_fields",
        ),
        (json!({"body": "sun"}), "", "epoch_required"),
    ];
    for (direction, below, code) in cases {
        expect_refused(
            &with(&[(place, direction)]),
            &[(&format!("{place}{below}"), code)],
        );
    }
    // An epoch that cannot be read is one, and the only thing that is wrong.
    expect_refused(
        &with(&[("/epoch", json!(5)), (place, json!({"body": "sun"}))]),
        &[("/epoch", "wrong_type")],
    );
    expect_refused(
        &with(&[("/keep_out/0/applies", json!("never"))]),
        &[("/keep_out/0/applies", "unknown_choice")],
    );
}

#[test]
fn contradictory_positions_and_precedences_are_refused() {
    for place in [json!(0), json!(3), json!(u64::MAX)] {
        let place = ("/targets/1/position", place);
        expect_refused(&with(&[place]), &[("/targets/1/position", "out_of_range")]);
    }
    for place in [json!(1.5), json!(-1), json!("first")] {
        let place = ("/targets/1/position", place);
        expect_refused(&with(&[place]), &[("/targets/1/position", "wrong_type")]);
    }
    expect_refused(
        &with(&[
            ("/targets/0/position", json!(2)),
            ("/targets/1/position", json!(2)),
        ]),
        &[("/targets/1/position", "position_taken")],
    );
    expect_refused(
        &with(&[
            ("/targets/0/after", json!(["z", "a", "b", "b"])),
            ("/targets/1/after", json!([3])),
        ]),
        &[
            ("/targets/0/after/0", "unknown_reference"),
            ("/targets/0/after/1", "order_cycle"),
            ("/targets/0/after/3", "duplicate_id"),
            ("/targets/1/after/0", "wrong_type"),
        ],
    );
    expect_refused(
        &with(&[
            ("/targets/0/after", json!(["b"])),
            ("/targets/1/after", json!(["a"])),
        ]),
        &[("/targets/0/after", "order_cycle")],
    );
    expect_refused(
        &with(&[
            ("/targets/0/after", json!(["b"])),
            ("/targets/1/position", json!(2)),
        ]),
        &[("/targets/1/position", "order_infeasible")],
    );
    // An unreadable target may be the one that is referred to, so that the reference is not a
    // problem.
    expect_refused(
        &with(&[
            ("/targets/0/id", json!(7)),
            ("/targets/1/after", json!(["a"])),
        ]),
        &[("/targets/0/id", "wrong_type")],
    );
}

#[test]
fn all_problems_are_reported_at_once() {
    let scenario = with(&[
        ("/colour", json!("red")),
        ("/spacecraft/inertia_kg_m2/0/0", json!(-1)),
        ("/spacecraft/wheels/1/inertia_kg_m2", json!("heavy")),
        ("/spacecraft/wheels/2/axis", json!([1, 1, 0])),
        (
            "/start/attitude",
            json!({"quaternion": {"x": 0, "y": 0, "z": 0, "w": 0}}),
        ),
        ("/start/wheel_speed_rad_s/0", json!(1000)),
        (
            "/targets/0/attitude",
            json!({"mrp": [0, 0, 0], "roll_pitch_yaw_deg": [0, 0, 0]}),
        ),
        ("/targets/1/id", json!("a")),
    ]);
    expect_refused(
        &scenario,
        &[
            ("/colour", "unknown_field"),
            ("/spacecraft/inertia_kg_m2", "inertia_not_positive"),
            ("/spacecraft/wheels/1/inertia_kg_m2", "wrong_type"),
            ("/spacecraft/wheels", "wheel_axes_coplanar"),
            ("/start/attitude/quaternion", "quaternion_norm"),
            ("/start/wheel_speed_rad_s/0", "wheel_speed_limit"),
            ("/targets/0/attitude", "attitude_form"),
            ("/targets/1/id", "duplicate_id"),
        ],
    );
}

#[test]
fn unknown_arguments_are_refused() {
    let scenario = crate::run::fixture("two-targets.json");
    for arguments in [
        &["solve", &scenario, "--format", "aem"][..],
        &["solve", &scenario, "--threads", "0"],
        &["solve", &scenario, "--time-limit", "-1"],
        &["solve", &scenario, "--progress", "loud"],
        &["legs", &scenario, "--kind", "proved"],
        &["legs", &scenario, "--shard", "3/2"],
        &["solve"],
        &["fly", &scenario],
        &["validate", &scenario, "--colour"],
    ] {
        let ended = slewplan(arguments).expect_code(2);
        assert!(ended.stderr.contains("error: "), "{ended:?}");
    }
}

#[test]
fn an_unreadable_file_is_an_error() {
    for command in ["solve", "legs", "validate"] {
        for path in ["no/such/file.json", "/"] {
            let ended = slewplan(&[command, path]).expect_code(2);
            assert!(
                ended.stderr.contains(&format!("cannot read {path}: ")),
                "{ended:?}"
            );
            assert_eq!(ended.stderr.lines().count(), 1, "{ended:?}");
        }
    }
}
